//! Whether the shares of micropatches are too small for the format that they add up in [Atty06 app. A].

use glam::{DVec2, DVec3};

use super::clip::clip;
use super::survey::{LightCoverage, Placed, may_cast};
use crate::shot::Shot;
use crate::technique::{Accumulate, Settings};

/// [bit] Of the fraction of a sum: a share less than 2^−bits of it is lost.
pub(super) const fn fraction_bits(accumulate: Accumulate) -> i32 {
    match accumulate {
        Accumulate::Fp32 => 23,
        Accumulate::Fp16 => 10,
    }
}

/// What casts shadows, as far as it stands between the light's plane and the farthest receiver.
pub(super) struct Occluders {
    /// [scene units] Distance of the nearest from the light's plane.
    pub nearest: f64,
    /// [scene units] Distance of the farthest receiver.
    pub receiver: f64,
    /// Tangents between which the light's centre sees them.
    lower: DVec2,
    upper: DVec2,
}

impl Occluders {
    /// None: nothing casts. `found`: on the side of the light that is looked at.
    pub fn new(shot: &Shot, light: &Placed, found: &LightCoverage) -> Option<Self> {
        let (lower, upper) = found.receiver_bounds;
        let mut occluders = Self {
            nearest: f64::INFINITY,
            receiver: upper.z,
            lower: DVec2::INFINITY,
            upper: DVec2::NEG_INFINITY,
        };
        for index in (0..shot.scene.triangles.len()).filter(|&index| shot.scene.casts(index)) {
            let corners = shot.scene.corners_around(shot.origin(), index);
            let corners = corners.map(|corner| light.to_light(corner));
            if may_cast(light, corners, lower, upper) {
                let mut part = corners.to_vec();
                clip(&mut part, |point| point.z - light.touch);
                clip(&mut part, |point| upper.z - point.z);
                part.iter().for_each(|&point| occluders.include(point));
            }
        }
        occluders.nearest.is_finite().then_some(occluders)
    }

    fn include(&mut self, point: DVec3) {
        let tangent = point.truncate() / point.z;
        self.nearest = self.nearest.min(point.z);
        self.lower = self.lower.min(tangent);
        self.upper = self.upper.max(tangent);
    }

    /// [scene units] How near to the light an occluder may be whose texels hide no less of it than its sums can tell
    /// [Atty06 eq. 4], from the geometric mean of both axes. `size`: of a sub-light.
    pub fn least_distance(&self, settings: &Settings, size: DVec2) -> f64 {
        // The width of a texel, and the share of the light's width that it must hide: 1/32 with 10 bits.
        let texel = (self.upper - self.lower) / f64::from(settings.map);
        let share = 0.5_f64.powf(0.5 * f64::from(fraction_bits(settings.accumulate)));
        let width = (texel.x * texel.y / (size.x * size.y)).sqrt();
        1.0 / (1.0 / self.receiver + width / share)
    }
}
