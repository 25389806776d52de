//! Bitmask soft shadows [SS07]: four neighbouring occluder samples span a microquad, whose back-projection covers
//! samples of the light; a bit is covered once, however many occluders hide it, of however many layers.
//!
//! Right: occluders that overlap on the light. Wrong: visibility has as many steps as the light has samples (banding;
//! jittered samples break them up, always in the same way); occluders shrink by half a texel, and what is a single
//! sample wide is missed; with one layer, what the centre of the light cannot see is missed too.

use super::{Method, Occluders, Recipe, Settings, budget_knobs, with};

pub struct Bitmask;

/// Coarser levels are those of the map, not of layers behind it.
fn is_single(settings: &Settings) -> bool {
    settings.layers == 1
}

impl Method for Bitmask {
    fn recipe(&self, settings: &Settings) -> Recipe {
        let layers = settings.layers;
        let recipe = Recipe {
            layers: if layers > 1 { layers } else { 0 },
            words: (settings.light_samples * settings.light_samples).div_ceil(32),
            ..Recipe::over_pixels("bitmask_visibility", "bitmask_visibility.comp")
        };
        match is_single(settings) {
            true => recipe.within_budget(settings),
            false => recipe,
        }
    }

    fn knobs(&self, settings: &Settings) -> Vec<&'static str> {
        let mut knobs = vec!["split", "light-samples", "pattern", "layers", "occluders"];
        if is_single(settings) {
            knobs.extend(budget_knobs(settings));
        }
        knobs
    }

    fn occluders(&self) -> &'static [Occluders] {
        &[
            Occluders::Microquads,
            Occluders::Micropatches,
            Occluders::Microrects,
        ]
    }

    fn constants(&self, settings: &Settings) -> Vec<(&'static str, u32)> {
        let kind = settings.occluders;
        vec![
            ("MICROQUADS", (kind == Occluders::Microquads).into()),
            ("MICRORECTS", (kind == Occluders::Microrects).into()),
        ]
    }

    fn make_usual(&self, settings: &mut Settings) {
        (settings.split, settings.occluders) = (1, Occluders::Microquads);
    }

    fn variants(&self, usual: Settings) -> Vec<Settings> {
        vec![
            with(&usual, |settings| settings.light_samples = 8),
            with(&usual, |settings| settings.layers = 2),
            usual,
        ]
    }
}
