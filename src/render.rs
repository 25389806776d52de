//! The frame: front, technique, back.

mod chain;
mod constants;
mod costs;
mod counts;
mod draw;
mod effect;
mod notes;
mod pipelines;
mod recording;
mod resources;
mod step;

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::frame::back::SHADE;
use crate::frame::{Scope, Step};
use crate::gpu::{Buffer, Commands, Gpu, Recorder, Resources, Timings};
use crate::plan::{Outputs, Plan, plan};
use crate::shared::{Costs, Counters, Exposure, Fit};
use crate::shot::Shot;
use chain::{Chain, Loans};
use recording::Inputs;

pub use costs::{PassCost, static_costs};
pub use effect::{
    CasterImages, DrawnView, Effect, FrameInput, GivenMap, Mesh, MeshInstance, SlotImages,
};

/// Cost model [Yang09 eq. 6], Q_n = 1. On lavapipe the time hardly depends on it as long as Q_v is not far
/// above Q_e, and a search on a busy machine found nothing better; `halfshade calibrate` measures it elsewhere.
pub const DEFAULT_COSTS: Costs = Costs {
    edge: 4.0,
    visibility: 2.0,
};

/// [visited node] The largest cost of an edge; beyond it f32 sums of costs lose the rest.
pub const MAX_COST: f32 = 1e6;

impl Costs {
    /// # Errors
    /// [`Error::Invalid`] when a cost is not more than 0 and at most [`MAX_COST`].
    pub fn validate(self) -> Result<()> {
        let sane = |cost: f32| cost > 0.0 && cost <= MAX_COST;
        match sane(self.edge) && sane(self.visibility) {
            true => Ok(()),
            false => Err(Error::Invalid(format!(
                "the costs of an edge are more than 0 and at most {MAX_COST}, not {} and {}",
                self.edge, self.visibility
            ))),
        }
    }
}

/// Constant light from everywhere, so that umbrae are dark rather than black.
pub const DEFAULT_EXPOSURE: Exposure = Exposure {
    scale: 1.0,
    ambient: 0.04,
    light_count: 0,
};

/// What a renderer is made for, beside the shot.
#[derive(Debug, Clone, Copy)]
pub struct RenderOptions {
    pub outputs: Outputs,
    pub costs: Costs,
    pub exposure: Exposure,
}

/// Renders one shot any number of times. All allocation happens when it is created.
pub struct Renderer {
    gpu: Arc<Gpu>,
    /// The plan of a frame that draws every map, and of one that finds the last frame's map still there.
    fresh: Plan,
    kept: Plan,
    resources: Resources,
    chain: Chain,
    recorder: Recorder,
    /// The last frame's map and hierarchy are still there.
    retained: bool,
}

/// A finished frame.
#[derive(Debug, Clone)]
pub struct Frame {
    pub timings: Timings,
    /// What ran.
    pub plan: Plan,
}

impl Renderer {
    /// # Errors
    /// The shot makes no sense or exceeds the device's limits (see `plan`), memory or a pipeline cannot
    /// be had.
    pub fn new(gpu: &Arc<Gpu>, shot: &Shot, options: RenderOptions) -> Result<Self> {
        options.costs.validate()?;
        let fresh = plan(shot, options.outputs, &gpu.limits)?;
        let plan = &fresh;
        // First, because where nothing can be submitted nothing else is worth its time.
        let recorder = Recorder::new(gpu, plan.steps().count() as u32)?;
        let exposure = Exposure {
            light_count: plan.lights.len() as u32,
            ..options.exposure
        };
        let resources = resources::create(gpu, plan, shot, options.costs, exposure)?;
        let chain = Chain::new(gpu, plan, &resources, &Loans::default())?;
        let mut renderer = Self {
            chain,
            recorder,
            gpu: gpu.clone(),
            kept: fresh.retaining(),
            fresh,
            resources,
            retained: false,
        };
        renderer.recorder.begin()?;
        renderer.recorder.commands().initialize(&renderer.resources);
        renderer.recorder.submit_and_wait()?;
        Ok(renderer)
    }

    /// The plan of the next frame.
    pub fn plan(&self) -> &Plan {
        if self.retained {
            &self.kept
        } else {
            &self.fresh
        }
    }

    /// Changes the cost model's constants from the next frame on.
    ///
    /// # Errors
    /// A constant is out of range (see [`Costs::validate`]), or a Vulkan call failed.
    pub fn set_costs(&mut self, costs: Costs) -> Result<()> {
        costs.validate()?;
        self.resources.buffer("costs")?.upload(&[costs])
    }

    /// Makes the next frame draw every map anew, as if something had changed.
    pub fn invalidate(&mut self) {
        self.retained = false;
    }

    /// Renders a frame and waits for it.
    ///
    /// # Errors
    /// A Vulkan call failed, or the driver ended a traversal before it was finished.
    pub fn render(&mut self) -> Result<Frame> {
        self.recorder.begin()?;
        self.record(None)?;
        let timings = self.recorder.submit_and_wait()?;
        self.check_finished()?;
        let plan = self.plan().clone();
        self.retained = true;
        Ok(Frame { timings, plan })
    }

    /// Renders a frame of which one view alone is left, so that what the views share (map, hierarchy, kernels, lists,
    /// occlusion) can be read as that view leaves it. The next frame draws every map anew.
    ///
    /// # Errors
    /// As for [`Self::render`].
    pub fn render_view(&mut self, view: u32) -> Result<()> {
        self.invalidate();
        self.recorder.begin()?;
        self.record(Some(view))?;
        self.recorder.submit_and_wait()?;
        self.check_finished()
    }

