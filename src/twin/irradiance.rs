//! Unshadowed irradiance: twin of `lib/irradiance.glsl`, in f32 and operation by operation.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::beam;
use super::facing::Facing;
use super::outline::corners_of;
use super::polygon_irradiance::{self, SHORTEST, arc_polynomial};
use crate::shared::{IRRADIANCE_NODES, Light, SPREAD_POINT};

/// A light as a receiver in front of its plane sees it, in a frame of the plane whose origin is the foot of the receiver's
/// perpendicular; lengths are divided by a scale that makes them at most 1.
struct SeenLight {
    disc: bool,
    half_size: Vec2,
    center: Vec2,
    /// From the receiver to the plane.
    distance: f32,
    /// The normal's components along x, y and towards the plane; 0 ≤ x and, but for discs, x ≤ y.
    slope: Vec3,
}

/// [1 / scene units²] Irradiance at a point by a light whose radiance times area is 1.
///
/// Relative error: below 1e-3 where the shader states it. Finite everywhere. `corners`: of all polygons.
pub fn irradiance(light: &Light, corners: &[[f32; 2]], position: Vec3, normal: Vec3) -> f32 {
    beam::share(light, position) * irradiance_everywhere(light, corners, position, normal)
}

fn irradiance_everywhere(light: &Light, corners: &[[f32; 2]], position: Vec3, normal: Vec3) -> f32 {
    let facing = Facing::new(light, position, normal);
    let (light, way) = (&facing.light, facing.way);
    if light.spread == SPREAD_POINT {
        let square = way.length_squared().max(1e-36);
        return way.dot(normal).max(0.0) / (square * square.sqrt());
    }
    let scale = way.abs().max_element() + light.half_size[0] + light.half_size[1];
    let inverse_scale = 1.0 / scale.max(1e-18);
    let corners = corners_of(light, corners);
    if !corners.is_empty() {
        let scaled = Light {
            half_size: light.half_size.map(|half| half * inverse_scale),
            ..*light
        };
        let found = polygon_irradiance::irradiance(&scaled, corners, way * inverse_scale, normal);
        return (found * inverse_scale * inverse_scale).min(1e38);
    }
    let mut seen = SeenLight::new(light, way, normal, inverse_scale);
    if seen.distance > 0.0 {
        seen.distance = seen.distance.max(SHORTEST);
        let area = light.area * seen.half_size.x * seen.half_size.y;
        (seen.irradiance() / area * inverse_scale * inverse_scale * facing.area).min(1e38)
    } else {
        0.0
    }
}

fn direction_of(v: Vec2) -> Vec2 {
    let square = v.length_squared();
    if square > 0.0 {
        v * (1.0 / square.sqrt())
    } else {
        Vec2::ZERO
    }
}

/// The direction of y, in the light's own u and v.
fn axis_of(disc: bool, center: Vec2, slope: Vec2) -> Vec2 {
    if !disc {
        return if slope.x.abs() > slope.y.abs() {
            Vec2::X
        } else {
            Vec2::Y
        };
    }
    let up = direction_of(slope);
    let outward = direction_of(center);
    let same_sense = if up.dot(outward) < 0.0 {
        -outward
    } else {
        outward
    };
    match direction_of(up + same_sense) {
        Vec2::ZERO => Vec2::Y,
        axis => axis,
    }
}

/// θ − sin θ for θ in [0, π], t = tan(θ/2).
fn arc_excess(t: f32) -> f32 {
    let obtuse = t > 1.0;
    let s = if obtuse { 1.0 / t } else { t };
    let z = s * s;
    let q = arc_polynomial(z);
    let c = 1.0 / (1.0 + z);
    if obtuse {
        PI - 2.0 * s * (1.0 - z * q + c)
    } else {
        2.0 * s * z * (c - q)
    }
}

/// (1 + g, 1 − g) with g = tan(θ/2) of the angle θ in which x is seen from `away`.
fn half_tangents(x: f32, away: f32) -> Vec2 {
    let sum = (away * away + x * x).sqrt() + away;
    let larger = 1.0 + x.abs() / sum;
    let smaller = 2.0 * away / (sum * larger);
    if x < 0.0 {
        Vec2::new(smaller, larger)
    } else {
        Vec2::new(larger, smaller)
    }
}

impl SeenLight {
    fn new(light: &Light, to_center: Vec3, normal: Vec3, inverse_scale: f32) -> Self {
        let disc = light.round != 0;
        let way = to_center * inverse_scale;
        let axes = [Vec3::from(light.u), Vec3::from(light.v)];
        let in_plane = |vector: Vec3| Vec2::from(axes.map(|axis| vector.dot(axis)));
        let (center, slope) = (in_plane(way), in_plane(normal));
        let y = axis_of(disc, center, slope);
        let x = Vec2::new(y.y, -y.x);
        let slope = Vec2::new(slope.dot(x), slope.dot(y));
        let sense = Vec2::from(slope.to_array().map(|s| if s < 0.0 { -1.0 } else { 1.0 }));
        let half_size = (Vec2::from(light.half_size) * inverse_scale).max(Vec2::splat(SHORTEST));
        let n = Vec3::from(light.n);
        Self {
            disc,
            half_size: if disc || y.y != 0.0 {
                half_size
            } else {
                Vec2::new(half_size.y, half_size.x)
            },
            center: sense * Vec2::new(center.dot(x), center.dot(y)),
            distance: -way.dot(n),
            slope: slope.abs().extend(-normal.dot(n)),
        }
    }

