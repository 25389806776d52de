//! The passes of a frame, in the order in which they are recorded.

use super::{Plan, ViewSet};
use crate::frame::{Graph, Pass, Scope, Step, back, counts, front, kernel, map};
use crate::technique::Recipe;

impl Plan {
    /// All passes of a frame that draws every map.
    pub(super) fn ordered(&self) -> Graph {
        let mut graph = Graph::default();
        graph.add(
            Scope::Frame,
            front::passes(self.front, self.multisampled, self.casters),
        );
        if self.views().next().is_some() {
            graph.add(Scope::Frame, map::first_passes());
            graph.add(
                Scope::Frame,
                kernel::first_passes(
                    self.needs(Recipe::has_lists),
                    self.budgets_vary(),
                    self.needs(|recipe| recipe.grids > 0),
                ),
            );
        }
        for (index, light) in self.lights.iter().enumerate() {
            let scope = Scope::Light(index as u32);
            graph.add(scope, back::first_passes(light.accumulates()));
            let mut view = light.light.view_first;
            for set in &light.sets {
                let passes = self.view_passes(set);
                for _ in &set.views {
                    graph.add_levels(Scope::View(view), passes.iter().copied());
                    view += 1;
                }
            }
            graph.add(scope, back::light_passes());
        }
        graph.add(
            Scope::Frame,
            back::passes(self.front, self.outputs.picture, self.multisampled),
        );
        graph
    }

    /// What runs in each view of a set, with the level or layer that each pass makes.
    fn view_passes(&self, set: &ViewSet) -> Vec<(Pass, u32)> {
        let mut passes = map::passes(self.casters, self.structures(&set.recipe));
        passes.extend(&set.recipe.passes);
        passes
    }

    fn structures(&self, recipe: &Recipe) -> map::Structures {
        map::Structures {
            levels: if recipe.kernels { self.levels } else { 0 },
            bounds_bits: self.bounds_bits,
            layers: recipe.layers,
            coarse_levels: recipe.coarse_levels,
            microrects: recipe.microrects,
        }
    }

    /// What is recorded, in this order.
    pub fn steps(&self) -> impl Iterator<Item = &Step> {
        let all = self.graph.steps.iter();
        all.filter(|step| !(self.retained && step.pass.lasts))
    }

    /// Names of the passes with the number of times each is recorded, in the order of first recording.
    pub fn passes(&self) -> Vec<(&'static str, u32)> {
        counts(self.steps())
    }

    /// The same of a single view.
    pub(super) fn passes_of_view(&self, view: u32) -> Vec<(&'static str, u32)> {
        let of_view = |step: &&Step| step.scope == Scope::View(view);
        counts(self.steps().filter(of_view))
    }
}
