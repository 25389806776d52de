//! An area light as a set of points.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use glam::{DVec2, DVec3};

use crate::scene::{AreaLight, Ball, Beam, LightShape, Outline, Spread, polygon_area};
use crate::shared::HORIZON_ROUNDING;
use crate::{Error, Result};

/// A light that can be sampled, relative to the eye.
pub struct Emitter {
    center: DVec3,
    spread: Spread,
    /// Half-axis vectors; for a disc two perpendicular radii.
    axes: [DVec3; 2],
    /// The side it shines to; None where the shape has no plane (a point, a line): to all sides.
    normal: Option<DVec3>,
    outline: Outline,
    beam: Option<Beam>,
    /// Around the scene, relative to the eye.
    ball: Ball,
}

impl Emitter {
    /// `ball`: around the scene.
    ///
    /// # Errors
    /// When the light has numbers that are not finite, or a disc with extent no normal.
    pub fn new(light: &AreaLight, ball: Ball, origin: DVec3) -> Result<Self> {
        let (u, v, n) = light.frame();
        let (half_u, half_v) = light.half_size();
        let (axes, normal) = match light.shape {
            LightShape::Rect { u, v } | LightShape::Polygon { u, v, .. } => {
                ([u, v], u.cross(v).try_normalize())
            }
            LightShape::Disc { normal, radius } => {
                let direction = normal.try_normalize();
                if radius > 0.0 && direction.is_none() {
                    return Err(Error::Invalid(format!(
                        "the normal of light “{}” has no direction",
                        light.name
                    )));
                }
                ([u * radius, v * radius], direction)
            }
            LightShape::Sphere { .. } => ([u * half_u, v * half_v], None),
            LightShape::Sun { .. } => ([u * half_u, v * half_v], Some(n)),
        };
        let center = light.center - origin;
        if ![center, axes[0], axes[1]].iter().all(|v| v.is_finite()) {
            let name = &light.name;
            return Err(Error::Invalid(format!(
                "light “{name}” has a number that is not finite"
            )));
        }
        Ok(Self {
            center,
            spread: light.spread(),
            axes,
            normal,
            outline: light.outline(),
            beam: light.beam,
            ball: Ball {
                center: ball.center - origin,
                ..ball
            },
        })
    }

    /// Whether it shines to a point: its beam, if it has one, holds it.
    pub fn shines_to(&self, point: DVec3) -> bool {
        self.beam
            .is_none_or(|beam| beam.share(point - self.center) > 0.0)
    }

    /// The flat light that a point sees of it; None inside a sphere, where all of it is seen.
    pub fn seen_from(&self, point: DVec3) -> Option<Self> {
        match self.spread {
            Spread::Plane | Spread::Point => Some(Self { ..*self }),
            Spread::Sun => {
                // Beyond everything that may stand before it.
                let away = point.distance(self.ball.center) + self.ball.radius;
                let normal = self.normal?;
                Some(Self {
                    center: point - normal * (2.0 * away),
                    axes: self.axes.map(|axis| axis * (2.0 * away)),
                    ..*self
                })
            }
            Spread::Sphere => {
                let (toward, distance) = (point - self.center).normalize_and_length();
                let radius = self.axes[0].length();
                let seen = (distance * distance - radius * radius).sqrt();
                let (u, v) = toward.any_orthonormal_pair();
                (distance > radius).then(|| Self {
                    axes: [u, v].map(|axis| axis * (radius * distance / seen)),
                    normal: Some(toward),
                    ..*self
                })
            }
        }
    }

    /// Whether it has no extent, so that all samples are the same.
    pub fn is_point(&self) -> bool {
        self.axes == [DVec3::ZERO; 2]
    }

    /// The point at (a, b) ∈ [0, 1)², equal areas to equal areas; a disc by the concentric map
    /// [Shirley and Chiu 1997], which keeps neighbours together.
    pub fn point(&self, a: f64, b: f64) -> DVec3 {
        let (s, t) = (2.0 * a - 1.0, 2.0 * b - 1.0);
        let (s, t) = match &self.outline {
            Outline::Square => (s, t),
            Outline::Disc => concentric(s, t),
            Outline::Polygon(corners) => corners.place(DVec2::new(a, b)).into(),
        };
        self.center + self.axes[0] * s + self.axes[1] * t
    }

    /// The share of the way from `start` to a point of the light that ends `height` \[scene units\] over the light's plane,
    /// or as near to a light that has none.
    pub fn share_before(&self, start: DVec3, on_light: DVec3, height: f64) -> f64 {
        let way = on_light - start;
        let rise = match self.normal {
            Some(shines) => shines.dot(way).abs(),
            None => way.length(),
        };
        1.0 - height / rise
    }

    /// [0, 1] The share of the light's area that is in front of the plane through `point` with
    /// `normal`; 0 where `point` is not on the side that the light shines to. Heights up to what rounding makes of them on
    /// the device ([`HORIZON_ROUNDING`]) count as none, for both.
    pub fn share_in_front(&self, point: DVec3, normal: DVec3) -> f64 {
        let to_center = self.center - point;
        let magnitude = (to_center.abs() + self.center.abs()).element_sum();
        let rounding = f64::from(HORIZON_ROUNDING) * magnitude;
        let height = normal.dot(to_center);
        let rise = DVec2::from(self.axes.map(|axis| normal.dot(axis)));
        let reach = self.outline.reach(rise);
        let in_front_of_light =
            (self.normal).is_none_or(|shines| -shines.dot(to_center) > rounding);
        if !in_front_of_light || height + reach <= rounding {
            return 0.0;
        }
        match &self.outline {
            Outline::Disc => disc_share(height, reach),
            Outline::Square => polygon_share(&SQUARE, height, rise),
            Outline::Polygon(corners) => polygon_share(corners, height, rise),
        }
    }
}

