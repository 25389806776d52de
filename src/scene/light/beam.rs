//! The cone that a light's shine is kept in.

use glam::DVec3;

use super::{Cone, is_sane};

/// What keeps a light's shine in a cone around a direction, seen from the light's centre [KHR_lights_punctual, inner and outer cone
/// angles]: all of it within the inner angle, nothing beyond the outer one, and between them as the square of what the cosine has
/// left. Of discs, spheres and points. Shadows do not depend on it, but beyond the outer angle there is no light: visibility 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beam {
    /// Of any length but 0.
    pub direction: DVec3,
    /// [degree] From the direction; 0 ≤ inner ≤ outer ≤ 180, and outer is not 0.
    pub inner_deg: f64,
    pub outer_deg: f64,
}

/// [cosine] Least width of the border, so that it has a slope.
const NARROWEST: f64 = 1e-3;

/// [cosine] What a view may look at beyond the outer angle, so that nothing within is left out by rounding.
const SLACK: f64 = 1e-5;

impl Beam {
    pub(super) fn fault(&self) -> Option<&'static str> {
        if !is_sane(self.direction) || self.direction.try_normalize().is_none() {
            Some("the direction of its cone is not finite, beyond 1e18, or has no length")
        } else if !(0.0 <= self.inner_deg
            && self.inner_deg <= self.outer_deg
            && self.outer_deg > 0.0
            && self.outer_deg <= 180.0)
        {
            Some(
                "the angles of its cone must be 0 ≤ inner ≤ outer ≤ 180 degrees, and outer more than 0",
            )
        } else {
            None
        }
    }

    pub fn axis(&self) -> DVec3 {
        self.direction.normalize_or_zero()
    }

    fn outer_cosine(&self) -> f64 {
        self.outer_deg.to_radians().cos()
    }

    /// The cosine up to which all of the shine is there, and how fast its square root ends there, per cosine.
    pub fn border(&self) -> (f64, f64) {
        let outer = self.outer_cosine();
        let width = (self.inner_deg.to_radians().cos() - outer).max(NARROWEST);
        (outer + width, width.recip())
    }

    /// The least cosine of ways that a view looks at.
    pub fn least_cosine(&self) -> f64 {
        self.outer_cosine() - SLACK
    }

    /// [0, 1] The share of the shine that goes along a way from the light's centre.
    pub fn share(&self, way: DVec3) -> f64 {
        let (start, slope) = self.border();
        let cosine = self.axis().dot(way.normalize_or_zero());
        (1.0 - (start - cosine) * slope).clamp(0.0, 1.0).powi(2)
    }

    /// Whether some way in a cone of receivers may have a share.
    pub fn may_meet(&self, cone: &Cone) -> bool {
        let between = self.axis().dot(cone.middle()).clamp(-1.0, 1.0).acos();
        between <= self.outer_deg.to_radians() + cone.half_angle() + SLACK
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn beam(inner_deg: f64, outer_deg: f64) -> Beam {
        Beam {
            direction: DVec3::NEG_Y * 3.0,
            inner_deg,
            outer_deg,
        }
    }

    fn at(degrees: f64) -> DVec3 {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        DVec3::new(sine, -cosine, 0.0) * 7.0
    }

    #[test]
    fn shine_ends_between_the_angles() {
        let share = |degrees| beam(20.0, 40.0).share(at(degrees));
        assert_eq!([share(0.0), share(19.9)], [1.0; 2]);
        assert_eq!([share(40.1), share(120.0), share(180.0)], [0.0; 3]);
        let middle = (20f64.to_radians().cos() + 40f64.to_radians().cos()) / 2.0;
        let halfway = middle.acos().to_degrees();
        assert!((share(halfway) - 0.25).abs() < 1e-12);
        // Without a border there is a steep one, outside of which there is nothing.
        assert_eq!(beam(30.0, 30.0).share(at(30.01)), 0.0);
        assert_eq!(beam(30.0, 30.0).share(at(29.0)), 1.0);
        assert_eq!(beam(0.0, 180.0).share(at(180.0)), 0.0);
    }

    #[test]
    fn no_cone_with_a_share_is_left_out() {
        for outer in [1.0, 10.0, 35.0, 90.0, 179.0] {
            let beam = beam(0.0, outer);
            let mut met = 0;
            for index in 0..Cone::COUNT {
                let cone = Cone::new(index);
                let planes = cone.distances();
                met += usize::from(beam.may_meet(&cone));
                for step in 0..40_000u32 {
                    // Fibonacci's points on a sphere.
                    let y = 1.0 - 2.0 * (f64::from(step) + 0.5) / 40_000.0;
                    let angle = f64::from(step) * 2.399_963_229_728_653;
                    let way = DVec3::new(angle.cos(), 0.0, angle.sin()) * (1.0 - y * y).sqrt()
                        + DVec3::Y * y;
                    let inside = planes.iter().all(|plane| plane.dot(way) >= 0.0);
                    let forward = way.dot(cone.middle()) > 0.0;
                    if inside && forward && beam.share(way) > 0.0 {
                        assert!(beam.may_meet(&cone), "{outer}, cone {index}");
                    }
                }
            }
            assert!(
                met >= 4 && (outer > 90.0 || met < Cone::COUNT),
                "{outer}: {met}"
            );
        }
    }
}
