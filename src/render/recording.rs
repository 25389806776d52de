//! A frame while it is recorded: what steps of all kinds need.

use crate::error::Error;
use crate::frame::{Lent, Scope, Step};
use crate::gpu::{self, Resources};
use crate::plan::Plan;
use crate::shared::{Fit, Instance, Push};

/// What a host brings along for one frame; nothing where the library draws by itself.
#[derive(Default)]
pub struct Inputs<'a> {
    /// Values for buffers, by name.
    pub uploads: &'a [(&'static str, &'a [u8])],
    pub slot: usize,
    pub instances: &'a [Instance],
    /// The mesh of each instance.
    pub meshes: &'a [usize],
    /// Draws the casters of the view of that number.
    pub draw: Option<&'a mut dyn FnMut(u32)>,
    /// The image for the result.
    pub output: Option<gpu::Target>,
}

/// A frame while it is recorded.
pub struct Recording<'a> {
    pub plan: &'a Plan,
    pub resources: &'a Resources,
    /// [dispatch] In which lists are worked off.
    pub rounds: u32,
}

impl Recording<'_> {
    /// With which of its lists of resources a pass is recorded.
    pub(super) fn list(&self, step: &Step, inputs: &Inputs) -> usize {
        match (step.pass.lent, step.scope) {
            (Lent::Surface, _) => inputs.slot,
            (Lent::Map, Scope::Views { first, .. }) => {
                inputs.slot * self.plan.views().count() + first as usize
            }
            _ => 0,
        }
    }
}

pub(super) fn missing(what: &str) -> Error {
    Error::Invalid(format!("the frame lacks {what} that was planned for"))
}

/// What a step's shaders are told.
pub(super) fn push(step: &Step) -> Push {
    let (index, stride) = match step.scope {
        Scope::Frame => (0, 0),
        Scope::Light(index) => (index, 0),
        Scope::Views { first, stride, .. } => (first, stride),
    };
    Push {
        index,
        stride,
        level: step.level,
    }
}

/// [byte] Where in a view's fit a field stands.
pub(super) fn in_fit(view: u32, offset: usize) -> u64 {
    (view as usize * size_of::<Fit>() + offset) as u64
}
