//! The passes of a frame, in the order in which they are recorded.

use super::{Casters, Front, Plan, ViewSet};
use crate::technique::Recipe;

impl Plan {
    pub(super) fn list_passes(&mut self, retained: bool) {
        let mut passes = Vec::new();
        let mut add = |name, count| {
            if count > 0 {
                match passes.iter_mut().find(|(known, _)| *known == name) {
                    Some((_, known)) => *known += count,
                    None => passes.push((name, count)),
                }
            }
        };
        match self.front {
            Front::Drawn => add("gbuffer", 1),
            Front::Imported => {
                add("update", 1);
                add("import_surface", 1);
            }
        }
        if self.casters == Casters::Gathered {
            add("gather", 1);
        }
        if self.views().next().is_some() {
            add("clear_fits", u32::from(!retained));
            add("clear_lists", u32::from(self.needs(Recipe::has_lists)));
        }
        for light in &self.lights {
            add("clear_occlusion", u32::from(light.accumulates()));
            for set in &light.sets {
                let count = set.views.len() as u32;
                for (name, times) in self.view_passes(set, retained) {
                    add(name, count * times);
                }
            }
            add("resolve", 1);
        }
        add("shade", u32::from(self.outputs.picture));
        add("export", u32::from(self.front == Front::Imported));
        self.passes = passes;
    }

    /// What is recorded for each view of a set, in this order, and how often.
    pub(super) fn view_passes(&self, set: &ViewSet, retained: bool) -> Vec<(&'static str, u32)> {
        let mut passes = match retained {
            true => Vec::new(),
            false => self.map_passes(set),
        };
        passes.extend(set.recipe.stages.iter().map(|stage| (stage.name, 1)));
        passes
    }

    /// What is recorded for a view's shadow map, and for what is built on it.
    pub(super) fn map_passes(&self, set: &ViewSet) -> Vec<(&'static str, u32)> {
        let names: &[&str] = match self.casters {
            Casters::Scene | Casters::Gathered => &["receivers", "casters", "fit", "shadow_map"],
            Casters::DrawnByHost => &["receivers", "region", "fit", "projection", "shadow_map"],
            Casters::Maps => &["receivers", "fit", "shadow_map"],
        };
        let mut passes: Vec<_> = names.iter().map(|&name| (name, 1)).collect();
        let recipe = &set.recipe;
        if recipe.mssm {
            passes.push(("mssm", self.levels));
        }
        if recipe.hsm {
            passes.push(("hsm", self.hsm_levels()));
        }
        if recipe.layers > 0 {
            passes.extend([("keep_layer", recipe.layers), ("peel", recipe.layers - 1)]);
        }
        passes
    }

    /// Whether the last frame's shadow map is kept.
    pub fn is_retained(&self) -> bool {
        self.views().next().is_some() && !self.passes.iter().any(|(name, _)| *name == "shadow_map")
    }
}
