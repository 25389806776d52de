//! The shots that calibration measures, and their renderers.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use halfshade::calibrate::{Measured, race};
use halfshade::gpu::Gpu;
use halfshade::plan::Outputs;
use halfshade::render::{DEFAULT_EXPOSURE, Frame, RenderOptions, Renderer};
use halfshade::shot::{Overrides, Shot};
use halfshade::study::is_traversal;
use halfshade::technique::{Settings, Technique};
use halfshade::{Error, Result};
use indicatif::{ProgressBar, ProgressStyle};

use super::super::calibration::Calibration;
use super::super::print_notes;

/// Built-in shots: penumbrae of large casters, thin occluders, huge kernels.
const BUILT_IN: [&str; 3] = ["colonnade", "tree", "grid"];

/// [pixel] Width and height at which a built-in shot is tried; with `--quick` also measured.
const SIZE_PROBE: u32 = 64;
/// [pixel] Sizes to measure at: packets are the more coherent, the smaller the pixels.
const SIZE: u32 = 256;
const SIZE_FAST: u32 = 512;
/// [ms] Expected visibility time of a frame beyond which a built-in shot is left out.
const FRAME_MS_MAX: f64 = 1500.0;
/// [ms] Expected visibility time of a frame up to which a built-in shot is measured at the larger size.
const FRAME_MS_FAST: f64 = 300.0;

/// Kernels are as wide in texels as those of the default split 4 and map 512, since their width goes with
/// map / split, and a frame draws a sixteenth of the views.
const SPLIT: u32 = 1;
const MAP: u32 = 128;

/// Renders the shots with one candidate after the other.
pub struct Bench<'a> {
    gpu: &'a Arc<Gpu>,
    shots: Vec<Shot>,
    /// Built-in shots that are too slow here.
    left_out: Vec<&'static str>,
    /// By what pipelines are made for: a calibration less its costs.
    renderers: Vec<(Calibration, Vec<Renderer>)>,
    interrupted: &'a AtomicBool,
    bar: ProgressBar,
    start: Instant,
    budget: Duration,
}

impl<'a> Bench<'a> {
    /// `files` may be empty: the built-in shots. `budget`: when to stop trying further candidates.
    ///
    /// # Errors
    /// A shot cannot be read or rendered, or the device has no timestamps.
    pub fn new(
        gpu: &'a Arc<Gpu>,
        files: &[PathBuf],
        quick: bool,
        budget: Duration,
        interrupted: &'a AtomicBool,
    ) -> Result<Self> {
        // Drawn on stderr, and only where that is a terminal.
        let bar = ProgressBar::new(1000).with_style(style());
        bar.enable_steady_tick(Duration::from_millis(200));
        let mut bench = Self {
            gpu,
            shots: Vec::new(),
            left_out: Vec::new(),
            renderers: Vec::new(),
            interrupted,
            bar,
            start: Instant::now(),
            budget,
        };
        bench.say("choosing sizes");
        for file in files {
            let mut shot = Shot::load(file, &Overrides::default())?;
            print_notes(&shot);
            shot.settings = settings();
            bench.shots.push(shot);
        }
        if files.is_empty() {
            for name in BUILT_IN {
                match bench.sized(name, quick)? {
                    Some(shot) => bench.shots.push(shot),
                    None => bench.left_out.push(name),
                }
            }
        }
        Ok(bench)
    }

    /// A built-in shot, in a size that suits the device. None: it is too slow for the shot.
    fn sized(&self, name: &str, quick: bool) -> Result<Option<Shot>> {
        let pixelwise = Calibration {
            packet: (1, 1),
            ..Calibration::default()
        };
        let at = |size: u32| {
            let overrides = Overrides {
                size: Some((size, size)),
                ..Overrides::default()
            };
            let shot = Shot::built_in(name, &overrides)?;
            Ok::<_, Error>(Shot {
                settings: settings(),
                ..shot
            })
        };
        let probe = at(SIZE_PROBE)?;
        let mut renderer = self.renderer(&probe, &pixelwise)?;
        // The driver may compile in the first frame.
        self.frame_ms(&mut renderer)?;
        let ms = self.frame_ms(&mut renderer)?;
        let expected = |size: u32| ms * f64::from(size / SIZE_PROBE).powi(2);
        match quick {
            _ if expected(SIZE) > FRAME_MS_MAX && !self.shots.is_empty() => Ok(None),
            true => Ok(Some(probe)),
            false if expected(SIZE_FAST) <= FRAME_MS_FAST => at(SIZE_FAST).map(Some),
            false => at(SIZE).map(Some),
        }
    }

