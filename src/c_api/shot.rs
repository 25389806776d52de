//! Shots: a scene with camera, lights, size and settings.

use std::ffi::c_char;
use std::sync::Arc;

use super::call::call;
use super::call_result::{CallResult, Fault};
use super::check::{each, input, output, path, place};
use super::context::{CONTEXTS, Held};
use super::convert;
use super::handles::Registry;
use super::scene::SCENES;
use super::types::*;
use crate::scene::{Camera, Scene};
use crate::shot::{Overrides, Shot};
use crate::technique::Settings;

/// [pixel] Width and height of the image of a shot whose camera was not set.
const SIZE: u32 = 512;

/// All living shots.
pub static SHOTS: Registry<hs_shot, Held<Shot>> = Registry::new("shot");

/// Makes a shot of a scene, with the scene's own first camera, if it has one, and its own lights, an image of
/// 512 x 512 pixels, and the usual settings of HS_TECHNIQUE_PACKET_CONTOUR. On failure `*shot` is NULL.
///
/// Any thread.
///
/// # Safety
/// `shot` points to a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_shot_create(
    scene: *mut hs_scene,
    shot: *mut *mut hs_shot,
) -> hs_result {
    call(|scope| {
        // SAFETY: the caller's promise.
        let target = unsafe { place(shot, "the pointer to the shot") }?;
        *target = std::ptr::null_mut();
        let scene = SCENES.enter(scope, scene)?;
        let shot = scene.with(|scene| Ok(shot_of(scene)))?;
        *target = SHOTS.add(Held::new(&scene.context, shot))?;
        Ok(())
    })
}

fn shot_of(scene: &Arc<Scene>) -> Shot {
    let (lower, upper) = scene.bounds();
    let middle = 0.5 * (lower + upper);
    let camera = scene.cameras.first().cloned().unwrap_or(Camera {
        name: String::new(),
        eye: middle + glam::DVec3::Z,
        target: middle,
        up: glam::DVec3::Y,
        vfov_deg: 45.0,
        aspect: None,
        ortho_height: None,
        near: None,
    });
    Shot {
        camera,
        width: SIZE,
        height: SIZE,
        lights: scene.lights.clone(),
        settings: Settings::default(),
        budget_map: None,
        physical: false,
        notes: Vec::new(),
        scene: scene.clone(),
    }
}

/// Loads a shot: a JSON file, or a .gltf or .glb that brings its own camera and light, as the program takes them.
/// `path` is UTF-8. The settings are the usual ones of HS_TECHNIQUE_PACKET_CONTOUR. What is ignored goes to the
/// log. On failure `*shot` is NULL.
///
/// Any thread.
///
/// # Safety
/// `path` ends with a NUL, `shot` points to a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_shot_load(
    context: *mut hs_context,
    path: *const c_char,
    shot: *mut *mut hs_shot,
) -> hs_result {
    call(|scope| {
        // SAFETY: the caller's promise, here and below.
        let target = unsafe { place(shot, "the pointer to the shot") }?;
        *target = std::ptr::null_mut();
        let context = CONTEXTS.enter(scope, context)?;
        let file = unsafe { self::path(path, "path") }?;
        let loaded = Shot::load(&file, &Overrides::default())?;
        context.note(loaded.notes.iter().chain(&loaded.scene.notes));
        *target = SHOTS.add(Held::new(&context, loaded))?;
        Ok(())
    })
}

/// Lets go of a shot; NULL is fine. Renderers keep what they need of it. A handle that was destroyed before is
/// ignored.
///
/// Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn hs_shot_destroy(shot: *mut hs_shot) {
    SHOTS.remove(shot);
}

/// Changes a shot, or leaves it as it was where the change makes no sense.
fn change(shot: *mut hs_shot, work: impl FnOnce(&mut Shot) -> CallResult) -> hs_result {
    call(|scope| SHOTS.enter(scope, shot)?.with(work))
}

/// Sets camera and size of the image. Renderers that exist keep theirs.
///
/// Any thread; calls on one shot wait for one another.
///
/// # Safety
/// `camera` points to a structure.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_shot_set_camera(
    shot: *mut hs_shot,
    camera: *const hs_camera,
) -> hs_result {
    change(shot, |shot| {
        // SAFETY: the caller's promise.
        let given = unsafe { input(camera) }?;
        let camera = convert::camera(&given)?;
        for side in [given.width, given.height] {
            if !(1..=crate::shot::MAX_SIZE).contains(&side) {
                return Err(Fault::invalid(format!(
                    "an image is 1 to {} pixels wide and high, not {}x{}",
                    crate::shot::MAX_SIZE,
                    given.width,
                    given.height
                )));
            }
        }
        (shot.width, shot.height, shot.camera) = (given.width, given.height, camera);
        Ok(())
    })
}

/// Replaces the lights, of which there may be at most 1024. Renderers that exist keep theirs.
///
/// Any thread; calls on one shot wait for one another.
///
/// # Safety
/// `lights` points to `count` structures, or is NULL when there are none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_shot_set_lights(
    shot: *mut hs_shot,
    lights: *const hs_light,
    count: u64,
) -> hs_result {
    const MAX_LIGHTS: u64 = 1024;
    change(shot, |shot| {
        if count > MAX_LIGHTS {
            return Err(Fault::invalid(format!(
                "{count} lights are more than {MAX_LIGHTS}"
            )));
        }
        // SAFETY: the caller's promise.
        let light = |place| unsafe { convert::light(place) };
        shot.lights = unsafe { each(lights, count, "lights", light) }?;
        Ok(())
    })
}

/// Replaces the settings. Renderers that exist keep theirs.
///
/// Any thread; calls on one shot wait for one another.
///
/// # Safety
/// `settings` points to a structure.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_shot_set_settings(
    shot: *mut hs_shot,
    settings: *const hs_settings,
) -> hs_result {
    change(shot, |shot| {
        // SAFETY: the caller's promise.
        shot.settings = unsafe { convert::settings(settings) }?;
        Ok(())
    })
}

/// Fills all of `settings` but `type`, `size` and `next` with what a technique is known by.
///
/// Any thread.
///
/// # Safety
/// `settings` points to a structure with `type` and `size` set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_settings_default(
    technique: u32,
    settings: *mut hs_settings,
) -> hs_result {
    call(|_| {
        // SAFETY: the caller's promise.
        let target = unsafe { output(settings) }?;
        convert::write_settings(target, &Settings::usual(convert::technique(technique)?))
    })
}

/// Tells the size of a shot's image and how many lights it has.
///
/// Any thread; calls on one shot wait for one another.
///
/// # Safety
/// `counts` points to a structure with `type` and `size` set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_shot_describe(
    shot: *const hs_shot,
    counts: *mut hs_shot_counts,
) -> hs_result {
    call(|scope| {
        let shot = SHOTS.enter(scope, shot)?;
        // SAFETY: the caller's promise.
        let target = unsafe { output(counts) }?;
        shot.with(|shot| {
            target.width = shot.width;
            target.height = shot.height;
            target.lights = shot.lights.len() as u32;
            target.reserved = 0;
            Ok(())
        })
    })
}
