//! Contours pixel by pixel [GBP07, as re-implemented in Yang09 §6]: with tight kernels from the hierarchy,
//! without the adaptive precision of the original, which trades quality. DEVIATION as in `packet_contour`: samples below
//! the receiver's plane do not occlude.
//!
//! Right and wrong as `packet_contour`, whose baseline it is: flat over every cell of the kernel, or
//! hierarchical over the hierarchy.

use super::{
    CLASSIFY, CONTOUR_BIAS, KERNELS, Method, PIXELS, Recipe, Settings, TILES, TURNS_OF_WALKS,
    budget_knobs, once, with,
};

pub struct PixelContour;

impl Method for PixelContour {
    fn recipe(&self, settings: &Settings) -> Recipe {
        let mut recipe = Recipe::over_pixels("contour_visibility", "contour_visibility.comp");
        if settings.hierarchical {
            recipe.passes = once([TILES, KERNELS, CLASSIFY, PIXELS]);
            recipe.turns = TURNS_OF_WALKS;
        }
        recipe.within_budget(settings)
    }

    fn knobs(&self, settings: &Settings) -> Vec<&'static str> {
        [&["split", "hierarchical"], budget_knobs(settings)].concat()
    }

    fn constants(&self, _settings: &Settings) -> Vec<(&'static str, u32)> {
        vec![("CONTOURS", 1), ("FOOTPRINT", 0)]
    }

    fn bias(&self, _settings: &Settings) -> f32 {
        CONTOUR_BIAS
    }

    fn variants(&self, usual: Settings) -> Vec<Settings> {
        vec![with(&usual, |settings| settings.hierarchical = true), usual]
    }
}
