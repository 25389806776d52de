//! Unshadowed irradiance by a polygon: twin of `lib/polygon_irradiance.glsl`, in f32 and operation by operation.

use std::f32::consts::PI;

use glam::{Vec2, Vec3, Vec3Swizzles};

use crate::shared::{ARCTANGENT, Light};

/// [scale] Shorter lengths are taken for it.
pub const SHORTEST: f32 = 1e-9;
/// [share of the distance] Sum of the half sizes up to which a light is small.
const SMALL: f32 = 0.25;

/// Radon's rule of degree 5: the centroid, and the weight and the barycentric coordinate of two orbits of three nodes.
const CENTROID_WEIGHT: f32 = 0.225;
const ORBITS: [[f32; 2]; 2] = [[0.125_939_18, 0.797_427], [0.132_394_15, 0.059_715_87]];

struct SeenPolygon<'a> {
    corners: &'a [[f32; 2]],
    half_size: Vec2,
    center: Vec2,
    distance: f32,
    slope: Vec3,
    height: f32,
}

/// Irradiance by a light in the plane of `light` whose radiance times area is the square of the scale.
pub fn irradiance(light: &Light, corners: &[[f32; 2]], way: Vec3, normal: Vec3) -> f32 {
    let half_size = Vec2::from(light.half_size).max(Vec2::splat(SHORTEST));
    let along = |vector: Vec3| Vec2::new(vector.dot(light.u.into()), vector.dot(light.v.into()));
    let (center, distance) = (along(way), -way.dot(light.n.into()));
    if distance <= 0.0 {
        return 0.0;
    }
    let distance = distance.max(SHORTEST);
    let slope = along(normal).extend(-normal.dot(light.n.into()));
    let seen = SeenPolygon {
        corners,
        half_size,
        center,
        distance,
        slope,
        height: slope.dot(center.extend(distance)),
    };
    let small = half_size.x + half_size.y < SMALL * way.length();
    seen.irradiance(small) / (light.area * half_size.x * half_size.y)
}

/// (s − atan s) / s³ with z = s².
pub fn arc_polynomial(z: f32) -> f32 {
    let terms = ARCTANGENT.into_iter().rev();
    terms.fold(0.0, |sum, coefficient| sum * z + coefficient)
}

/// θ with tan(θ/2) = t, in [0, π].
fn angle_of(t: f32) -> f32 {
    let obtuse = t > 1.0;
    let s = if obtuse { 1.0 / t } else { t };
    let quarter = s / (1.0 + (1.0 + s * s).sqrt());
    let square = quarter * quarter;
    let angle = 4.0 * quarter * (1.0 - square * arc_polynomial(square));
    if obtuse { PI - angle } else { angle }
}

impl SeenPolygon<'_> {
    /// Its offset from the light's centre, and its height over the horizon.
    fn corner(&self, corner: [f32; 2]) -> Vec3 {
        let at = Vec2::from(corner) * self.half_size;
        at.extend(self.height + self.slope.xy().dot(at))
    }

    /// Irradiance over radiance, [0, π].
    fn irradiance(&self, small: bool) -> f32 {
        let corners = self.corners.iter().map(|&corner| self.corner(corner));
        let higher = |first: Vec3, other: Vec3| if other.z > first.z { other } else { first };
        let Some(apex) = corners.clone().reduce(higher).filter(|apex| apex.z > 0.0) else {
            return 0.0;
        };
        let term = |a: Vec3, b: Vec3, on_horizon: bool| match small {
            true => self.by_triangle(apex, a, b),
            false => self.by_side(a.xy(), b.xy(), on_horizon),
        };
        let (mut sum, mut sets, mut rises) = (0.0, apex, apex);
        let sides = corners
            .clone()
            .cycle()
            .skip(self.corners.len() - 1)
            .zip(corners);
        for (from, to) in sides {
            let crossing = || {
                from.xy()
                    .lerp(to.xy(), from.z / (from.z - to.z))
                    .extend(0.0)
            };
            sum += match (from.z > 0.0, to.z > 0.0) {
                (true, true) => term(from, to, false),
                (true, false) => {
                    sets = crossing();
                    term(from, sets, false)
                }
                (false, true) => {
                    rises = crossing();
                    term(rises, to, false)
                }
                (false, false) => 0.0,
            };
        }
        (0.5 * (sum + term(sets, rises, true))).clamp(0.0, PI)
    }

    /// Lambert's term of a side, twice.
    fn by_side(&self, a: Vec2, b: Vec2, on_horizon: bool) -> f32 {
        let side = b - a;
        let (from, to) = (self.center + a, self.center + b);
        let moment = from.perp_dot(side);
        let square = self.distance * self.distance;
        let cross = (square * side.length_squared() + moment * moment).sqrt();
        let product =
            (square + from.length_squared()).sqrt() * (square + to.length_squared()).sqrt();
        let cosine = square + from.dot(to);
        let sum = product + cosine.abs();
        let tangent = match cosine < 0.0 {
            true => sum / cross.max(1e-30),
            false => cross / sum,
        };
        let rise =
            self.slope.z * moment + self.distance * (self.slope.y * side.x - self.slope.x * side.y);
        let along_normal = if on_horizon {
            1.0
        } else {
            rise / cross.max(1e-30)
        };
        angle_of(tangent) * along_normal
    }

    fn by_node(&self, at: Vec3) -> f32 {
        let square = self.distance * self.distance + (self.center + at.xy()).length_squared();
        at.z / (square * square)
    }

    /// Twice the irradiance by a small triangle.
    fn by_triangle(&self, apex: Vec3, a: Vec3, b: Vec3) -> f32 {
        let sum = apex + a + b;
        let mut mean = CENTROID_WEIGHT * self.by_node(sum / 3.0);
        for [weight, own] in ORBITS {
            let other = 0.5 * (1.0 - own);
            let node = |corner: Vec3| self.by_node(other * sum + (own - other) * corner);
            mean += weight * (node(apex) + node(a) + node(b));
        }
        let doubled = (a - apex).xy().perp_dot((b - apex).xy());
        doubled.max(0.0) * mean * self.distance
    }
}