    fn renderer(&self, shot: &Shot, candidate: &Calibration) -> Result<Renderer> {
        let mut shot = shot.clone();
        shot.settings.packet = candidate.packet;
        shot.settings.leaf = candidate.leaf;
        shot.settings.mapping = candidate.mapping;
        let options = RenderOptions {
            outputs: Outputs { picture: false },
            costs: candidate.costs(),
            exposure: DEFAULT_EXPOSURE,
        };
        Renderer::new(self.gpu, &shot, options)
    }

    /// Makes ready to measure a candidate, unless something else with its pipelines has been before, and
    /// warms up.
    pub fn prepare(&mut self, candidate: &Calibration) -> Result<()> {
        let key = without_costs(candidate);
        if self.renderers.iter().any(|(known, _)| *known == key) {
            return Ok(());
        }
        let mut renderers = Vec::new();
        for shot in &self.shots {
            let mut renderer = self.renderer(shot, candidate)?;
            self.frame_ms(&mut renderer)?;
            renderers.push(renderer);
        }
        self.renderers.push((key, renderers));
        Ok(())
    }

    /// A race between candidates, which have been prepared; it ends early when `share` of the time is spent.
    pub fn race(
        &mut self,
        candidates: &[Calibration],
        rounds: usize,
        share: f64,
    ) -> Result<Vec<Measured<Calibration>>> {
        let (start, budget) = (self.start, self.budget.mul_f64(share));
        let goes_on = || start.elapsed() < budget;
        race(candidates, rounds, &goes_on, &mut |candidate| {
            self.measure(candidate)
        })
    }

    /// [ms] GPU time of `classify` and the visibility passes in a frame, the geometric mean over the shots.
    pub fn measure(&mut self, candidate: &Calibration) -> Result<f64> {
        let key = without_costs(candidate);
        let position = self.renderers.iter().position(|(known, _)| *known == key);
        let index = position.ok_or_else(|| Error::Invalid("a candidate is not prepared".into()))?;
        let mut renderers = std::mem::take(&mut self.renderers[index].1);
        let mut sum = 0.0;
        for renderer in &mut renderers {
            renderer.set_costs(candidate.costs())?;
            sum += self.frame_ms(renderer)?.ln();
        }
        let mean = (sum / renderers.len() as f64).exp();
        self.renderers[index].1 = renderers;
        Ok(mean)
    }

    fn frame_ms(&self, renderer: &mut Renderer) -> Result<f64> {
        if self.interrupted.load(Ordering::Relaxed) {
            return Err(Error::Invalid(
                "interrupted, the stored calibration is as it was".into(),
            ));
        }
        let ms = visibility_ms(&renderer.render()?)?;
        let spent = self.start.elapsed().as_secs_f64() / self.budget.as_secs_f64();
        self.bar.set_position((spent * 1000.0).min(1000.0) as u64);
        Ok(ms)
    }

    /// What is being done, beside the progress bar.
    pub fn say(&self, what: &'static str) {
        self.bar.set_message(what);
    }

    /// Whether no more than `share` [0, 1] of the time is spent.
    pub fn has_time(&self, share: f64) -> bool {
        self.start.elapsed() < self.budget.mul_f64(share)
    }

    /// The files that the shots were read from.
    pub fn files(&self) -> Vec<PathBuf> {
        let files = self.shots.iter().flat_map(|shot| &shot.scene.files);
        files.cloned().collect()
    }

    /// What is measured, a line.
    pub fn describe(&self) -> String {
        let sizes = (self.shots.iter())
            .map(|shot| format!("{}x{}", shot.width, shot.height))
            .collect::<Vec<_>>()
            .join(", ");
        let settings = &self.shots[0].settings;
        let left_out = match self.left_out.is_empty() {
            true => String::new(),
            false => format!("; too slow here: {}", self.left_out.join(", ")),
        };
        format!(
            "{} shot(s) ({sizes}), split {}, map {}{left_out}",
            self.shots.len(),
            settings.split,
            settings.map
        )
    }
}

impl Drop for Bench<'_> {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// The pipelines do not depend on the costs.
fn without_costs(candidate: &Calibration) -> Calibration {
    Calibration {
        edge_cost: 1.0,
        visibility_cost: 1.0,
        ..*candidate
    }
}

fn settings() -> Settings {
    Settings {
        technique: Technique::PacketContour,
        split: SPLIT,
        map: MAP,
        ..Settings::published(Technique::PacketContour)
    }
}

/// [ms] More than 0.
fn visibility_ms(frame: &Frame) -> Result<f64> {
    let ms = frame.timings.ms(is_traversal);
    match ms > 0.0 {
        true => Ok(ms),
        false => Err(Error::Unsupported(
            "nothing to calibrate: the device measures no time, or a shot has no shadow".into(),
        )),
    }
}

fn style() -> ProgressStyle {
    let template = "{msg:<24} {wide_bar} {percent:>3} % {eta:>6} left at most";
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}
