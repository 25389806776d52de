//! Lights and their views as the device sees them.

use std::f64::consts::PI;

use glam::DVec3;

use crate::scene::{AreaLight, Ball, Outline, Spread};
use crate::shared::{self, ALL_CONES, View};
use crate::shot::Shot;
use crate::sub_light::{Cut, Part};

/// What a light's views are fitted to, beside the light itself.
#[derive(Debug, Clone, Copy)]
pub struct MapParams {
    /// [scene units, world] What positions on the device are relative to.
    pub origin: DVec3,
    /// [texel] Width and height of a shadow map.
    pub map: u32,
    /// [texel] Slope bias.
    pub bias: f32,
    /// [scene units] Height over the light's plane up to which surfaces are the lamp's own.
    pub touch: f64,
    /// [level] Of the hierarchy that there is memory for.
    pub levels: u32,
    /// Around the scene.
    pub ball: Ball,
}

/// Which part of a light a view looks from, and in which direction.
#[derive(Debug, Clone)]
pub struct ViewPose {
    pub part: Part,
    /// 0 = front; 1, 2 = along ±u; 3, 4 = along ±v.
    pub face: usize,
    /// The light's side that it looks from ([`AreaLight::side`]).
    pub side: usize,
    /// Tangent up to which the front face holds receivers; the largest there is where the light has no side faces.
    pub reach: f32,
}

impl ViewPose {
    /// The view where the light stands. Does not allocate.
    pub fn view(&self, params: &MapParams, light: &AreaLight, sector_first: u32) -> View {
        let side = light.side(self.side, &params.ball);
        let (part, (u, v, n)) = (self.part.of(&side.light), side.light.frame());
        // right × up = forward.
        let [right, up, forward] = match self.face {
            0 => [u, v, n],
            1 => [v, n, u],
            2 => [n, v, -u],
            3 => [n, u, v],
            _ => [u, n, -v],
        };
        let array = |vector: DVec3| -> [f32; 3] { vector.as_vec3().into() };
        let rim = match part.cut {
            Cut::Rim { center, radius } => [center.x as f32, center.y as f32, radius as f32],
            Cut::Nothing | Cut::Edges(_) => [0.0; 3],
        };
        let (half, (lower, upper)) = (part.half_size, part.extent);
        // The sun's parts differ in their rays' directions.
        let (center, ray) = match side.parallel {
            0.0 => (part.center, n),
            length => {
                let middle = side.light.center;
                (middle, n - (part.center - middle) / length)
            }
        };
        let center = center - params.origin;
        View {
            center: array(center),
            center_residual: array(center - center.as_vec3().as_dvec3()),
            touch: params.touch as f32,
            right: array(right),
            up: array(up),
            forward: array(forward),
            light_u: array(u / half.x),
            light_v: array(v / half.y),
            light_n: array(n),
            half_size: half.as_vec2().into(),
            extent: [
                lower.x as f32,
                lower.y as f32,
                upper.x as f32,
                upper.y as f32,
            ],
            rim,
            area: part.area as f32,
            weight: self.part.weight() as f32,
            sector_first,
            face: self.face as u32,
            reach: self.reach,
            map_size: params.map,
            bias: params.bias,
            levels_max: params.levels.max(1),
            parallel: side.parallel as f32,
            ray: array(ray),
            sphere: (light.center - params.origin)
                .extend(light.half_size().0)
                .as_vec4()
                .into(),
            cone: side.cone.map_or(ALL_CONES, |cone| cone + 1),
            beam: array(light.beam.map_or(DVec3::ZERO, |beam| beam.axis())),
            beam_cosine: light.beam.map_or(0.0, |beam| beam.least_cosine()) as f32,
        }
    }
}

