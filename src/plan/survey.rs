//! What the host can tell about a light before anything is drawn: who can receive its light, who can
//! cast a shadow, and which faces its views need. All tests are conservative: what they leave out
//! cannot matter, whatever the device finds visible.

use glam::{DVec2, DVec3};

use crate::scene::{Cone, Outline, Side, mapped};
use crate::shared::{CORNER_ROUNDING, PLANE_ROUNDING};
use crate::shot::Shot;
use crate::sub_light::Part;

use super::camera::Frustum;
use super::clip::clip;

/// The answer for one light.
#[derive(Debug, Clone, PartialEq)]
pub struct LightCoverage {
    /// A visible surface may lie in front of the light and face it.
    pub receivers: bool,
    /// The box of all such surfaces in the light's frame; without points where there are none.
    pub receiver_bounds: (DVec3, DVec3),
    /// A triangle may stand between the light and such a surface.
    pub casters: bool,
    /// The largest tangents towards +u, −u, +v, −v under which parts of the light see receivers.
    pub tangents: [f64; 4],
    /// Of each part of the light, whether a triangle that may cast stands before it, nearer than the part is wide.
    pub near: Vec<bool>,
    /// A surface stands before the light so closely that it counts as the lamp's own.
    pub touching: bool,
}

impl LightCoverage {
    /// The faces that may have receivers, where the front one holds those within a tangent: 0 = front; 1, 2 = ±u; 3, 4 = ±v.
    pub fn faces(&self, reach: f32) -> Vec<usize> {
        let side = |&side: &usize| self.tangents[side - 1] > f64::from(reach);
        [0].into_iter().chain((1..5).filter(side)).collect()
    }

    /// [sub-light] Parts that an occluder is near to.
    pub fn near_count(&self) -> usize {
        self.near.iter().filter(|near| **near).count()
    }
}

/// Of plane distances, as on the device.
const ROUNDING: f64 = PLANE_ROUNDING as f64;
const OF_CORNERS: f64 = CORNER_ROUNDING as f64;

/// [share of the light's width] Occluders farther from it are near to no sub-light, however large it is: the width of one
/// at the usual split.
const NEAREST: f64 = 0.25;

/// [share of the height up to which a surface is the lamp's own] Lower ones are in its plane.
const IN_PLANE: f64 = 1e-3;

/// A light in its own frame, relative to the camera's eye.
pub struct Placed {
    center: DVec3,
    axes: [DVec3; 3],
    half: DVec2,
    outline: Outline,
    /// See [`Side::parallel`].
    parallel: f64,
    /// [scene units] Height up to which surfaces are the lamp's own.
    pub touch: f64,
}

impl Placed {
    pub fn new(side: &Side, origin: DVec3, touch: f64) -> Self {
        let light = &side.light;
        let (u, v, n) = light.frame();
        Self {
            center: light.center - origin,
            touch,
            axes: [u, v, n],
            half: light.half_size().into(),
            outline: light.outline(),
            parallel: side.parallel,
        }
    }

    pub fn to_light(&self, point: DVec3) -> DVec3 {
        let way = point - self.center;
        let way = match self.parallel {
            0.0 => way,
            length => mapped(way, self.axes[2], length),
        };
        DVec3::from(self.axes.map(|axis| axis.dot(way)))
    }

    /// The way from a point to the light's centre, in the unit of its half sizes.
    fn way_from(&self, point: DVec3) -> DVec3 {
        match self.parallel {
            0.0 => self.center - point,
            length => -self.axes[2] * length,
        }
    }

    /// Whether a triangle in the light's frame is before the light, within what counts as in its plane.
    fn is_touched(&self, corners: &[DVec3; 3]) -> bool {
        let upper = corners[0].max(corners[1]).max(corners[2]);
        let lower = corners[0].min(corners[1]).min(corners[2]);
        let beside = upper.truncate().cmplt(-self.half) | lower.truncate().cmpgt(self.half);
        upper.z <= self.touch && lower.z > IN_PLANE * self.touch && !beside.any()
    }

    /// How far the light reaches from its centre along a direction in its own frame.
    fn reach(&self, direction: DVec3) -> f64 {
        self.outline.reach(direction.truncate() * self.half)
    }
}

