//! What the host can tell about a light before anything is drawn: who can receive its light, who can
//! cast a shadow, and which faces its views need. All tests are conservative: what they leave out
//! cannot matter, whatever the device finds visible.

use glam::{DVec2, DVec3};

use crate::scene::{AreaLight, LightShape};
use crate::shared::FRONT_REACH;
use crate::shot::Shot;

use super::camera::Frustum;

/// The answer for one light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Survey {
    /// A visible surface may lie in front of the light and face it.
    pub receivers: bool,
    /// A triangle may stand between the light and such a surface.
    pub casters: bool,
    /// Which faces may have receivers: front, ±u, ±v.
    pub faces: [bool; 5],
}

/// Rounding of plane distances, relative to the coordinates' magnitude, as in `casters.comp`.
const ROUNDING: f64 = 2e-6;

/// A light in its own frame, relative to the camera's eye.
struct Placed {
    center: DVec3,
    axes: [DVec3; 3],
    half: DVec2,
    round: bool,
}

impl Placed {
    fn new(light: &AreaLight, origin: DVec3) -> Self {
        let (u, v, n) = light.frame();
        Self {
            center: light.center - origin,
            axes: [u, v, n],
            half: light.half_size().into(),
            round: matches!(light.shape, LightShape::Disc { .. }),
        }
    }

    fn to_light(&self, point: DVec3) -> DVec3 {
        let way = point - self.center;
        DVec3::from(self.axes.map(|axis| axis.dot(way)))
    }

    /// How far the light reaches from its centre along a direction in its own frame.
    fn reach(&self, direction: DVec3) -> f64 {
        let along = direction.truncate().abs() * self.half;
        if self.round {
            along.length()
        } else {
            along.x + along.y
        }
    }
}

pub fn survey(shot: &Shot, frustum: &Frustum, light: &AreaLight) -> Survey {
    let (scene, origin) = (&*shot.scene, shot.origin());
    let placed = Placed::new(light, origin);
    let mut found = Survey {
        receivers: false,
        casters: false,
        faces: [false; 5],
    };
    let (mut lower, mut upper) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for index in 0..scene.triangles.len() {
        let corners = scene.corners(index).map(|corner| corner - origin);
        let mut polygon = frustum.clip(corners);
        let double_sided = scene.material_of(index).double_sided;
        if polygon.is_empty() || !may_face(&placed, corners, double_sided) {
            continue;
        }
        polygon
            .iter_mut()
            .for_each(|point| *point = placed.to_light(*point));
        clip(&mut polygon, |point| point.z);
        for &point in &polygon {
            found.receivers = true;
            (lower, upper) = (lower.min(point), upper.max(point));
            mark_faces(&mut found.faces, point, placed.half);
        }
    }
    found.casters = found.receivers
        && (0..scene.triangles.len()).any(|index| {
            let corners = scene
                .corners(index)
                .map(|corner| placed.to_light(corner - origin));
            may_cast(&placed, corners, lower, upper)
        });
    found
}

/// Whether the camera, at the origin, sees a side of the triangle that any part of the light is in front of.
fn may_face(light: &Placed, corners: [DVec3; 3], double_sided: bool) -> bool {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let to_eye = -normal.dot(corners[0]);
    let visible = if to_eye < 0.0 { -normal } else { normal };
    let in_light = DVec3::from(light.axes.map(|axis| axis.dot(visible)));
    let magnitude = (corners[0].abs() + light.center.abs()).element_sum();
    // Seen edge-on, either side may be the visible one.
    let edge_on = to_eye.abs() <= ROUNDING * normal.length() * magnitude;
    if to_eye < 0.0 && !edge_on && !double_sided {
        return false;
    }
    edge_on
        || visible.dot(light.center - corners[0]) + light.reach(in_light)
            > -ROUNDING * normal.length() * magnitude
}

fn mark_faces(faces: &mut [bool; 5], point: DVec3, half: DVec2) {
    // Seen from whichever sub-light: their centres lie within the light's half sizes.
    let reach = f64::from(FRONT_REACH) * point.z;
    let sides = [point.x, -point.x, point.y, -point.y];
    let halves = [half.x, half.x, half.y, half.y];
    faces[0] = true;
    for side in 0..4 {
        faces[side + 1] |= sides[side] + halves[side] > reach;
    }
}

/// `corners`, `lower` and `upper` (the receivers' box) in the light's frame.
fn may_cast(light: &Placed, corners: [DVec3; 3], lower: DVec3, upper: DVec3) -> bool {
    if corners.iter().all(|corner| corner.z <= 0.0)
        || corners.iter().all(|corner| corner.z >= upper.z)
    {
        return false;
    }
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let rounding = ROUNDING * normal.length();
    let of_corner = rounding * (corners[0].abs() + light.center.abs()).element_sum();
    let reaches = |normal: DVec3| {
        let plane = normal.dot(corners[0]) + of_corner;
        light.reach(normal) > plane || farthest_along(lower, upper, normal, rounding) > plane
    };
    reaches(normal) && reaches(-normal)
}

/// The largest normal · x − rounding · |x|₁ of all points x of a box: how far the box reaches beyond what rounding, which
/// grows with a point's coordinates, can make of it.
fn farthest_along(lower: DVec3, upper: DVec3, normal: DVec3, rounding: f64) -> f64 {
    let along = |at: DVec3| normal * at - rounding * at.abs();
    let at_zero = along(DVec3::ZERO.clamp(lower, upper));
    along(lower).max(along(upper)).max(at_zero).element_sum()
}

/// Keeps the part of a convex polygon where `distance` ≥ 0 (Sutherland and Hodgman).
pub fn clip(polygon: &mut Vec<DVec3>, distance: impl Fn(DVec3) -> f64) {
    let Some(&last) = polygon.last() else { return };
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    let (mut previous, mut before) = (last, distance(last));
    for &current in polygon.iter() {
        let after = distance(current);
        if (before < 0.0) != (after < 0.0) {
            kept.push(previous.lerp(current, before / (before - after)));
        }
        if after >= 0.0 {
            kept.push(current);
        }
        (previous, before) = (current, after);
    }
    *polygon = kept;
}
