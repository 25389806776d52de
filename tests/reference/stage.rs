//! A floor, an occluder and a light, at places that closed forms are easy for.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use glam::{DVec3, Vec2, Vec3, Vec4};
use halfshade::reference::{ReferenceImage, ReferenceOptions, trace};
use halfshade::scene::{AreaLight, Camera, LightShape, Material, Scene};
use halfshade::shot::Shot;
use halfshade::technique::Settings;

/// [scene units] Heights above the floor: of the occluder and of the light.
pub const OCCLUDER: f64 = 1.0;
pub const LIGHT: f64 = 2.0;
/// [scene units] Where the camera looks straight down from, below the occluder.
pub const EYE: DVec3 = DVec3::new(0.1, 0.8, 0.05);
pub const SIZE: (u32, u32) = (56, 40);
pub const VFOV_DEG: f64 = 90.0;

/// A rectangle parallel to the floor: two triangles seen from above, `low` and `high` its corners.
pub fn plate(scene: &mut Scene, material: Material, height: f64, low: [f64; 2], high: [f64; 2]) {
    let first = scene.positions.len() as u32;
    for (x, z, uv) in [
        (low[0], low[1], Vec2::ZERO),
        (high[0], low[1], Vec2::X),
        (low[0], high[1], Vec2::Y),
        (high[0], high[1], Vec2::ONE),
    ] {
        scene.positions.push(DVec3::new(x, height, z));
        scene.texcoords.push(uv);
    }
    let masked = material.alpha_cutoff.is_some();
    for triangle in [[0, 2, 1], [1, 2, 3]] {
        scene.triangles.push(triangle.map(|i: u32| first + i));
        scene.triangle_materials.push(scene.materials.len() as u32);
        scene.opaque_count += usize::from(!masked);
    }
    scene.materials.push(material);
}

pub fn grey() -> Material {
    Material {
        name: String::new(),
        base_color: Vec4::ONE,
        texture: None,
        alpha_cutoff: None,
        double_sided: false,
    }
}

pub fn floor() -> Scene {
    let mut scene = Scene::default();
    plate(&mut scene, grey(), 0.0, [-10.0; 2], [10.0; 2]);
    scene
}

/// Parallel to the floor, shining down.
pub fn rect(u: f64, v: f64) -> LightShape {
    LightShape::Rect {
        u: DVec3::X * u,
        v: DVec3::Z * v,
    }
}

/// The scene moved to `origin` with a light above its middle and the camera under the occluder.
pub fn shot(mut scene: Scene, origin: DVec3, shape: LightShape) -> Shot {
    for position in &mut scene.positions {
        *position += origin;
    }
    let light = AreaLight {
        name: String::new(),
        center: origin + DVec3::Y * LIGHT,
        shape,
        color: Vec3::ONE,
        intensity: None,
        beam: None,
    };
    let camera = Camera {
        name: String::new(),
        eye: origin + EYE,
        target: origin + EYE - DVec3::Y,
        up: -DVec3::Z,
        vfov_deg: VFOV_DEG,
        aspect: None,
        ortho_height: None,
        near: None,
    };
    let (width, height) = SIZE;
    let (scene, lights, notes) = (Arc::new(scene), vec![light], vec![]);
    Shot {
        scene,
        camera,
        width,
        height,
        lights,
        settings: Settings::default(),
        budget_map: None,
        physical: false,
        notes,
    }
}

pub fn traced(shot: &Shot, samples: u32) -> ReferenceImage {
    let options = ReferenceOptions { samples, seed: 7 };
    trace(shot, 0, options, &|_| {}, &AtomicBool::new(false)).unwrap()
}

/// Every pixel's index and the floor point (x, z) in its centre.
pub fn floor_points() -> impl Iterator<Item = (usize, f64, f64)> {
    let (width, height) = (SIZE.0 as usize, SIZE.1 as usize);
    let reach = EYE.y * (VFOV_DEG.to_radians() / 2.0).tan();
    (0..width * height).map(move |index| {
        let along = |i: usize, n: usize| (i as f64 + 0.5) / n as f64 * 2.0 - 1.0;
        let aspect = width as f64 / height as f64;
        let x = EYE.x + along(index % width, width) * reach * aspect;
        (index, x, EYE.z + along(index / width, height) * reach)
    })
}

/// An occluder that covers all x below `edge`, as far as any ray of these tests can tell.
pub fn half_plane(edge: f64) -> Scene {
    let mut scene = floor();
    plate(
        &mut scene,
        grey(),
        OCCLUDER,
        [-100.0, -100.0],
        [edge, 100.0],
    );
    scene
}
