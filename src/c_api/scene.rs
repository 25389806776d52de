//! Scenes from arrays and from files.

use std::ffi::c_char;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3, Vec4};

use super::call::call;
use super::call_result::{CallResult, Fault};
use super::check::{collected, flag, input, output, path, place, slice, structures_of};
use super::context::{CONTEXTS, Held};
use super::convert::{choice, reserved};
use super::handles::Registry;
use super::types::*;
use crate::scene::gltf::{self, LoadOptions};
use crate::scene::{Material, Scene, Texture, Triangles, Wrap};

/// All living scenes.
pub static SCENES: Registry<hs_scene, Held<Arc<Scene>>> = Registry::new("scene");

/// Builds a scene from arrays, which are copied. On failure `*scene` is NULL.
///
/// Any thread.
///
/// # Safety
/// `info` points to a structure whose arrays have the stated numbers of elements, `scene` to a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_scene_create(
    context: *mut hs_context,
    info: *const hs_scene_info,
    scene: *mut *mut hs_scene,
) -> hs_result {
    call(|scope| {
        // SAFETY: the caller's promise, here and below.
        let target = unsafe { place(scene, "the pointer to the scene") }?;
        *target = std::ptr::null_mut();
        let context = CONTEXTS.enter(scope, context)?;
        let info = unsafe { input(info) }?;
        let built = unsafe { build(&info) }?;
        context.note(&built.notes);
        *target = SCENES.add(Held::new(&context, Arc::new(built)))?;
        Ok(())
    })
}

/// Loads a scene from a glTF 2.0 file, .gltf or .glb, that may be anything: what is wrong with it is an error.
/// `path` is UTF-8. What is left out or treated otherwise goes to the log. On failure `*scene` is NULL.
///
/// Any thread.
///
/// # Safety
/// `path` ends with a NUL, `scene` points to a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_scene_load(
    context: *mut hs_context,
    path: *const c_char,
    scene: *mut *mut hs_scene,
) -> hs_result {
    call(|scope| {
        // SAFETY: the caller's promise, here and below.
        let target = unsafe { place(scene, "the pointer to the scene") }?;
        *target = std::ptr::null_mut();
        let context = CONTEXTS.enter(scope, context)?;
        let file = unsafe { self::path(path, "path") }?;
        let loaded = gltf::load(&file, &LoadOptions::default())?;
        context.note(&loaded.notes);
        *target = SCENES.add(Held::new(&context, Arc::new(loaded)))?;
        Ok(())
    })
}

/// Lets go of a scene; NULL is fine. Shots and renderers keep what they need of it. A handle that was destroyed
/// before is ignored.
///
/// Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn hs_scene_destroy(scene: *mut hs_scene) {
    SCENES.remove(scene);
}

/// Tells what a scene holds.
///
/// Any thread.
///
/// # Safety
/// `counts` points to a structure with `type` and `size` set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_scene_describe(
    scene: *const hs_scene,
    counts: *mut hs_scene_counts,
) -> hs_result {
    call(|scope| {
        let scene = SCENES.enter(scope, scene)?;
        // SAFETY: the caller's promise.
        let target = unsafe { output(counts) }?;
        scene.with(|scene| {
            let (lower, upper) = scene.bounds();
            target.vertices = scene.positions.len() as u64;
            target.triangles = scene.triangles.len() as u64;
            target.masked_triangles = (scene.triangles.len() - scene.opaque_count) as u64;
            target.lights = scene.lights.len() as u64;
            target.cameras = scene.cameras.len() as u64;
            target.lower = lower.into();
            target.upper = upper.into();
            Ok(())
        })
    })
}

