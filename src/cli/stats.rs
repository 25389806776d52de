//! `--stats`: what a frame cost.

use std::collections::BTreeMap;

use halfshade::Result;
use halfshade::gpu::Gpu;
use halfshade::number::sum;
use halfshade::render::{Frame, Renderer};
use halfshade::shared::Counters;
use halfshade::shot::Shot;
use halfshade::spread::Spread;
use halfshade::study::is_visibility;
use halfshade::technique::Settings;
use serde::Serialize;

use super::notes;

/// Times, memory and counts of a render.
#[derive(Debug, Serialize)]
pub struct Stats {
    device: String,
    /// "cpu" marks a software driver: its times are no GPU's.
    device_kind: &'static str,
    driver: String,
    subgroup_size: u32,
    version: &'static str,
    technique: String,
    settings: Settings,
    /// [pixel]
    size: (u32, u32),
    /// Timed frames, after the warm-up.
    frames: usize,
    passes: Vec<PassStats>,
    total_gpu_ms: Spread,
    #[serde(skip_serializing_if = "Option::is_none")]
    counters: Option<BTreeMap<&'static str, u64>>,
    /// [byte] By resource, and their sum, the peak.
    memory_bytes: BTreeMap<&'static str, u64>,
    views: ViewStats,
    validation_messages: usize,
    /// What was ignored or changed, a sentence each.
    notes: Vec<String>,
}

/// A pass, over the frames.
#[derive(Debug, Serialize)]
struct PassStats {
    name: String,
    /// How often it is recorded in a frame.
    count: u32,
    /// [ms] Of its sum in a frame.
    gpu_ms: Spread,
}

/// What the device left out of the plan.
#[derive(Debug, Serialize)]
struct ViewStats {
    planned: usize,
    /// Views that some visible surface had to be looked at in.
    with_receivers: usize,
    /// Views that had something to draw.
    with_casters: usize,
    /// [triangle] Drawn in a view, on average over views with casters.
    caster_triangles_mean: f64,
    /// [level] Most levels of the hierarchy in a view.
    hierarchy_levels_max: u32,
}

impl Stats {
    /// `frames`: each timed frame with the counters as they were before it.
    pub fn new(
        gpu: &Gpu,
        shot: &Shot,
        renderer: &Renderer,
        frames: &[(Frame, Counters)],
        counted: bool,
    ) -> Result<Self> {
        let plan = &frames[0].0.plan;
        let over = |name: Option<&str>| {
            let counts = |pass: &str| name.is_none_or(|name| name == pass);
            Spread::of(frames.iter().map(|(frame, _)| frame.timings.ms(counts)))
        };
        let passes = plan.passes().into_iter().map(|(name, count)| PassStats {
            name: name.into(),
            count,
            gpu_ms: over(Some(name)),
        });
        let mut memory_bytes: BTreeMap<_, _> = plan.memory().collect();
        memory_bytes.insert("peak", plan.memory_bytes());
        let last = frames.last().map(|(_, before)| *before).unwrap_or_default();
        let counters = counted.then(|| renderer.counters()).transpose()?;
        Ok(Self {
            device: gpu.info.name.clone(),
            device_kind: gpu.info.kind,
            driver: gpu.info.driver.clone(),
            subgroup_size: gpu.info.subgroup_size,
            version: env!("CARGO_PKG_VERSION"),
            technique: shot.settings.technique.to_string(),
            settings: shot.settings.clone(),
            size: plan.size,
            frames: frames.len(),
            passes: passes.collect(),
            total_gpu_ms: over(None),
            counters: counters.map(|after| after.since(&last)),
            memory_bytes,
            views: ViewStats::new(renderer)?,
            validation_messages: gpu
                .validation_messages()
                .lock()
                .map(|said| said.len())
                .unwrap_or(0),
            notes: notes(shot).cloned().collect(),
        })
    }

    /// A line for the terminal.
    pub fn summary(&self) -> String {
        let passes = self.passes.iter();
        let of_visibility = passes.filter(|pass| is_visibility(&pass.name));
        let visibility = sum(of_visibility.map(|pass| pass.gpu_ms.median));
        format!(
            "{}x{} on {}: {:.1} ms, {visibility:.1} ms of them in visibility passes; {} of {} views had casters; {:.1} MB",
            self.size.0,
            self.size.1,
            self.device,
            self.total_gpu_ms.median,
            self.views.with_casters,
            self.views.planned,
            self.memory_bytes["peak"] as f64 * 1e-6,
        )
    }
}

impl ViewStats {
    fn new(renderer: &Renderer) -> Result<Self> {
        let fits = renderer.fits()?;
        let triangles =
            |fit: &halfshade::shared::Fit| f64::from((fit.opaque_draw[0] + fit.masked_draw[0]) / 3);
        let with_casters = fits.iter().filter(|fit| fit.level_count > 0).count();
        Ok(Self {
            planned: fits.len(),
            with_receivers: fits.iter().filter(|fit| fit.receiver_count > 0).count(),
            with_casters,
            caster_triangles_mean: sum(fits.iter().map(triangles)) / with_casters.max(1) as f64,
            hierarchy_levels_max: fits.iter().map(|fit| fit.level_count).max().unwrap_or(0),
        })
    }
}
