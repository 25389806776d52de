//! Micropatches [GBP06, after Atty06]: every texel of the kernel that occludes is a rectangle at its depth; the areas
//! of their back-projections add up.
//!
//! Right: a plate parallel to the light, and any occluder of one depth. Wrong: between patches of different depths
//! there are gaps, through which light leaks, or overlaps, which count twice. Gap filling closes the gaps to the left
//! and below and lets occluders grow. A texel is opaque to its border, so occluders are too large by up to half a
//! texel; what the centre of the light cannot see is missed. Microrects of coarser levels overlap, and count twice where they do.

use super::{Method, Occluders, Recipe, Settings, budget_knobs, with};

pub struct Micropatch;

impl Method for Micropatch {
    fn recipe(&self, settings: &Settings) -> Recipe {
        Recipe::over_pixels("micropatch_visibility", "micropatch_visibility.comp")
            .within_budget(settings)
    }

    fn knobs(&self, settings: &Settings) -> Vec<&'static str> {
        let mut knobs = [&["split", "occluders"], budget_knobs(settings)].concat();
        if settings.occluders == Occluders::Micropatches {
            knobs.push("no-gap-filling");
        }
        knobs
    }

    fn occluders(&self) -> &'static [Occluders] {
        &[Occluders::Micropatches, Occluders::Microrects]
    }

    fn constants(&self, settings: &Settings) -> Vec<(&'static str, u32)> {
        vec![(
            "MICRORECTS",
            (settings.occluders == Occluders::Microrects).into(),
        )]
    }

    fn variants(&self, usual: Settings) -> Vec<Settings> {
        vec![with(&usual, |settings| settings.gap_filling = false), usual]
    }
}