    /// A kernel can be larger than the driver lets a loop run; then the picture is wrong.
    fn check_finished(&self) -> Result<()> {
        let unfinished: u64 = self
            .fits()?
            .iter()
            .map(|fit| u64::from(fit.unfinished))
            .sum();
        if unfinished == 0 {
            return Ok(());
        }
        Err(Error::Unsupported(format!(
            "{unfinished} traversals are longer than drivers let a shader loop; choose a smaller --map or a larger --split"
        )))
    }

    /// `only`: the view to which the frame is limited.
    fn record(&mut self, only: Option<u32>) -> Result<()> {
        let in_view = |step: &Step| match (only, step.scope) {
            (Some(only), scope @ Scope::Views { .. }) => scope.has_view(only),
            _ => true,
        };
        self.record_steps(in_view)
    }

    fn record_steps(&mut self, wanted: impl Fn(&Step) -> bool) -> Result<()> {
        let plan = match self.retained {
            true => &self.kept,
            false => &self.fresh,
        };
        let (commands, inputs) = (&mut self.recorder.commands(), &mut Inputs::default());
        self.chain
            .record(commands, plan, &self.resources, inputs, wanted)
    }

    /// The names of the last frame's passes, as recorded.
    pub fn recorded(&self) -> &[&'static str] {
        self.recorder.names()
    }

    /// What a buffer holds after a frame.
    pub fn read_buffer<T: bytemuck::Pod>(&self, name: &str, count: usize) -> Result<Vec<T>> {
        let buffer = self.resources.buffer(name)?;
        let bytes = (count * size_of::<T>()) as u64;
        self.read_back(name, bytes, count, |commands, target| {
            commands.copy_buffer("readback", buffer, target)
        })
    }

    /// What an image holds after a frame: all layers, row by row, `count` values.
    pub fn read_image<T: bytemuck::Pod>(&self, name: &str, count: usize) -> Result<Vec<T>> {
        let image = self.resources.image(name)?;
        self.read_back(name, image.bytes(), count, |commands, target| {
            commands.copy_image("readback", image, target)
        })
    }

    /// The same of an image that has layers for each of the views that are made at once, after [`Self::render_view`]: `count` values of
    /// that view's.
    pub fn read_image_of_view<T: bytemuck::Pod>(
        &self,
        name: &str,
        view: u32,
        count: usize,
    ) -> Result<Vec<T>> {
        let views_at_once = self.fresh.views_at_once;
        let mut all = self.read_image(name, count * views_at_once as usize)?;
        let first = (view % views_at_once) as usize * count;
        Ok(all.drain(first..first + count).collect())
    }

    /// Copies `bytes` into memory that the host can read, waits, and reads `count` values.
    fn read_back<T: bytemuck::Pod>(
        &self,
        name: &str,
        bytes: u64,
        count: usize,
        copy: impl FnOnce(&mut Commands, &Buffer),
    ) -> Result<Vec<T>> {
        let target = Buffer::readback(&self.gpu, &format!("{name} (readback)"), bytes)?;
        let mut recorder = Recorder::new(&self.gpu, 0)?;
        recorder.begin()?;
        copy(&mut recorder.commands(), &target);
        recorder.submit_and_wait()?;
        target.read(count)
    }

    fn pixel_count(&self) -> usize {
        self.fresh.size.0 as usize * self.fresh.size.1 as usize
    }

    /// A light's visibility, row by row from the top: 0 umbra … 1 lit, NaN where there is no surface.
    ///
    /// # Errors
    /// There is no such light, or a Vulkan call failed.
    pub fn visibility(&self, light: usize) -> Result<Vec<f32>> {
        let count = self.fresh.lights.len();
        if light >= count {
            return Err(Error::Invalid(format!(
                "there is no light {light}; the shot has {count}"
            )));
        }
        let pixels = self.pixel_count();
        let all = self.read_buffer("visibility", pixels * self.fresh.lights.len())?;
        Ok(all[light * pixels..(light + 1) * pixels].to_vec())
    }

    /// The picture, RGBA8, row by row from the top.
    pub fn picture(&self) -> Result<Vec<u8>> {
        self.read_buffer("picture", 4 * self.pixel_count())
    }

    /// The picture that another visibility would give, light after light as [`Self::visibility`] has them, after a
    /// frame has been rendered.
    ///
    /// # Errors
    /// The renderer makes no picture, `visibility` has not a value for each light and pixel, or a Vulkan call failed.
    pub fn picture_of(&mut self, visibility: &[f32]) -> Result<Vec<u8>> {
        let expected = self.pixel_count() * self.fresh.lights.len();
        if !self.fresh.outputs.picture || visibility.len() != expected {
            return Err(Error::Invalid(format!(
                "{} values of visibility make no picture where {expected} are needed, or none was asked for",
                visibility.len()
            )));
        }
        self.resources.buffer("visibility")?.upload(visibility)?;
        self.recorder.begin()?;
        self.record_steps(|step| step.pass.name == SHADE.name)?;
        self.recorder.submit_and_wait()?;
        self.picture()
    }

    /// Zero unless the settings ask for counters; summed over all frames since the last reset.
    pub fn counters(&self) -> Result<Counters> {
        Ok(self.read_buffer("counters", 1)?[0])
    }

    /// What the device found out about each view.
    pub fn fits(&self) -> Result<Vec<Fit>> {
        self.read_buffer("fits", self.fresh.views().count())
    }
}
