//! A run: what was measured, and everything that is needed to repeat it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::compare::Metrics;
use crate::gpu::{Gpu, Timings};
use crate::spread::Spread;
use crate::technique::Settings;

/// Passes that rasterise; all others compute, copy or clear.
const RASTER: [&str; 4] = ["gbuffer", "pick_sample", "shadow_map", "peel"];

/// Passes that a frame without shadows has as well.
const SHARED: [&str; 2] = ["gbuffer", "shade"];

/// One technique with its settings on one shot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Name of the shot's file without its ending.
    pub shot: String,
    /// As given on the command line.
    pub shot_file: String,
    /// Hash of all that the shot shows: scene, camera, lights, size.
    pub content: String,
    /// [pixel]
    pub size: (u32, u32),
    /// The settings by name.
    pub label: String,
    pub settings: Settings,
    /// The command that renders this image.
    pub command: String,
    /// Rays per pixel of the truth.
    pub truth_samples: u32,
    pub machine: Machine,
    pub outcome: Outcome,
}

/// Where and with what a run was measured.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    pub device: String,
    /// "cpu" marks a software driver: its times are no GPU's.
    pub device_kind: String,
    pub driver: String,
    pub subgroup_size: u32,
    /// Of halfshade.
    pub version: String,
    /// That was built; "+" = with changes.
    pub commit: String,
}

impl Machine {
    pub fn of(gpu: &Gpu) -> Self {
        Self {
            device: gpu.info.name.clone(),
            device_kind: gpu.info.kind.into(),
            driver: gpu.info.driver.clone(),
            subgroup_size: gpu.info.subgroup_size,
            version: env!("CARGO_PKG_VERSION").into(),
            commit: env!("HALFSHADE_COMMIT").into(),
        }
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    Measured(Box<Measured>),
    /// Why it could not be rendered.
    Failed(String),
}

/// What a run cost, and how far it is from the truth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Timed frames.
    pub frames: usize,
    /// False in runs of older versions whose only frame has the driver's compiling in it.
    pub warm: bool,
    /// [ms] Everything that a frame without shadows has not: maps, structures, traversal, resolve.
    pub shadow_ms: Spread,
    /// [ms] The passes that integrate visibility.
    pub visibility_ms: Spread,
    /// [ms] Shadow passes that rasterise, and those that do not.
    pub raster_ms: Spread,
    pub compute_ms: Spread,
    /// [ms] The whole frame.
    pub total_ms: Spread,
    /// [ms] By pass, its sum in a frame.
    pub passes: BTreeMap<String, Spread>,
    /// [byte] Peak of the device memory.
    pub memory_bytes: u64,
    /// [byte] Of each resource.
    #[serde(default)]
    pub resources: BTreeMap<String, u64>,
    pub errors: Errors,
    /// Empty unless asked for.
    pub counters: BTreeMap<String, u64>,
}

/// Error of the visibility over pixels that face the whole light, and of the picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    #[serde(flatten)]
    pub metrics: Metrics,
    /// Mean absolute error over all shadow pixels, those too that face a part of the light only; None in runs of older
    /// versions.
    #[serde(default)]
    pub mae_shadow_all: Option<f64>,
    /// [0, 1] Mean FLIP of the shaded picture.
    pub flip: f64,
    /// See `flicker`; None unless asked for.
    pub flicker: Option<f64>,
}

impl Run {
    pub fn measured(&self) -> Option<&Measured> {
        match &self.outcome {
            Outcome::Measured(measured) => Some(measured),
            Outcome::Failed(_) => None,
        }
    }
}

/// [ms] Sums over the passes of each frame, and their spread over the frames.
pub(super) struct Times<'a>(pub &'a [Timings]);

impl Times<'_> {
    pub fn of(&self, counts: impl Fn(&str) -> bool) -> Spread {
        Spread::of(self.0.iter().map(|frame| frame.ms(&counts)))
    }

    pub fn by_pass(&self) -> BTreeMap<String, Spread> {
        let names = self.0.iter().flat_map(|frame| &frame.passes);
        let mut passes = BTreeMap::new();
        for (name, _) in names {
            if !passes.contains_key(name) {
                passes.insert(name.clone(), self.of(|other| other == name));
            }
        }
        passes
    }
}

pub(super) fn is_shadow(pass: &str) -> bool {
    !SHARED.contains(&pass)
}

pub(super) fn is_raster(pass: &str) -> bool {
    is_shadow(pass) && RASTER.contains(&pass)
}

pub(super) fn is_compute(pass: &str) -> bool {
    is_shadow(pass) && !RASTER.contains(&pass)
}

/// Whether a pass integrates visibility.
pub fn is_visibility(pass: &str) -> bool {
    pass.contains("visibility")
}

/// Whether a pass is part of what packets change: sorting pixels into lists, and visibility.
pub fn is_traversal(pass: &str) -> bool {
    pass == "classify" || is_visibility(pass)
}
