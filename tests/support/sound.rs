//! What must hold of whatever a file holds: an error of one clear sentence, or a scene and a plan that are sound.
//! Shared by the tests and by the targets in `fuzz/`.
#![allow(dead_code)] // Each program uses a part of it.

use std::path::Path;

use halfshade::gpu::Limits;
use halfshade::plan::{Outputs, plan};
use halfshade::scene::Scene;
use halfshade::scene::gltf;
use halfshade::shot::{Overrides, Shot};
use halfshade::{Error, Result};

/// [character] No message quotes a file at greater length.
const LONGEST_MESSAGE: usize = 1000;

/// A device of middling size.
const LIMITS: Limits = Limits {
    storage_alignment: 16,
    image_side: 16384,
    image_layers: 2048,
    image_bytes: 1 << 31,
    buffer_bytes: 1 << 27,
    memory_bytes: 1 << 33,
    allowed_bytes: u64::MAX,
    adds_floats: true,
    is_cpu: true,
    loop_turns: 60000,
};

/// Reads a glTF as scene and as shot. Returns whether it was one.
pub fn check_gltf(path: &Path, bytes: &[u8], overrides: &Overrides) -> bool {
    let options = gltf::LoadOptions {
        punctual_radius: overrides.radius,
        sun_angle_deg: overrides.sun_angle_deg,
        limits: overrides.limits.clone(),
        ..gltf::LoadOptions::default()
    };
    match accepted(path, gltf::parse(path, bytes, &options)) {
        Some(scene) => {
            check_scene(&scene);
            check_shot(path, bytes, overrides);
            true
        }
        None => false,
    }
}

/// Reads a shot and plans it. Returns whether it was one.
pub fn check_shot(path: &Path, bytes: &[u8], overrides: &Overrides) -> bool {
    let Some(shot) = accepted(path, Shot::parse(path, bytes, overrides)) else {
        return false;
    };
    check_scene(&shot.scene);
    for picture in [false, true] {
        match plan(&shot, Outputs { picture }, &LIMITS) {
            Ok(plan) => assert!(plan.memory_bytes() <= LIMITS.memory_bytes),
            Err(error) => check_message(&error),
        }
    }
    true
}

/// What was read; a refusal must name the file.
fn accepted<T>(path: &Path, read: Result<T>) -> Option<T> {
    match read {
        Ok(read) => Some(read),
        Err(error) => {
            check_message(&error);
            let (text, folder) = (error.to_string(), path.parent().unwrap_or(path));
            // Another file that a glTF refers to lies beside it; the scene of a shot may lie anywhere.
            let named = text.starts_with(&*path.to_string_lossy())
                || text.starts_with(&*folder.to_string_lossy())
                || text.starts_with('/');
            assert!(named, "which file? {text}");
            None
        }
    }
}

fn check_message(error: &Error) {
    let text = error.to_string();
    assert!(
        !text.is_empty() && text.chars().count() <= LONGEST_MESSAGE,
        "{text}"
    );
}

fn check_scene(scene: &Scene) {
    let vertices = scene.positions.len();
    assert!(scene.positions.iter().all(|position| position.is_finite()));
    assert!(scene.texcoords.is_empty() || scene.texcoords.len() == vertices);
    let inside = |&vertex: &u32| (vertex as usize) < vertices;
    assert!(scene.triangles.as_flattened().iter().all(inside));
    assert!(scene.opaque_count <= scene.triangles.len());
    assert_eq!(scene.triangles.len(), scene.triangle_materials.len());
    for &material in &scene.triangle_materials {
        let texture = scene.materials[material as usize].texture;
        assert!(texture.is_none_or(|texture| texture < scene.textures.len()));
    }
    for texture in &scene.textures {
        let texels = texture.width as usize * texture.height as usize;
        assert!(texels > 0 && texture.rgba.len() == 4 * texels);
    }
}
