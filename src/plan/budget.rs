//! How budgets of micro-occluders differ from pixel to pixel [Schwarz08 §4.2].

use super::Plan;
use crate::technique::Settings;

/// A number for all pixels, and what leaves less of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Budget {
    /// [micro-occluder] Along a side of a kernel; None: no limit.
    pub number: Option<u32>,
    /// [0, 1] What is left of it at the image's border, and under textures.
    pub falloff: f32,
    pub masking: f32,
    /// There is an image of shares.
    pub mapped: bool,
}

impl Budget {
    /// Without an image.
    pub(super) fn new(settings: &Settings) -> Self {
        Self {
            number: settings.budget,
            falloff: settings.budget_falloff,
            masking: settings.budget_masking,
            mapped: false,
        }
    }

    /// Whether pixels have budgets of their own.
    pub fn varies(&self) -> bool {
        self.number.is_some() && (self.mapped || self.falloff < 1.0 || self.masking < 1.0)
    }
}

impl Plan {
    /// Whether some view's passes read budgets that differ from pixel to pixel.
    pub(crate) fn budgets_vary(&self) -> bool {
        self.budget.varies() && self.needs(|recipe| recipe.coarse_levels > 0)
    }
}
