//! The passes of a frame, in the order in which they are recorded.

use std::ops::Range;

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
            for set in &light.sets {
                for views in self.side_by_side(set) {
                    self.add_views(&mut graph, set, views);
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

    /// Views of a set whose maps are made side by side; then what reads them, side by side as well or view by view.
    fn add_views(&self, graph: &mut Graph, set: &ViewSet, views: Range<u32>) {
        let structures = self.structures(&set.recipe);
        let all = Scope::Views {
            first: views.start,
            count: views.len() as u32,
            stride: 1,
        };
        graph.add(all, map::fitting_passes(self.casters));
        graph.add(all, [map::drawing_pass(self.casters)]);
        graph.add_levels(all, map::hierarchy_passes(structures));
        let passes = || set.recipe.passes.iter().copied();
        if self.looks_side_by_side(&set.recipe) {
            for scope in set.of_each_face(views) {
                graph.add_levels(scope, passes());
            }
            return graph.add(all, [kernel::ADD_UP]);
        }
        for view in all.each() {
            graph.add_levels(view, map::structure_passes(structures));
            graph.add_levels(view, passes());
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
