//! Percentage-closer soft shadows [Fernando05], what games ship: a search for blockers around the pixel's projection,
//! whose mean depth tells how wide to filter the hard shadow.
//!
//! Right: contact hardening, at a cost that depends on two sample counts only. Wrong: the penumbra of an occluder
//! parallel to the light is right, any other is a guess; blockers of different depths are averaged into one that is
//! nowhere; blockers that the search misses leave holes; few samples are noise.

use super::Recipe;

pub fn recipe() -> Recipe {
    Recipe::over_samples("pcss_visibility", "pcss_visibility.comp")
}