    /// Irradiance over radiance, [0, π].
    fn irradiance(&self) -> f32 {
        let rise = self.slope.truncate() * self.half_size;
        let height = self.slope.dot(self.center.extend(self.distance));
        let away = self.closest_approach();
        let [first, second] = self.horizon_on_border(height, rise);
        let panels = [
            (-1.0, first, height - rise.x > 0.0),
            (first, second, true),
            (second, 1.0, height + rise.x > 0.0),
        ];
        let sum: f32 = (panels.into_iter())
            .filter(|(from, to, above)| *above && to > from)
            .map(|(from, to, _)| self.by_panel(from, to, away))
            .sum();
        sum.max(0.0)
    }

    /// The least distance from the receiver to points of the light above the horizon, or less.
    fn closest_approach(&self) -> f32 {
        let from_center = if self.disc {
            self.center.length()
        } else {
            self.center.y.abs()
        };
        let beside = from_center - self.half_size.y;
        let away = Vec2::new(self.distance, beside.max(0.0)).length();
        let horizon = self.distance / self.slope.truncate().length().max(1e-6);
        if self.slope.z < 0.0 {
            away.max(horizon)
        } else {
            away
        }
    }

    /// [half sizes] Where the horizon meets the light's border; both −1 if it passes below.
    fn horizon_on_border(&self, height: f32, rise: Vec2) -> [f32; 2] {
        let clamped = |s: f32| s.clamp(-1.0, 1.0);
        if !self.disc {
            return [-height - rise.y, rise.y - height].map(|s| clamped(s / rise.x.max(1e-30)));
        }
        let steepest = rise.length().max(1e-30);
        let from_center = clamped(-height / steepest);
        let half_chord = ((1.0 - from_center) * (1.0 + from_center)).sqrt();
        if from_center > -1.0 {
            [-half_chord, half_chord]
                .map(|along| clamped((from_center * rise.x + along * rise.y) / steepest))
        } else {
            [-1.0; 2]
        }
    }

    /// What the lines from s = `from` to `to` add.
    fn by_panel(&self, from: f32, to: f32, away: f32) -> f32 {
        let first = half_tangents(self.center.x + from * self.half_size.x, away);
        let last = half_tangents(self.center.x + to * self.half_size.x, away);
        let pole = away / first;
        let extent = self.half_size.x * (to - from) / pole.dot(1.0 / last);
        let nodes = IRRADIANCE_NODES
            .into_iter()
            .flat_map(|[node, weight]| [(-node, weight), (node, weight)]);
        let sum: f32 = nodes
            .map(|(node, weight)| {
                let share = 0.5 + 0.5 * node;
                let g = first * (1.0 - share) + last * share;
                let inverse = 1.0 / (g.x * g.y);
                let x = away * (g.x - g.y) * inverse;
                let s = from
                    + extent * share * pole.dot(Vec2::new(g.y, g.x)) * inverse / self.half_size.x;
                let stretch = away * g.length_squared() * inverse * inverse;
                weight * stretch * self.by_line(x, s)
            })
            .sum();
        0.5 * extent * sum
    }

    /// Irradiance by the line at x, which is s half sizes from the light's centre, per length.
    fn by_line(&self, x: f32, s: f32) -> f32 {
        let chord = ((1.0 - s) * (1.0 + s)).max(0.0).sqrt();
        let border = if self.disc { chord } else { 1.0 };
        let reach = self.half_size.y * border;
        let level = self.slope.x * x + self.slope.z * self.distance;
        let horizon = -level / self.slope.y.max(1e-9);
        let y0 = (self.center.y - reach).max(horizon);
        let y1 = self.center.y + reach;
        let extent = (2.0 * reach).min(y1 - horizon);
        if extent <= 0.0 {
            return 0.0;
        }
        let square = self.distance * self.distance + x * x;
        let rho = square.sqrt();
        let (r0, r1) = ((square + y0 * y0).sqrt(), (square + y1 * y1).sqrt());
        let cosine = square + y0 * y1;
        let sine = rho * extent;
        let sum = r0 * r1 + cosine.abs();
        let tangent = if cosine < 0.0 { sum / sine } else { sine / sum };
        let height = level + self.slope.y * ((y0 * r1 + y1 * r0) / (r0 + r1));
        let nearness = (r0 + r1) / (r0 * r1);
        let inner =
            level / rho * arc_excess(tangent) + tangent * rho * height * nearness * nearness;
        0.5 * inner * self.distance / square
    }
}
