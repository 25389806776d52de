//! A receiver as a view sees it (algorithm.md §1, §8): mirror of `lib/depth.glsl`, in f32 and operation by
//! operation, because statuses, cells and contours are decided on these very values.

use glam::{Vec2, Vec3};

use crate::shared::{BIAS_ROUNDING, BIAS_SLOPE_MAX, Fit, View};

/// Where a receiver falls on a view's map, how deep, and its back-projection to the light:
/// q = (ku · Δt, kv · Δt) / (Δd + b · Δt), with Δt = t − t_p and Δd = d − d_p.
#[derive(Debug, Clone, Copy)]
pub struct Receiver {
    /// [texel] Its projection t_p.
    pub t: Vec2,
    /// Depth near / z.
    pub d: f32,
    /// Depth moved towards the light by the bias: samples with a larger depth occlude.
    pub biased: f32,
    pub ku: Vec2,
    pub kv: Vec2,
    pub b: Vec2,
}

fn to_face(view: &View, world: Vec3) -> Vec3 {
    Vec3::new(
        world.dot(view.right.into()),
        world.dot(view.up.into()),
        world.dot(view.forward.into()),
    )
}

/// Half extents of a view's box: towards −, towards +.
pub(super) fn extents(view: &View) -> (Vec2, Vec2) {
    let [x0, y0, x1, y1] = view.extent;
    (Vec2::new(x0, y0), Vec2::new(x1, y1))
}

fn face_of(in_light: Vec3, reach: f32) -> u32 {
    let side = in_light.truncate().abs();
    if side.x.max(side.y) <= reach * in_light.z {
        return 0;
    }
    let (first, along) = if side.x >= side.y {
        (1, in_light.x)
    } else {
        (3, in_light.y)
    };
    if along > 0.0 { first } else { first + 1 }
}

/// Whether the view has to look at a surface point: it lies in front of the light, belongs to the view's
/// face, and at least a part of the sub-light is in front of it.
///
/// `to_point`: from the sub-light's centre; `normal`: of the visible side.
pub fn in_view(view: &View, to_point: Vec3, normal: Vec3) -> bool {
    let half = Vec2::from(view.half_size);
    let in_plane = |vector: Vec3| {
        Vec2::new(
            vector.dot(view.light_u.into()),
            vector.dot(view.light_v.into()),
        ) * half
            * half
    };
    let height = to_point.dot(view.light_n.into());
    let in_light = (in_plane(to_point) / half).extend(height);
    if height <= 0.0 || face_of(in_light, view.reach) != view.face {
        return false;
    }
    let (lower, upper) = extents(view);
    let along = in_plane(normal);
    let reach = (along * lower).max(along * upper);
    reach.x + reach.y > normal.dot(to_point)
}

/// `oblique`: the map is not parallel to the light.
pub fn project(view: &View, fit: &Fit, oblique: bool, to_point: Vec3, normal: Vec3) -> Receiver {
    let focal = Vec2::from(fit.focal);
    let p = to_face(view, to_point);
    let inverse_z = 1.0 / p.z;
    let mut t = focal * (p.truncate() * inverse_z) + Vec2::from(fit.center);
    if (2.0 * t.x).fract() == 0.0 {
        t.x = f32::from_bits(t.x.to_bits() + 1);
    }
    let d = fit.near * inverse_z;

    let n = to_face(view, normal);
    let slope = n.truncate().abs() * fit.near / (focal * n.dot(p).abs().max(1e-30));
    let slope_bias = ((slope.x + slope.y) * view.bias).min(BIAS_SLOPE_MAX * d);
    let magnitude = to_point.abs() + Vec3::from(view.center).abs();
    let rounding =
        BIAS_ROUNDING * d * (1.0 + (magnitude.x + magnitude.y + magnitude.z) * inverse_z);
    let half = Vec2::from(view.half_size);
    let mut receiver = Receiver {
        t,
        d,
        biased: d + slope_bias + rounding,
        ku: Vec2::new(fit.near / (focal.x * half.x), 0.0),
        kv: Vec2::new(0.0, fit.near / (focal.y * half.y)),
        b: Vec2::ZERO,
    };
    if oblique {
        let g = p * inverse_z;
        let m = to_face(view, view.light_n.into());
        let lu = to_face(view, view.light_u.into());
        let lv = to_face(view, view.light_v.into());
        let mg = m.dot(g);
        let along =
            |axis: Vec3| fit.near * (axis.truncate() - m.truncate() * (axis.dot(g) / mg)) / focal;
        receiver.ku = along(lu);
        receiver.kv = along(lv);
        receiver.b = -d * (m.truncate() / focal) / mg;
    }
    receiver
}
