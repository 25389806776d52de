//! From C's structures to the library's, and back.

use glam::{DVec3, Vec3};

use super::call_result::{CallResult, Fault};
use super::check::{self, extended, extended_once};
use super::types::*;
use crate::scene::{AreaLight, Beam, Camera, LightShape};
use crate::technique::{KNOBS, Knob, Settings, Technique};

/// The value that a number stands for.
pub fn choice<T: Copy>(list: &[T], number: u32, name: &str) -> CallResult<T> {
    list.get(number as usize).copied().ok_or_else(|| {
        Fault::invalid(format!(
            "{name} is 0 to {}, not {number}",
            list.len().saturating_sub(1)
        ))
    })
}

pub fn technique(number: u32) -> CallResult<Technique> {
    choice(Technique::ALL, number, "technique")
}

/// A field that is there for later versions.
pub fn reserved(value: u32) -> CallResult {
    match value {
        0 => Ok(()),
        _ => Err(Fault::invalid("a reserved field is not 0")),
    }
}

/// The fields of hs_settings that are knobs, each by the name of the knob.
macro_rules! knob_fields {
    ($with:ident) => {
        $with!(
            technique,
            leaf,
            mapping,
            split,
            map,
            mssm_bits,
            footprint_pruning,
            hierarchical,
            gap_filling,
            layers,
            occluders,
            light_samples,
            pattern,
            blocker_samples,
            filter_samples,
            percentage_closer,
            maps,
            near_points,
            counters
        )
    };
}

/// The settings that the caller has filled, with the knobs that extend them.
///
/// # Safety
/// As for [`extended`], and the texts of knobs end with a NUL.
pub unsafe fn settings(pointer: *const hs_settings) -> CallResult<Settings> {
    // SAFETY: the caller's promise, here and below.
    let (given, knobs): (hs_settings, Vec<hs_knob>) = unsafe { extended(pointer) }?;
    let mut settings = Settings {
        packet: (given.packet_width, given.packet_height),
        bias: (given.bias != USUAL_BIAS).then_some(given.bias),
        ..Settings::default()
    };
    macro_rules! read {
        ($($field:ident),+) => {
            $(knob(stringify!($field))?.set_number(&mut settings, given.$field)?;)+
        };
    }
    knob_fields!(read);
    for knob in &knobs {
        let text = |pointer, name| {
            let text = unsafe { check::text(pointer, name) }?;
            text.ok_or_else(|| Fault::invalid(format!("hs_knob: {name} is NULL")))
        };
        turn(
            &mut settings,
            &text(knob.name, "name")?,
            &text(knob.value, "value")?,
        )?;
    }
    settings.validate()?;
    Ok(settings)
}

/// Sets a knob by the name of its flag.
fn turn(settings: &mut Settings, name: &str, value: &str) -> CallResult {
    let found = KNOBS.iter().find(|knob| knob.row.flag == name);
    let knob = found.ok_or_else(|| Fault::invalid(format!("there is no knob {name:?}")))?;
    match (knob.row.is_switch(), value) {
        (true, "1") => Ok(knob.set(settings, "")?),
        (true, "0") => Ok(knob.unset(settings)?),
        (true, _) => Err(Fault::invalid(format!(
            "{name} is \"1\" or \"0\", not {value:?}"
        ))),
        (false, _) => Ok(knob.set(settings, value)?),
    }
}

/// Asks for the bias that is usual for what runs.
const USUAL_BIAS: f32 = -1.0;

/// Fills all but the head.
pub fn write_settings(target: &mut hs_settings, settings: &Settings) -> CallResult {
    (target.packet_width, target.packet_height) = settings.packet;
    target.bias = settings.bias.unwrap_or(USUAL_BIAS);
    macro_rules! write {
        ($($field:ident),+) => {
            $(target.$field = knob(stringify!($field))?.number(settings);)+
        };
    }
    knob_fields!(write);
    Ok(())
}

/// The knob of a field.
fn knob(field: &str) -> CallResult<&'static Knob> {
    let found = KNOBS.iter().find(|knob| knob.field == field);
    found.ok_or_else(|| Fault::invalid(format!("there is no knob {field}")))
}

pub fn camera(given: &hs_camera) -> CallResult<Camera> {
    let camera = Camera {
        name: String::new(),
        eye: DVec3::from_array(given.eye),
        target: DVec3::from_array(given.target),
        up: DVec3::from_array(given.up),
        vfov_deg: given.vfov_deg,
        aspect: None,
        ortho_height: None,
        near: None,
    };
    camera.validate()?;
    Ok(camera)
}

/// A light; takes no memory unless it is refused.
///
/// # Safety
/// As for [`extended_once`], and a polygon's corners are as many as it says.
pub unsafe fn light(pointer: *const hs_light) -> CallResult<AreaLight> {
    // SAFETY: the caller's promise, here and below.
    let (given, polygon): (hs_light, Option<hs_polygon>) = unsafe { extended_once(pointer) }?;
    reserved(given.reserved)?;
    if polygon.is_some() && given.shape != HS_LIGHT_POLYGON {
        return Err(Fault::invalid(
            "an hs_polygon extends a light whose shape is HS_LIGHT_POLYGON",
        ));
    }
    let mut center = DVec3::from_array(given.center);
    let shape = match given.shape {
        HS_LIGHT_RECT => LightShape::Rect {
            u: DVec3::from_array(given.u),
            v: DVec3::from_array(given.v),
        },
        HS_LIGHT_DISC => LightShape::Disc {
            normal: DVec3::from_array(given.normal),
            radius: given.radius,
        },
        HS_LIGHT_SPHERE => LightShape::Sphere {
            radius: given.radius,
        },
        HS_LIGHT_SUN => LightShape::Sun {
            direction: DVec3::from_array(given.normal),
            angle_deg: given.radius,
        },
        HS_LIGHT_POLYGON => {
            let polygon = polygon.ok_or_else(|| {
                Fault::invalid("hs_light: next must be the hs_polygon of HS_LIGHT_POLYGON")
            })?;
            // A DVec3 is three f64, in C's layout.
            let corners: *const DVec3 = polygon.corners.cast();
            let corners = unsafe { check::slice(corners, polygon.corner_count, "corners") }?;
            let (middle, shape) = LightShape::polygon(corners)?;
            center = middle;
            shape
        }
        other => {
            return Err(Fault::invalid(format!(
                "the shape of a light is one of HS_LIGHT_..., not {other}"
            )));
        }
    };
    let beam = (given.cone_deg != [0.0; 2]).then_some(Beam {
        direction: DVec3::from_array(given.normal),
        inner_deg: given.cone_deg[0],
        outer_deg: given.cone_deg[1],
    });
    let light = AreaLight {
        name: String::new(),
        center,
        shape,
        color: Vec3::from_array(given.color),
        // NaN is not below 0, and is refused.
        intensity: (given.intensity >= 0.0 || given.intensity.is_nan()).then_some(given.intensity),
        beam,
    };
    light.validate()?;
    Ok(light)
}
