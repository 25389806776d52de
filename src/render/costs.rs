//! What the passes of a plan cost as they are compiled, without running any: registers, occupancy, spills, as the driver tells.

use std::sync::Arc;

use ash::vk;

use super::chain::Distinct;
use super::pipelines::Pipelines;
use crate::error::Result;
use crate::frame::Pass;
use crate::gpu::{Constants, Cost, Gpu};
use crate::plan::Plan;

/// A pass, as often as it differs in shaders or constants.
#[derive(Debug, Clone)]
pub struct PassCost {
    /// As in the plan.
    pub name: &'static str,
    /// How many steps of the frame run it.
    pub steps: usize,
    /// Of its shaders, in the driver's order.
    pub shaders: Vec<Cost>,
}

/// The passes of a plan that have shaders, in the order of their first step. Without statistics unless the device is open for them
/// ([`Options::costs`](crate::gpu::Options)).
///
/// # Errors
/// A pipeline cannot be created.
pub fn static_costs(gpu: &Arc<Gpu>, plan: &Plan) -> Result<Vec<PassCost>> {
    let Distinct { passes, of_step } = Distinct::of(plan)?;
    let cost = |(index, (pass, constants)): (usize, &(Pass, Constants))| {
        let output = vk::Format::R32_SFLOAT;
        let pipelines = Pipelines::new(gpu, plan, pass, constants, None, output)?;
        Ok(PassCost {
            name: pass.name,
            steps: of_step.iter().filter(|&&step| step == index).count(),
            shaders: pipelines.costs()?,
        })
    };
    let costs = passes.iter().enumerate().map(cost);
    let mut costs = costs.collect::<Result<Vec<PassCost>>>()?;
    costs.retain(|cost| !cost.shaders.is_empty());
    Ok(costs)
}
