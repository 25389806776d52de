//! From C's structures to the library's, and back.

use glam::{DVec3, Vec3};

use super::check::flag;
use super::outcome::{Fault, Outcome};
use super::types::*;
use crate::scene::{AreaLight, Camera, LightShape};
use crate::shot::{Leaf, Mapping, Occluders, Pattern, Settings, Technique};

/// In the order of HS_TECHNIQUE_...
const TECHNIQUES: [Technique; 9] = [
    Technique::PacketContour,
    Technique::PixelContour,
    Technique::Micropatch,
    Technique::MicropatchHierarchical,
    Technique::Bitmask,
    Technique::DepthPeeling,
    Technique::Pcss,
    Technique::Hard,
    Technique::ReferenceMaps,
];
const LEAVES: [Leaf; 2] = [Leaf::Reprocess, Leaf::PerPixel];
const MAPPINGS: [Mapping; 2] = [Mapping::Serial, Mapping::Lanes];
const OCCLUDERS: [Occluders; 2] = [Occluders::Micropatches, Occluders::Contours];
const PATTERNS: [Pattern; 2] = [Pattern::Regular, Pattern::Jittered];

/// The value that a number stands for.
pub fn choice<T: Copy>(list: &[T], number: u32, name: &str) -> Outcome<T> {
    list.get(number as usize).copied().ok_or_else(|| {
        Fault::invalid(format!(
            "{name} is 0 to {}, not {number}",
            list.len().saturating_sub(1)
        ))
    })
}

fn number<T: PartialEq>(list: &[T], value: &T) -> u32 {
    list.iter()
        .position(|known| known == value)
        .unwrap_or_default() as u32
}

pub fn technique(number: u32) -> Outcome<Technique> {
    choice(&TECHNIQUES, number, "technique")
}

/// A field that is there for later versions.
pub fn reserved(value: u32) -> Outcome {
    match value {
        0 => Ok(()),
        _ => Err(Fault::invalid("a reserved field is not 0")),
    }
}

pub fn settings(given: &hs_settings) -> Outcome<Settings> {
    let settings = Settings {
        technique: technique(given.technique)?,
        packet: (given.packet_width, given.packet_height),
        leaf: choice(&LEAVES, given.leaf, "leaf")?,
        mapping: choice(&MAPPINGS, given.mapping, "mapping")?,
        split: given.split,
        map: given.map,
        mssm_bits: given.mssm_bits,
        footprint_pruning: flag(given.footprint_pruning, "footprint_pruning")?,
        hierarchical: flag(given.hierarchical, "hierarchical")?,
        gap_filling: flag(given.gap_filling, "gap_filling")?,
        layers: given.layers,
        occluders: choice(&OCCLUDERS, given.occluders, "occluders")?,
        light_samples: given.light_samples,
        pattern: choice(&PATTERNS, given.pattern, "pattern")?,
        blocker_samples: given.blocker_samples,
        filter_samples: given.filter_samples,
        percentage_closer: flag(given.percentage_closer, "percentage_closer")?,
        maps: given.maps,
        near_points: given.near_points,
        bias: (given.bias != USUAL_BIAS).then_some(given.bias),
        counters: flag(given.counters, "counters")?,
    };
    settings.validate()?;
    Ok(settings)
}

/// Asks for the bias that is usual for what runs.
const USUAL_BIAS: f32 = -1.0;

/// Fills all but the head.
pub fn write_settings(target: &mut hs_settings, settings: &Settings) {
    *target = hs_settings {
        r#type: target.r#type,
        size: target.size,
        next: target.next,
        technique: number(&TECHNIQUES, &settings.technique),
        packet_width: settings.packet.0,
        packet_height: settings.packet.1,
        leaf: number(&LEAVES, &settings.leaf),
        mapping: number(&MAPPINGS, &settings.mapping),
        split: settings.split,
        map: settings.map,
        mssm_bits: settings.mssm_bits,
        footprint_pruning: settings.footprint_pruning.into(),
        hierarchical: settings.hierarchical.into(),
        gap_filling: settings.gap_filling.into(),
        layers: settings.layers,
        occluders: number(&OCCLUDERS, &settings.occluders),
        light_samples: settings.light_samples,
        pattern: number(&PATTERNS, &settings.pattern),
        blocker_samples: settings.blocker_samples,
        filter_samples: settings.filter_samples,
        percentage_closer: settings.percentage_closer.into(),
        maps: settings.maps,
        near_points: settings.near_points,
        bias: settings.bias.unwrap_or(USUAL_BIAS),
        counters: settings.counters.into(),
    };
}

pub fn camera(given: &hs_camera) -> Outcome<Camera> {
    let camera = Camera {
        name: String::new(),
        eye: DVec3::from_array(given.eye),
        target: DVec3::from_array(given.target),
        up: DVec3::from_array(given.up),
        vfov_deg: given.vfov_deg,
        aspect: None,
        near: None,
    };
    camera.validate()?;
    Ok(camera)
}

/// A light; takes no memory.
pub fn light(given: &hs_light) -> Outcome<AreaLight> {
    reserved(given.reserved)?;
    let shape = match given.shape {
        HS_LIGHT_RECT => LightShape::Rect {
            u: DVec3::from_array(given.u),
            v: DVec3::from_array(given.v),
        },
        HS_LIGHT_DISC => LightShape::Disc {
            normal: DVec3::from_array(given.normal),
            radius: given.radius,
        },
        other => {
            return Err(Fault::invalid(format!(
                "the shape of a light is HS_LIGHT_RECT or HS_LIGHT_DISC, not {other}"
            )));
        }
    };
    let light = AreaLight {
        name: String::new(),
        center: DVec3::from_array(given.center),
        shape,
        color: Vec3::from_array(given.color),
        // NaN is not below 0, and is refused.
        intensity: (given.intensity >= 0.0 || given.intensity.is_nan()).then_some(given.intensity),
    };
    light.validate()?;
    Ok(light)
}
