//! The mean of many hard shadow maps from points all over the light: the papers' own reference ([Yang09] fig. 11,
//! [Schwarz08] fig. 10 use 1024).
//!
//! Right: converges to the truth with the number of maps, but for what a map's texels and the bias leave out. Wrong:
//! visibility has as many steps as there are maps.

use std::f64::consts::PI;

use glam::DVec2;

use super::{Method, Recipe, Settings, hard, with};
use crate::scene::{AreaLight, Outline};
use crate::sub_light::Part;

pub struct ReferenceMaps;

impl Method for ReferenceMaps {
    fn recipe(&self, _settings: &Settings) -> Recipe {
        hard::recipe()
    }

    fn knobs(&self, _settings: &Settings) -> Vec<&'static str> {
        vec!["maps"]
    }

    /// The nearest sample is within half a texel.
    fn bias(&self, _settings: &Settings) -> f32 {
        0.5
    }

    fn variants(&self, usual: Settings) -> Vec<Settings> {
        vec![with(&usual, |settings| settings.maps = 256)]
    }

    fn parts(&self, light: &AreaLight, settings: &Settings) -> Vec<Part> {
        points(light, settings.maps)
    }

    fn reach(&self) -> f32 {
        POINT_REACH
    }

    fn samples_points(&self) -> bool {
        true
    }

    fn has_views_of_points(&self) -> bool {
        true
    }
}

/// Tangent up to which the front face of a point's view holds receivers: 76 degrees. Its map is fitted to casters, so that
/// a wide one costs texels only where there are casters to the side.
pub const POINT_REACH: f32 = 4.0;

/// The plastic number: powers of its inverse place the points of Roberts' R2 sequence.
const PLASTIC: f64 = 1.324_717_957_244_746;

/// Points of a low-discrepancy sequence on the light, all of the same weight.
fn points(light: &AreaLight, count: u32) -> Vec<Part> {
    let point = |index: u32| {
        let share = DVec2::new(1.0 / PLASTIC, 1.0 / (PLASTIC * PLASTIC)) * f64::from(index);
        let at = (share + 0.5).fract();
        let at = match light.outline() {
            Outline::Square => 2.0 * at - 1.0,
            Outline::Disc => at.x.sqrt() * DVec2::from_angle(2.0 * PI * at.y),
            Outline::Polygon(corners) => corners.place(at),
        };
        Part::point(at)
    };
    (0..count).map(point).collect()
}
