//! Hard shadows from the nearest sample [Williams78], or from the share of 3×3 samples that hide the pixel
//! (percentage-closer filtering); with split > 1 the mean of as many hard shadows.
//!
//! Right: lights without extent. Wrong: every penumbra; edges alias in steps of a texel, and the filter blurs them
//! by the same three texels everywhere.

use super::{Method, Recipe, Settings, with};

pub struct Hard;

/// What tests single samples of a map.
pub fn recipe() -> Recipe {
    Recipe::over_samples("hard_visibility", "hard_visibility.comp")
}

impl Method for Hard {
    fn recipe(&self, _settings: &Settings) -> Recipe {
        recipe()
    }

    fn knobs(&self, _settings: &Settings) -> Vec<&'static str> {
        vec!["split", "percentage-closer"]
    }

    /// Samples of 3×3 texels are within one and a half; the nearest is within a half, of which a whole one is twice as much.
    fn bias(&self, settings: &Settings) -> f32 {
        if settings.percentage_closer { 1.5 } else { 1.0 }
    }

    fn variants(&self, usual: Settings) -> Vec<Settings> {
        vec![
            with(&usual, |settings| settings.percentage_closer = true),
            usual,
        ]
    }

    fn samples_points(&self) -> bool {
        true
    }
}
