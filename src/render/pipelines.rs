//! The pipelines of a pass.

use std::sync::Arc;

use ash::vk;

use crate::error::{Error, Result};
use crate::frame::{Drawn, Pass, Target, Work};
use crate::gpu::{
    Blend, ComputePass, Constants, Cost, Gpu, GraphicsPass, GraphicsState, ImageKind, Resources,
    Sources,
};
use crate::plan::Plan;

/// The lists of resources that a pass is recorded with, each of them a list of sources.
pub type Lists<'a> = Vec<Vec<&'a Resources>>;

/// What a pass is recorded with.
pub enum Pipelines {
    /// Nothing of the library's.
    None,
    Compute(ComputePass),
    Draw(GraphicsPass),
    /// Of opaque and of alpha-masked casters.
    Casters {
        opaque: GraphicsPass,
        masked: Option<GraphicsPass>,
    },
}

impl Pipelines {
    /// `lists`: what it is recorded with, of which there may be none; None: it is compiled alone. `output`: the format of the image
    /// that a host lends for the result.
    ///
    /// # Errors
    /// A resource that a shader names is missing, or a Vulkan call failed.
    pub fn new(
        gpu: &Arc<Gpu>,
        plan: &Plan,
        pass: &Pass,
        constants: &Constants,
        lists: Option<&Lists>,
        output: vk::Format,
    ) -> Result<Self> {
        if lists.is_some_and(Vec::is_empty) {
            return Ok(Self::None);
        }
        let lists: Vec<&Sources> = lists.into_iter().flatten().map(Vec::as_slice).collect();
        match pass.work {
            Work::Clear(_) | Work::Upload | Work::CopyLayer { .. } => Ok(Self::None),
            Work::Draw {
                what: Drawn::ByHost,
                ..
            } => Ok(Self::None),
            Work::Dispatch { shader, .. } => {
                let pass = ComputePass::with_each(gpu, pass.name, shader, constants, &lists)?;
                Ok(Self::Compute(pass))
            }
            Work::Draw {
                vertex,
                fragment,
                what,
                into,
            } => {
                let colors = colors(plan, into, output);
                let (depth, blend) = match into {
                    Target::Images { depth, blend, .. } => (depth, blend),
                    Target::Lent => (None, Blend::Replace),
                };
                let kind = depth.and_then(|name| plan.image_kind(name));
                let draw = |name: &str, fragment, constants: &Constants| {
                    let state = GraphicsState {
                        vertex,
                        fragment,
                        colors: &colors,
                        blend,
                        depth: depth.is_some(),
                        multisampled: kind.is_some_and(ImageKind::is_multisampled),
                    };
                    GraphicsPass::with_each(gpu, name, &state, constants, &lists)
                };
                let first = draw(pass.name, fragment, constants)?;
                let Drawn::Casters { masked } = what else {
                    return Ok(Self::Draw(first));
                };
                let mut with_holes = constants.clone();
                with_holes.insert("MASKED", 1);
                let name = format!("{} (masked)", pass.name);
                let masked = (plan.masked).then(|| draw(&name, Some(masked), &with_holes));
                Ok(Self::Casters {
                    opaque: first,
                    masked: masked.transpose()?,
                })
            }
        }
    }

    /// What its shaders cost; see [`ComputePass::costs`].
    ///
    /// # Errors
    /// A Vulkan call failed.
    pub fn costs(&self) -> Result<Vec<Cost>> {
        match self {
            Self::None => Ok(Vec::new()),
            Self::Compute(pass) => pass.costs(),
            Self::Draw(pass) => pass.costs(),
            Self::Casters { opaque, masked } => {
                let masked = masked
                    .as_ref()
                    .map_or(Ok(Vec::new()), GraphicsPass::costs)?;
                Ok([opaque.costs()?, masked].concat())
            }
        }
    }

    /// # Errors
    /// It is no compute pass.
    pub fn compute(&self) -> Result<&ComputePass> {
        match self {
            Self::Compute(pass) => Ok(pass),
            _ => Err(Error::Unsupported("a pass has no compute pipeline".into())),
        }
    }
}

/// The formats of what is drawn into.
fn colors(plan: &Plan, into: Target, output: vk::Format) -> Vec<vk::Format> {
    match into {
        Target::Images { colors, .. } => {
            let format = |name: &&str| plan.image_kind(name).map(ImageKind::format);
            colors.iter().filter_map(format).collect()
        }
        Target::Lent => vec![output],
    }
}