/// # Safety
/// The arrays have the stated numbers of elements.
unsafe fn build(info: &hs_scene_info) -> CallResult<Scene> {
    // SAFETY: the caller's promise, here and below.
    let floats = |pointer: *const f32, each: u64, name| {
        let count = info.vertex_count.saturating_mul(each);
        unsafe { slice(pointer, count, name) }
    };
    if info.triangle_count > MAX_TRIANGLES {
        return Err(Fault::invalid(format!(
            "{} triangles are more than {MAX_TRIANGLES}",
            info.triangle_count
        )));
    }
    if info.indices.is_null() && info.triangle_count > info.vertex_count / 3 {
        return Err(Fault::invalid(
            "without indices a triangle takes three vertices of its own; there are too few",
        ));
    }
    let positions = floats(info.positions, 3, "positions")?;
    let texcoords = match info.texcoords.is_null() {
        true => &[],
        false => floats(info.texcoords, 2, "texcoords")?,
    };
    let triangles = info.triangle_count as u32;
    let indices: Vec<[u32; 3]> = match info.indices.is_null() {
        true => collected(
            (0..triangles).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]),
            "triangles",
        )?,
        false => {
            let indices = unsafe { slice(info.indices, 3 * info.triangle_count, "indices") }?;
            collected(indices.as_chunks().0.iter().copied(), "triangles")?
        }
    };
    let surfaces = match info.triangle_materials.is_null() {
        true => collected((0..triangles).map(|_| 0), "materials of triangles")?,
        false => {
            let name = "triangle_materials";
            let given = unsafe { slice(info.triangle_materials, info.triangle_count, name) }?;
            collected(given.iter().copied(), "materials of triangles")?
        }
    };
    let vectors = |list: &[f32]| {
        collected(
            list.as_chunks().0.iter().map(|v| Vec3::from_array(*v)),
            "vertices",
        )
    };
    let scene = Scene::from_triangles(Triangles {
        origin: DVec3::from_array(info.origin),
        positions: vectors(positions)?,
        texcoords: collected(
            texcoords.as_chunks().0.iter().map(|t| Vec2::from_array(*t)),
            "texture coordinates",
        )?,
        indices,
        surfaces,
        materials: unsafe { materials(info) }?,
        textures: unsafe { textures(info) }?,
        ..Triangles::default()
    })?;
    Ok(scene)
}

/// As many as a file may hold.
const MAX_TRIANGLES: u64 = 1 << 26;
/// [texel] Largest side of a texture, and most texels of all.
const MAX_TEXTURE_SIDE: u32 = 16384;
const MAX_TEXELS: u64 = 1 << 28;

/// # Safety
/// The array has the stated number of elements.
unsafe fn materials(info: &hs_scene_info) -> CallResult<Vec<Material>> {
    // SAFETY: the caller's promise.
    let given = unsafe { structures_of(info.materials, info.material_count, "materials") }?;
    let materials = given.iter().enumerate().map(|(index, given)| {
        reserved(given.reserved)?;
        Ok(Material {
            name: format!("material {index}"),
            base_color: Vec4::from_array(given.base_color),
            texture: (given.texture != HS_NO_TEXTURE).then_some(given.texture as usize),
            alpha_cutoff: (given.alpha_cutoff != 0.0).then_some(given.alpha_cutoff),
            double_sided: flag(given.double_sided, "double_sided")?,
        })
    });
    materials.collect()
}

/// # Safety
/// The arrays have the stated numbers of elements.
unsafe fn textures(info: &hs_scene_info) -> CallResult<Vec<Texture>> {
    const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
    // SAFETY: the caller's promise, here and below.
    let given = unsafe { structures_of(info.textures, info.texture_count, "textures") }?;
    let mut texels_left = MAX_TEXELS;
    let textures = given.iter().map(|given| {
        reserved(given.reserved)?;
        let sides = 1..=MAX_TEXTURE_SIDE;
        let texels = u64::from(given.width) * u64::from(given.height);
        if !sides.contains(&given.width) || !sides.contains(&given.height) || texels > texels_left {
            return Err(Fault::invalid(format!(
                "a texture is 1 to {MAX_TEXTURE_SIDE} texels wide and high, and all have at most {MAX_TEXELS}"
            )));
        }
        texels_left -= texels;
        let rgba = unsafe { slice(given.rgba, 4 * texels, "rgba") }?;
        Ok(Texture {
            width: given.width,
            height: given.height,
            rgba: collected(rgba.iter().copied(), "bytes of texels")?,
            wrap: [
                choice(&WRAPS, given.wrap[0], "wrap")?,
                choice(&WRAPS, given.wrap[1], "wrap")?,
            ],
            linear: flag(given.linear, "linear")?,
        })
    });
    textures.collect()
}
