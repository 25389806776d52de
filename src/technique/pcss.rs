//! Percentage-closer soft shadows [Fernando05], what games ship: a search for blockers around the pixel's projection,
//! whose mean depth tells how wide to filter the hard shadow.
//!
//! Right: contact hardening, at a cost that depends on two sample counts only. Wrong: the penumbra of an occluder
//! parallel to the light is right, any other is a guess; blockers of different depths are averaged into one that is
//! nowhere; blockers that the search misses leave holes; few samples are noise.

use super::{Method, Recipe, Settings};

pub struct Pcss;

impl Method for Pcss {
    fn recipe(&self, _settings: &Settings) -> Recipe {
        Recipe::over_samples("pcss_visibility", "pcss_visibility.comp")
    }

    fn knobs(&self, _settings: &Settings) -> Vec<&'static str> {
        vec!["split", "blocker-samples", "filter-samples"]
    }

    /// The search for blockers takes half as many samples as the filter.
    fn follow(&self, field: &str, settings: &mut Settings) {
        if field == "filter_samples" {
            settings.blocker_samples = (settings.filter_samples / 2).max(1);
        }
    }

    /// A filter of many texels: where the mean of the error is nothing on most scenes.
    fn bias(&self, _settings: &Settings) -> f32 {
        6.0
    }
}
