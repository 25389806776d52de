//! Interprets a plan: creates the pipelines that its passes need, and records its steps into any command buffer. One chain
//! serves the renderer, which owns its command buffers, and a host's frames, which do not.

use std::collections::BTreeMap;
use std::sync::Arc;

use ash::vk;

use super::constants;
use super::pipelines::{Lists, Pipelines};
use super::recording::{Inputs, Recording};
use crate::error::Result;
use crate::frame::{Lent, Pass, Scope, Step};
use crate::gpu::{self, Commands, Constants, Gpu, Resources};
use crate::plan::{Plan, ViewSet};

/// What a host lends to all frames of a chain; empty where the library draws by itself.
#[derive(Default)]
pub struct Loans<'a> {
    /// For each slot the images of the surface.
    pub surfaces: Vec<&'a Resources>,
    /// For each mesh its buffers.
    pub meshes: Vec<&'a Resources>,
    /// The shadow maps of the first slot's views, then of the next slot's.
    pub maps: Vec<&'a Resources>,
    /// The format of the image that the result is drawn to.
    pub output: vk::Format,
}

/// The steps of a plan with their pipelines.
pub struct Chain {
    /// Those of different shaders or constants.
    pipelines: Vec<Pipelines>,
    /// The pipelines of each step of the plan's graph, by their place above.
    of_step: Vec<usize>,
    /// [texel] Side of each view's map.
    sides: Vec<u32>,
    rounds: u32,
}

impl Chain {
    /// # Errors
    /// An allocation failed, or a pipeline cannot be created.
    pub fn new(gpu: &Arc<Gpu>, plan: &Plan, resources: &Resources, loans: &Loans) -> Result<Self> {
        let Distinct { passes, of_step } = Distinct::of(plan)?;
        let compiled = |(pass, constants): &(Pass, Constants)| {
            let lists = lists(pass.lent, resources, loans);
            Pipelines::new(gpu, plan, pass, constants, Some(&lists), loans.output)
        };
        let pipelines = passes.iter().map(compiled).collect::<Result<_>>()?;
        let side = |set: &ViewSet| vec![set.settings.map; set.views.len()];
        Ok(Self {
            pipelines,
            of_step,
            sides: plan.sets().flat_map(side).collect(),
            rounds: plan.rounds(),
        })
    }

    /// Records the steps of a plan that are wanted. Does not allocate.
    ///
    /// # Errors
    /// A resource is missing that the plan should have listed, or an input that it asks for.
    pub fn record(
        &self,
        commands: &mut Commands,
        plan: &Plan,
        resources: &Resources,
        inputs: &mut Inputs,
        wanted: impl Fn(&Step) -> bool,
    ) -> Result<()> {
        let frame = Recording {
            plan,
            resources,
            rounds: self.rounds,
        };
        for (step, &index) in plan.graph.steps.iter().zip(&self.of_step) {
            let left_out = plan.retained && step.pass.lasts;
            if !left_out && wanted(step) {
                let side = match step.scope {
                    Scope::Views { first, .. } => self.sides[first as usize],
                    Scope::Frame | Scope::Light(_) => 0,
                };
                frame.record(commands, step, &self.pipelines[index], side, inputs)?;
            }
        }
        Ok(())
    }
}

/// The passes of a plan that differ in shaders or constants.
pub struct Distinct {
    pub passes: Vec<(Pass, Constants)>,
    /// Which of them each step of the plan's graph is.
    pub of_step: Vec<usize>,
}

impl Distinct {
    /// # Errors
    /// A shader is missing.
    pub fn of(plan: &Plan) -> Result<Self> {
        let of_frame = constants::of_frame(plan);
        let of_views = constants_of_views(plan, &of_frame);
        let mut known = BTreeMap::new();
        let (mut passes, mut of_step) = (Vec::new(), Vec::new());
        for step in &plan.graph.steps {
            let base = match step.scope {
                Scope::Views { first, .. } => &of_views[first as usize],
                Scope::Frame | Scope::Light(_) => &of_frame,
            };
            let all = constants::of_pass(&step.pass, base.clone());
            let key = (step.pass, gpu::used(&all, &step.pass.shaders())?);
            let index = *known.entry(key).or_insert_with(|| {
                passes.push((step.pass, all));
                passes.len() - 1
            });
            of_step.push(index);
        }
        Ok(Self { passes, of_step })
    }
}

/// The constants of each view.
fn constants_of_views(plan: &Plan, of_frame: &Constants) -> Vec<Constants> {
    let mut all = Vec::new();
    for light in &plan.lights {
        for set in &light.sets {
            for view in &set.views {
                let mut constants = of_frame.clone();
                constants.extend(constants::of_view(plan, light, set, view));
                all.push(constants);
            }
        }
    }
    all
}

/// The lists of resources that a pass is recorded with.
fn lists<'a>(lent: Lent, resources: &'a Resources, loans: &Loans<'a>) -> Lists<'a> {
    let lent = match lent {
        Lent::Nothing => return vec![vec![resources]],
        Lent::Surface => &loans.surfaces,
        Lent::Mesh => &loans.meshes,
        Lent::Map => &loans.maps,
    };
    lent.iter().map(|&lent| vec![lent, resources]).collect()
}
