//! A light's visibility from what its views found hidden: twin of `resolve.comp`.

use glam::{Vec2, Vec3};

use super::beam;
use super::facing::Facing;
use super::outline;
use crate::shared::{HORIZON_ROUNDING, Light, SPREAD_POINT};

/// 0 umbra … 1 lit; 0 where the surface faces away from the whole light, lies behind it or out of its beam.
///
/// `hidden`: sum over the light's views of what they hide, each weighed by its `weight`.
/// `corners`: of all polygons.
pub fn visibility(
    light: &Light,
    corners: &[[f32; 2]],
    position: Vec3,
    normal: Vec3,
    hidden: f64,
) -> f64 {
    if beam::share(light, position) == 0.0 {
        return 0.0;
    }
    let facing = Facing::new(light, position, normal);
    if facing.inside {
        return 1.0;
    }
    if !faces_light(&facing, corners, normal) {
        return 0.0;
    }
    if light.view_count == 0 {
        return 1.0;
    }
    (1.0 - hidden / f64::from(light.weight_sum)).clamp(0.0, 1.0)
}

/// Whether any part of the light is in front of the surface, and the surface in front of the light, beyond rounding: a
/// decision, taken in f32 as the shader takes it.
fn faces_light(facing: &Facing, corners: &[[f32; 2]], normal: Vec3) -> bool {
    let (light, to_point, magnitude) = (&facing.light, -facing.way, facing.magnitude);
    let along = Vec2::new(normal.dot(light.u.into()), normal.dot(light.v.into()))
        * Vec2::from(light.half_size);
    let reach = match outline::corners_of(light, corners) {
        [] if light.round != 0 => along.length(),
        [] => along.x.abs() + along.y.abs(),
        corners => outline::reach(corners, along),
    };
    let rounding = HORIZON_ROUNDING * (magnitude.x + magnitude.y + magnitude.z);
    let in_front = light.spread == SPREAD_POINT || to_point.dot(light.n.into()) > rounding;
    in_front && reach - normal.dot(to_point) > rounding
}