/// `side`: of the light; `parts`: of it; `touch`: see [`Shot::touch`].
pub fn survey(
    shot: &Shot,
    frustum: &Frustum,
    side: &Side,
    parts: &[Part],
    touch: f64,
) -> LightCoverage {
    let (scene, origin) = (&*shot.scene, shot.origin());
    let placed = Placed::new(side, origin, touch);
    let cone = side.cone.map(|cone| Cone::new(cone as usize));
    let mut found = LightCoverage {
        receivers: false,
        receiver_bounds: (DVec3::INFINITY, DVec3::NEG_INFINITY),
        casters: false,
        tangents: [0.0; 4],
        near: Vec::new(),
        touching: false,
    };
    if let (Some(beam), Some(cone)) = (&side.light.beam, &cone)
        && !beam.may_meet(cone)
    {
        return found;
    }
    let planes = cone.map(|cone| cone.distances());
    let (mut lower, mut upper) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for index in 0..scene.triangles.len() {
        let corners = scene.corners_around(origin, index);
        let mut polygon = frustum.clip(corners);
        let double_sided = scene.material_of(index).double_sided;
        if polygon.is_empty() || !may_face(&placed, corners, double_sided) {
            continue;
        }
        // Inside a sphere nothing is shadowed; what is in it with its corners is in it altogether.
        let outside = |point: &DVec3| point.distance(placed.center) > placed.half.x;
        if planes.is_some() && !polygon.iter().any(outside) {
            polygon.clear();
        }
        for plane in planes.iter().flatten() {
            clip(&mut polygon, |point| plane.dot(point - placed.center));
        }
        polygon
            .iter_mut()
            .for_each(|point| *point = placed.to_light(*point));
        clip(&mut polygon, |point| point.z);
        for &point in &polygon {
            found.receivers = true;
            (lower, upper) = (lower.min(point), upper.max(point));
            widen(&mut found.tangents, point, placed.half);
        }
    }
    found.receiver_bounds = (lower, upper);
    if !found.receivers {
        return found;
    }
    let mut near = Near::new(&placed, parts);
    for index in 0..scene.triangles.len() {
        let corners = scene.corners_around(origin, index);
        if !scene.casts(index) {
            continue;
        }
        let corners = corners.map(|corner| placed.to_light(corner));
        found.touching |= placed.is_touched(&corners);
        if (found.casters && near.is_out_of(&corners)) || !may_cast(&placed, corners, lower, upper)
        {
            continue;
        }
        found.casters = true;
        near.mark(&corners);
    }
    found.near = near.found;
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
        || visible.dot(light.way_from(corners[0])) + light.reach(in_light)
            > -ROUNDING * normal.length() * magnitude
}

fn widen(tangents: &mut [f64; 4], point: DVec3, half: DVec2) {
    // Seen from whichever sub-light: their centres lie within the light's half sizes.
    let sides = [point.x, -point.x, point.y, -point.y];
    let halves = [half.x, half.x, half.y, half.y];
    for side in 0..4 {
        let way = sides[side] + halves[side];
        if way > 0.0 {
            tangents[side] = tangents[side].max(way / point.z);
        }
    }
}

/// Looks for occluders that stand before parts of a light, nearer than these are wide.
struct Near {
    /// [scene units] The parts' cells in the light's plane.
    cells: Vec<(DVec2, DVec2)>,
    /// [scene units] Between which heights over the light's plane a triangle is near.
    heights: (f64, f64),
    found: Vec<bool>,
}

impl Near {
    fn new(light: &Placed, parts: &[Part]) -> Self {
        let cell = |part: &Part| {
            let (lower, upper) = part.cell();
            (lower * light.half, upper * light.half)
        };
        let cells: Vec<_> = parts.iter().map(cell).collect();
        let widths = cells
            .iter()
            .map(|(lower, upper)| (upper - lower).max_element());
        let width = widths.fold(0.0, f64::max);
        // Who asks for few sub-lights has asked for few views as well: farther occluders do not bring him many.
        let nearest = NEAREST * 2.0 * light.half.max_element();
        Self {
            heights: (light.touch, width.min(nearest)),
            found: vec![false; cells.len()],
            cells,
        }
    }

    /// Whether a triangle in the light's frame is not near to any part.
    fn is_out_of(&self, corners: &[DVec3; 3]) -> bool {
        let (lowest, highest) = self.heights;
        corners.iter().all(|corner| corner.z <= lowest)
            || corners.iter().all(|corner| corner.z >= highest)
    }

    fn mark(&mut self, corners: &[DVec3; 3]) {
        if self.is_out_of(corners) {
            return;
        }
        let (lowest, highest) = self.heights;
        let mut slab = corners.to_vec();
        clip(&mut slab, |point| point.z - lowest);
        clip(&mut slab, |point| highest - point.z);
        for (&(lower, upper), found) in self.cells.iter().zip(&mut self.found) {
            if *found {
                continue;
            }
            let mut before = slab.clone();
            for axis in 0..2 {
                clip(&mut before, |point| point[axis] - lower[axis]);
                clip(&mut before, |point| upper[axis] - point[axis]);
            }
            *found = !before.is_empty();
        }
    }
}

/// `corners`, `lower` and `upper` (the receivers' box) in the light's frame.
pub fn may_cast(light: &Placed, corners: [DVec3; 3], lower: DVec3, upper: DVec3) -> bool {
    if corners.iter().all(|corner| corner.z <= light.touch)
        || corners.iter().all(|corner| corner.z >= upper.z)
    {
        return false;
    }
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let rounding = ROUNDING * normal.length();
    let of_corner = corners[0].abs().element_sum() * normal.length();
    let of_center = rounding * light.center.abs().element_sum();
    let reaches = |normal: DVec3| {
        let plane = normal.dot(corners[0]);
        light.reach(normal) > plane + OF_CORNERS * of_corner
            || farthest_along(lower, upper, normal, rounding)
                > plane + ROUNDING * of_corner + of_center
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