fn concentric(s: f64, t: f64) -> (f64, f64) {
    if s == 0.0 && t == 0.0 {
        return (0.0, 0.0);
    }
    let (radius, angle) = if s.abs() > t.abs() {
        (s, FRAC_PI_4 * (t / s))
    } else {
        (t, FRAC_PI_2 - FRAC_PI_4 * (s / t))
    };
    (radius * angle.cos(), radius * angle.sin())
}

/// The share of the unit disc on which height + reach · x > 0.
fn disc_share(height: f64, reach: f64) -> f64 {
    if height >= reach {
        return if height > 0.0 { 1.0 } else { 0.0 };
    }
    if height <= -reach {
        return 0.0;
    }
    let x = height / reach;
    1.0 - (x.acos() - x * (1.0 - x * x).sqrt()) / PI
}

const SQUARE: [DVec2; 4] = [
    DVec2::NEG_ONE,
    DVec2::new(1.0, -1.0),
    DVec2::ONE,
    DVec2::new(-1.0, 1.0),
];

/// The share of a polygon on which height + rise · x > 0: the polygon clipped by the line.
fn polygon_share(corners: &[DVec2], height: f64, rise: DVec2) -> f64 {
    let above = |corner: DVec2| height + rise.dot(corner);
    if corners.iter().all(|&corner| above(corner) > 0.0) {
        return 1.0;
    }
    let mut clipped: Vec<DVec2> = Vec::with_capacity(corners.len() + 1);
    for (&from, &to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let (h0, h1) = (above(from), above(to));
        if h0 > 0.0 {
            clipped.push(from);
        }
        if (h0 > 0.0) != (h1 > 0.0) {
            clipped.push(from + (to - from) * (h0 / (h0 - h1)));
        }
    }
    (polygon_area(&clipped) / polygon_area(corners)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const BALL: Ball = Ball {
        center: DVec3::ZERO,
        radius: 1.0,
    };

    #[test]
    fn shares_by_hand() {
        let square_share = |height, rise: [f64; 2]| polygon_share(&SQUARE, height, rise.into());
        assert_eq!(square_share(1.0, [0.0, 0.0]), 1.0);
        assert_eq!(square_share(-1.0, [0.0, 0.0]), 0.0);
        assert_eq!(square_share(0.0, [0.0, 0.0]), 0.0);
        assert_eq!(square_share(0.0, [1.0, 0.0]), 0.5);
        assert_eq!(square_share(0.0, [-2.0, 2.0]), 0.5);
        assert_eq!(square_share(0.5, [1.0, 0.0]), 0.75);
        // All but a corner triangle with legs of 1.
        assert_eq!(square_share(1.0, [1.0, 1.0]), 0.875);
        let triangle = [DVec2::NEG_ONE, DVec2::X, DVec2::Y];
        assert_eq!(polygon_share(&triangle, 1.0, DVec2::new(0.5, 0.0)), 1.0);
        // Cut in halves through a corner.
        assert!((polygon_share(&triangle, 0.0, DVec2::new(1.0, -1.0)) - 0.5).abs() < 1e-15);
        assert_eq!(disc_share(0.0, 0.0), 0.0);
        assert_eq!(disc_share(2.0, 1.0), 1.0);
        assert_eq!(disc_share(-2.0, 1.0), 0.0);
        assert!((disc_share(0.0, 3.0) - 0.5).abs() < 1e-15);
        // A segment at half the radius: 1/3 − √3 / 4π of the disc is cut away.
        assert!((disc_share(0.5, 1.0) - (2.0 / 3.0 + 3f64.sqrt() / (4.0 * PI))).abs() < 1e-15);
    }

    #[test]
    fn a_point_without_normal_shines_to_all_sides() {
        let point = |normal, radius| AreaLight {
            name: String::new(),
            center: DVec3::ZERO,
            shape: LightShape::Disc { normal, radius },
            color: glam::Vec3::ONE,
            intensity: None,
            beam: None,
        };
        let sides = |normal| {
            let emitter = Emitter::new(&point(normal, 0.0), BALL, DVec3::ZERO).expect("a light");
            [DVec3::Y, DVec3::NEG_Y].map(|place| emitter.share_in_front(place, -place))
        };
        assert_eq!(sides(DVec3::ZERO), [1.0, 1.0]);
        assert_eq!(sides(DVec3::NEG_Y), [0.0, 1.0]);
        assert!(Emitter::new(&point(DVec3::ZERO, 1.0), BALL, DVec3::ZERO).is_err());
    }

    #[test]
    fn the_concentric_map_keeps_areas() {
        // A grid over the square: the share of points within radius r must be r².
        let side = 400;
        let grid = |i: usize| 2.0 * (i as f64 + 0.5) / side as f64 - 1.0;
        let radii: Vec<f64> = (0..side * side)
            .map(|i| concentric(grid(i % side), grid(i / side)))
            .map(|(x, y)| x.hypot(y))
            .collect();
        for r in [0.25, 0.5, 0.75, 1.0] {
            let inside = radii.iter().filter(|&&radius| radius <= r).count() as f64;
            assert!((inside / (side * side) as f64 - r * r).abs() < 0.005, "{r}");
        }
    }
}
