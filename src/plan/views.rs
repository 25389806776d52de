//! Lights and their views as the device sees them.

use glam::DVec3;

use super::{Variant, ViewPlan};
use crate::scene::{AreaLight, LightShape};
use crate::shared::{self, FRONT_REACH, View};
use crate::shot::Shot;
use crate::sub_light::SubLight;

pub fn view_plan(
    shot: &Shot,
    light: &AreaLight,
    part: &SubLight,
    face: usize,
    faces: &[usize],
    accumulate: bool,
) -> ViewPlan {
    let (u, v, n) = light.frame();
    // right × up = forward.
    let [right, up, forward] = match face {
        0 => [u, v, n],
        1 => [v, n, u],
        2 => [n, v, -u],
        3 => [n, u, v],
        _ => [u, n, -v],
    };
    let array = |vector: DVec3| -> [f32; 3] { vector.as_vec3().into() };
    let rim = part.rim.map_or([0.0; 3], |(center, radius)| {
        [center.x as f32, center.y as f32, radius as f32]
    });
    let (half, (lower, upper)) = (part.half_size, part.extent);
    let area = part.area as f32;
    let view = View {
        center: array(part.center - shot.scene.origin),
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
        area,
        weight: area,
        sector_first: 0,
        face: face as u32,
        reach: if faces == [0] { f32::MAX } else { FRONT_REACH },
        map_size: shot.settings.map,
        bias: shot.settings.bias,
        levels_max: 0,
    };
    ViewPlan {
        view,
        variant: Variant {
            round: part.rim.is_some(),
            oblique: face != 0,
            accumulate,
        },
        sectors: part.rim.map(|_| part.sectors.clone()),
    }
}

pub fn whole_light(
    shot: &Shot,
    light: &AreaLight,
    parts: &[SubLight],
    view_first: u32,
    view_count: u32,
) -> shared::Light {
    let (u, v, n) = light.frame();
    let half = light.half_size();
    shared::Light {
        center: (light.center - shot.scene.origin).as_vec3().into(),
        u: u.as_vec3().into(),
        v: v.as_vec3().into(),
        n: n.as_vec3().into(),
        half_size: [half.0 as f32, half.1 as f32],
        round: u32::from(matches!(light.shape, LightShape::Disc { .. })),
        // In the order in which the views add up, so that a fully hidden light is exactly so.
        weight_sum: parts
            .iter()
            .map(|part| part.area as f32)
            .fold(0.0, |sum, weight| sum + weight),
        radiance: radiance(shot, light),
        view_first,
        view_count,
    }
}

/// Linear RGB radiance; unless it is given, such that a white surface at the camera's target that faces the
/// light's centre has radiance 1 from that light. For a light without extent: radiant intensity.
fn radiance(shot: &Shot, light: &AreaLight) -> [f32; 3] {
    let way = shot.camera.target - light.center;
    let square = way.length_squared().max(f64::MIN_POSITIVE);
    let (_, _, normal) = light.frame();
    // The solid angle of a light that is small against its distance, or at most the hemisphere's share.
    let share = if light.is_point() {
        1.0 / square
    } else {
        (light.area() * normal.dot(way.normalize_or(normal)).abs().max(0.1)
            / square
            / std::f64::consts::PI)
            .min(1.0)
    };
    let intensity = light.intensity.unwrap_or((1.0 / share) as f32);
    (light.color * intensity).into()
}
