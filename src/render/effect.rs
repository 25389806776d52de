//! A light's soft shadows in a host's own frames: the same chain of passes as the renderer's, between images that the
//! host lends, recorded into the host's command buffer.

mod given;
mod input;
mod prepared;
mod surface;

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::frame::Casters;
use crate::gpu::{Commands, Gpu};
use crate::plan::{HostFrame, Plan, plan_for_host};
use crate::shared::{self, Costs, Given, Instance, Projection, View};

use super::recording::Inputs;
pub use given::GivenMap;
pub use input::{CasterImages, DrawnView, FrameInput, Mesh, MeshInstance, SlotImages};
use prepared::Prepared;

/// Soft shadows of one light at one size and quality.
///
/// `prepare` allocates all memory and creates all pipelines, `record` records a frame and does nothing else, `collect`
/// lets go of what no frame uses any more.
pub struct Effect {
    gpu: Arc<Gpu>,
    host: HostFrame,
    costs: Costs,
    plan: Plan,
    /// What frames are recorded with now.
    prepared: Option<Prepared>,
    /// What earlier frames were recorded with and may still be under way.
    retired: Vec<Prepared>,
    /// The serial of the last frame that was recorded, and of the last that the host knows to be finished.
    recorded: u64,
    completed: u64,
    /// What a frame sends along, kept so that recording does not allocate.
    views: Vec<View>,
    givens: Vec<Given>,
    instances: Vec<Instance>,
    /// The mesh of each instance.
    chosen: Vec<usize>,
}

impl Effect {
    /// # Errors
    /// Something makes no sense, or exceeds the device's limits.
    pub fn new(gpu: &Arc<Gpu>, host: HostFrame, costs: Costs) -> Result<Self> {
        costs.validate()?;
        let plan = plan_for_host(&host, &gpu.limits)?;
        let views: Vec<View> = plan.views().map(|planned| planned.view).collect();
        Ok(Self {
            gpu: gpu.clone(),
            costs,
            prepared: None,
            retired: Vec::new(),
            recorded: 0,
            completed: 0,
            givens: vec![Given::default(); views.len()],
            instances: Vec::with_capacity(host.instances as usize),
            chosen: Vec::with_capacity(host.instances as usize),
            views,
            plan,
            host,
        })
    }

    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// [byte] Of all resources on the device, those of retired frames included.
    pub fn memory_bytes(&self) -> u64 {
        let held = self.retired.len() + usize::from(self.prepared.is_some());
        self.plan.memory_bytes() * held as u64
    }

    /// Allocates all memory and creates all pipelines for frames with these images and meshes. May be called again when
    /// they change; what earlier frames use stays until it is `collect`ed.
    ///
    /// # Errors
    /// An image or a mesh does not fit, an allocation failed, or a pipeline cannot be created; then all is as it was.
    ///
    /// # Safety
    /// Images and buffers are of this device, as described, and outlive all frames that are recorded with them, and
    /// the next `prepare` and the `collect` after it.
    pub unsafe fn prepare(&mut self, slots: &[SlotImages], meshes: &[Mesh]) -> Result<()> {
        // SAFETY: the caller's promise.
        let prepared =
            unsafe { Prepared::new(&self.gpu, &self.host, &self.plan, self.costs, slots, meshes) }?;
        self.retired.extend(self.prepared.replace(prepared));
        self.retire();
        Ok(())
    }

    /// Lets go of what frames up to `completed` have used and no later ones do.
    ///
    /// # Errors
    /// That frame was not recorded yet.
    pub fn collect(&mut self, completed: u64) -> Result<()> {
        if completed > self.recorded {
            return Err(Error::Invalid(format!(
                "frame {completed} cannot have finished: the last that was recorded is {}",
                self.recorded
            )));
        }
        self.completed = self.completed.max(completed);
        self.retire();
        Ok(())
    }

    fn retire(&mut self) {
        let completed = self.completed;
        self.retired.retain(|retired| retired.last > completed);
    }

    /// Where a host that draws casters itself finds the views' projections; null where nothing is prepared or it does
    /// not.
    pub fn projections(&self) -> ash::vk::Buffer {
        match (&self.prepared, self.plan.casters) {
            (Some(prepared), Casters::DrawnByHost) => prepared
                .resources
                .buffer("projections")
                .map(|buffer| buffer.raw()),
            _ => Ok(ash::vk::Buffer::null()),
        }
        .unwrap_or_default()
    }

    /// Whether frames can be recorded.
    pub fn is_prepared(&self) -> bool {
        self.prepared.is_some()
    }

    /// Records a frame. Does not allocate, submits nothing and waits for nothing.
    ///
    /// # Errors
    /// Something of the frame makes no sense; then nothing was recorded.
    ///
    /// # Safety
    /// As for [`Commands::of_host`]; the slot's images are in the state that was described when the commands run.
    pub unsafe fn record(
        &mut self,
        commands: ash::vk::CommandBuffer,
        frame: &mut FrameInput,
    ) -> Result<()> {
        let prepared = self.prepared.as_mut().ok_or_else(not_prepared)?;
        if frame.serial < self.recorded {
            return Err(Error::Invalid(format!(
                "frame {} comes after frame {}; serials do not go down",
                frame.serial, self.recorded
            )));
        }
        frame.validate(&self.host, prepared.slots.len(), self.views.len())?;
        self.plan.place(&frame.light)?;
        for (view, planned) in self.views.iter_mut().zip(self.plan.views()) {
            *view = planned.view;
        }
        frame.give(&mut self.views, &mut self.givens)?;
        let (meshes, instances) = (&prepared.layouts, &mut self.instances);
        self.plan.frame.opaque_count =
            frame.gather(&self.host, meshes, instances, &mut self.chosen)?;
        self.recorded = frame.serial;
        prepared.last = frame.serial;
        let rounding = prepared.slots[frame.slot].rounding;
        let constants = shared::Host {
            world_from_clip: frame.world_from_clip,
            normal_to_world: frame.normal_to_world,
            normal_encoding: frame.normal_encoding,
            depth_empty: frame.depth_empty,
            background: frame.background,
            surface_share: rounding.share,
            surface_step: rounding.step,
            position_error: frame.position_error,
        };
        // SAFETY: the caller's promise.
        let mut commands = unsafe { Commands::of_host(&self.gpu, commands) };
        let given: &[Given] = match self.plan.casters.are_triangles() {
            true => &[],
            false => &self.givens,
        };
        let light = self.plan.lights.first().map(|light| light.light);
        let light = light.unwrap_or_default();
        let mut nobody = |_| {};
        let draw = match &mut frame.draw {
            Some(draw) => draw,
            None => &mut nobody as &mut dyn FnMut(DrawnView),
        };
        let mut drawn = |index: u32| {
            let offset = u64::from(index) * size_of::<Projection>() as u64;
            draw(DrawnView { index, offset });
        };
        let mut inputs = Inputs {
            uploads: &[
                ("frame", bytemuck::bytes_of(&self.plan.frame)),
                ("lights", bytemuck::bytes_of(&light)),
                ("host", bytemuck::bytes_of(&constants)),
                ("views", bytemuck::cast_slice(&self.views)),
                ("givens", bytemuck::cast_slice(given)),
                ("instances", bytemuck::cast_slice(&self.instances)),
            ],
            slot: frame.slot,
            instances: &self.instances,
            meshes: &self.chosen,
            draw: Some(&mut drawn),
            output: None,
        };
        prepared.record(&mut commands, &self.plan, &mut inputs)
    }
}

fn not_prepared() -> Error {
    Error::Invalid("nothing is prepared yet; prepare the effect first".into())
}
