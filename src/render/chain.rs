//! From the visible surface to visibility: the passes that a plan lists, recorded into any command buffer. One chain
//! serves the renderer, which owns its command buffers, and a host's frames, which do not.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::error::Result;
use crate::gpu::{Commands, ComputePass, Gpu, Groups, Resources};
use crate::plan::Plan;
use crate::shared::Push;
use crate::technique::Recipe;

use super::specialization;
use super::view::{Maps, ViewPasses, tiles};

/// Pipelines for all that follows the visible surface.
pub struct Chain {
    /// One for each variant and recipe.
    passes: Vec<ViewPasses>,
    /// Which of them each view has.
    of_view: Vec<usize>,
    resolve: ComputePass,
    shade: Option<ComputePass>,
}

impl Chain {
    /// `maps`: lists of resources with a host's shadow maps, where the plan says so.
    ///
    /// # Errors
    /// Memory or a pipeline cannot be had.
    pub fn new(
        gpu: &Arc<Gpu>,
        plan: &Plan,
        resources: &Resources,
        maps: &[Resources],
    ) -> Result<Self> {
        let mut known = BTreeMap::new();
        let (mut passes, mut of_view) = (Vec::new(), Vec::new());
        for set in plan.sets() {
            for planned in &set.views {
                let key = (planned.variant, &set.recipe);
                let index = match known.get(&key) {
                    Some(&index) => index,
                    None => {
                        let variant = planned.variant;
                        passes.push(ViewPasses::new(gpu, plan, set, variant, resources, maps)?);
                        known.insert(key, passes.len() - 1);
                        passes.len() - 1
                    }
                };
                of_view.push(index);
            }
        }
        let constants = specialization::of_frame(plan);
        let compute =
            |name: &str, shader: &str| ComputePass::new(gpu, name, shader, &constants, resources);
        Ok(Self {
            passes,
            of_view,
            resolve: compute("resolve", "resolve.comp")?,
            shade: (plan.outputs.picture)
                .then(|| compute("shade", "shade.comp"))
                .transpose()?,
        })
    }

    /// Records all that the plan lists after the visible surface. Takes no memory.
    ///
    /// `only`: the view to which the frame is limited.
    ///
    /// # Errors
    /// A resource is missing that the plan should have listed.
    pub fn record(
        &self,
        commands: &mut Commands,
        plan: &Plan,
        resources: &Resources,
        maps: &mut Maps,
        only: Option<u32>,
    ) -> Result<()> {
        let retained = plan.is_retained();
        if plan.views().next().is_some() {
            if !retained {
                commands.clear("clear_fits", &[resources.buffer("fits")?]);
            }
            if plan.needs(Recipe::has_lists) {
                let lists = [resources.buffer("lists")?, resources.buffer("rounds")?];
                commands.clear("clear_lists", &lists);
            }
        }
        for (index, light) in plan.lights.iter().enumerate() {
            if light.accumulates() {
                commands.clear("clear_occlusion", &[resources.buffer("occlusion")?]);
            }
            let first = light.light.view_first;
            let views = first..first + light.light.view_count;
            for view in views.filter(|view| only.is_none_or(|only| only == *view)) {
                let passes = &self.passes[self.of_view[view as usize]];
                if !retained {
                    passes.record_map(commands, plan, resources, maps, view)?;
                }
                passes.record_stages(commands, resources, view)?;
            }
            let push = Push {
                index: index as u32,
                level: 0,
            };
            commands.dispatch("resolve", &self.resolve, push, Groups::Direct(tiles(plan)));
        }
        self.record_shade(commands, plan);
        Ok(())
    }

    /// Records the picture from the visibility that is there, if the plan has one.
    pub fn record_shade(&self, commands: &mut Commands, plan: &Plan) {
        if let Some(shade) = &self.shade {
            let groups = Groups::Direct(tiles(plan));
            commands.dispatch("shade", shade, Push::default(), groups);
        }
    }
}
