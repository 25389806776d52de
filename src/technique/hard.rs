//! Hard shadows from the nearest sample [Williams78], or from the share of 3×3 samples that hide the pixel
//! (percentage-closer filtering); with split > 1 the mean of as many hard shadows.
//!
//! Right: lights without extent. Wrong: every penumbra; edges alias in steps of a texel, and the filter blurs them
//! by the same three texels everywhere.

use super::Recipe;

pub fn recipe() -> Recipe {
    Recipe::over_samples("hard_visibility", "hard_visibility.comp")
}
