//! Micropatches found by a walk through a min-max pyramid of the shadow map [DU07]: squares without an occluder are
//! passed by.
//!
//! Right and wrong as `micropatch`, whose patches it finds. Occluders cannot be pruned: each of their texels is a
//! patch, where contours have only their borders to visit.

use super::{Hierarchy, Method, Recipe, Settings};

pub struct MicropatchHierarchical;

impl Method for MicropatchHierarchical {
    fn recipe(&self, _settings: &Settings) -> Recipe {
        Recipe::over_pixels("micropatch_visibility", "micropatch_tree_visibility.comp")
    }

    /// The hierarchy of [DU07].
    fn make_usual(&self, settings: &mut Settings) {
        settings.split = 1;
        settings.hierarchy = Hierarchy::Hsm;
    }

    fn knobs(&self, _settings: &Settings) -> Vec<&'static str> {
        vec!["split", "no-gap-filling"]
    }
}
