//! Contours pixel by pixel [GBP07, as re-implemented in Yang09 §6]: with tight kernels from the MSSM,
//! without the adaptive precision of the original, which trades quality. DEVIATION as in `packet_contour`: samples below
//! the receiver's plane do not occlude.
//!
//! Right and wrong as `packet_contour`, whose baseline it is: flat over every cell of the kernel, or
//! hierarchical over the MSSM.

use super::{CLASSIFY, KERNELS, PIXELS, Recipe, TURNS_OF_WALKS, once};
use crate::shot::Settings;

pub fn recipe(settings: &Settings) -> Recipe {
    let mut recipe = Recipe::over_pixels("contour_visibility", "contour_visibility.comp");
    if settings.hierarchical {
        recipe.passes = once([KERNELS, CLASSIFY, PIXELS]);
        recipe.turns = TURNS_OF_WALKS;
    }
    recipe
}