/// The light where it stands. `intensity`: see [`intensity`]; `weight_sum`: of its parts, in the order in which the views add up.
pub fn whole_light(
    origin: DVec3,
    light: &AreaLight,
    intensity: [f32; 3],
    weight_sum: f32,
    views: std::ops::Range<u32>,
    corner_first: u32,
) -> shared::Light {
    let outline = light.outline();
    let (u, v, n) = light.frame();
    let half = light.half_size();
    let (beam_start, beam_slope) = light.beam.map_or((0.0, 0.0), |beam| beam.border());
    shared::Light {
        center: (light.center - origin).as_vec3().into(),
        u: u.as_vec3().into(),
        v: v.as_vec3().into(),
        n: n.as_vec3().into(),
        half_size: [half.0 as f32, half.1 as f32],
        round: u32::from(outline == Outline::Disc),
        area: outline.area() as f32,
        corner_first,
        corner_count: outline.corners().len() as u32,
        weight_sum,
        spread: light.spread() as u32,
        intensity,
        beam: light
            .beam
            .map_or(DVec3::ZERO, |beam| beam.axis())
            .as_vec3()
            .into(),
        beam_start: beam_start as f32,
        beam_slope: beam_slope as f32,
        view_first: views.start,
        view_count: views.len() as u32,
    }
}

/// Sum of the parts' weights in f32, in the order in which the views add up, so that a fully hidden light is
/// exactly so.
pub fn weight_sum<'a>(parts: impl Iterator<Item = &'a Part>) -> f32 {
    let weights = parts.map(|part| part.weight() as f32);
    weights.fold(0.0, |sum, weight| sum + weight)
}

/// [radiance · scene units²] Linear RGB radiance times area, which for a sun is that of a disc of its angular radius at distance 1;
/// for a light without extent its radiant intensity, straight ahead if it has a direction. Unless it is given, such that a white surface at the camera's target that faces the light's centre
/// has radiance 1 from that light, as long as the light is small against its distance; at least a radiance of 1.
pub fn intensity(shot: &Shot, light: &AreaLight) -> [f32; 3] {
    if light.spread() == Spread::Sun {
        return sun_intensity(light);
    }
    let area = light.area();
    let way = shot.camera.target - light.center;
    let (_, _, normal) = light.frame();
    let cosine = match light.spread() {
        Spread::Plane => normal.dot(way.normalize_or(normal)).abs().max(0.1),
        _ => 1.0,
    };
    let intensity = match light.intensity.map(f64::from) {
        None => area.max(PI * way.length_squared() / cosine),
        Some(intensity) if light.is_point() => intensity,
        Some(radiance) => radiance * area,
    };
    colored(light, intensity)
}

/// Factor on radiance that shows a shot's lights: 1, or where they come in physical units such that a white surface at the camera's
/// target that faces each of them has radiance 1 from all of them together, as the eye weighs colours.
pub fn suited_exposure(shot: &Shot) -> f32 {
    const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];
    let luminance = |light: &AreaLight| {
        let facing = match light.spread() {
            Spread::Sun => 1.0,
            _ => (shot.camera.target - light.center).length_squared(),
        };
        let channels = intensity(shot, light).into_iter().zip(LUMINANCE);
        let weighed: f64 = channels
            .map(|(channel, share)| f64::from(channel) * share)
            .sum();
        weighed / (PI * facing.max(f64::MIN_POSITIVE))
    };
    let radiance: f64 = shot.lights.iter().map(luminance).sum();
    match shot.physical && radiance.is_normal() {
        true => (1.0 / radiance).clamp(f32::MIN_POSITIVE.into(), f32::MAX.into()) as f32,
        false => 1.0,
    }
}

fn sun_intensity(light: &AreaLight) -> [f32; 3] {
    // A surface that faces a sun of radiance L has irradiance π sin² · L, where its radiance times area is π tan² · L.
    let (tangent, _) = light.half_size();
    let irradiance = light.intensity.map_or(PI, f64::from);
    colored(light, irradiance * (1.0 + tangent * tangent))
}

fn colored(light: &AreaLight, intensity: f64) -> [f32; 3] {
    let channel = |color: f32| (f64::from(color) * intensity).min(f64::from(f32::MAX)) as f32;
    light.color.to_array().map(channel)
}
