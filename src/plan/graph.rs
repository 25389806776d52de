//! The passes of a frame, in the order in which they are recorded.

use super::{Plan, ViewSet};
use crate::frame::{Graph, Scope, Step, back, counts, front, kernel, map};
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
                kernel::first_passes(self.needs(Recipe::has_lists), self.budgets_vary()),
            );
        }
        for (index, light) in self.lights.iter().enumerate() {
            let scope = Scope::Light(index as u32);
            graph.add(scope, back::first_passes(light.accumulates()));
            let mut view = light.light.view_first;
            for set in &light.sets {
                let end = view + set.views.len() as u32;
                while view < end {
                    let count = self.views_at_once.min(end - view);
                    self.add_views(&mut graph, set, view, count);
                    view += count;
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

    /// Views of a set whose maps are made side by side; then what reads them, view by view.
    fn add_views(&self, graph: &mut Graph, set: &ViewSet, first: u32, count: u32) {
        let structures = self.structures(&set.recipe);
        let all = Scope::Views { first, count };
        graph.add(all, map::fitting_passes(self.casters));
        graph.add(all, [map::drawing_pass(self.casters)]);
        graph.add_levels(all, map::hierarchy_passes(structures));
        for view in all.each() {
            graph.add_levels(view, map::structure_passes(structures));
            graph.add_levels(view, set.recipe.passes.iter().copied());
        }
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

    /// The same of those that a view has a part in.
    pub(super) fn passes_of_view(&self, view: u32) -> Vec<(&'static str, u32)> {
        let of_view = |step: &&Step| step.scope.has_view(view);
        counts(self.steps().filter(of_view))
    }
}
