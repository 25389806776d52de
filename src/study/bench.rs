//! Measures settings on a subject: candidates in turns, so that drift of the machine hits all alike.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use crate::calibrate::turns;
use crate::compare::{compare, compare_pictures, heatmap};
use crate::gpu::{Gpu, Timings};
use crate::image::{Plane, RgbImage};
use crate::plan::{Outputs, plan};
use crate::render::{DEFAULT_EXPOSURE, RenderOptions, Renderer};
use crate::shared::{Costs, Counters};
use crate::shot::Shot;
use crate::technique::Settings;
use crate::{Error, Result};

use super::flicker::{all_lights, flicker};
use super::run::{
    Errors, Machine, Measured, Outcome, Run, Times, is_compute, is_raster, is_shadow, is_visibility,
};
use super::subject::Subject;

/// How to measure.
#[derive(Debug, Clone, Copy)]
pub struct Protocol {
    /// Timed frames of each candidate, ≥ 1, after one to warm up.
    pub repeat: u32,
    /// [s] A candidate that has used this much wall time gets no further frame but its first timed one.
    pub seconds: f64,
    /// Whether to count nodes and samples, in a frame of its own.
    pub counters: bool,
    /// Frames of the animation that measures flicker; 0 = it is not measured.
    pub flicker_frames: u32,
    pub costs: Costs,
}

/// Candidates that are measured in turns at most; what they measured is lost when interrupted.
const GROUP: usize = 8;
/// The share of the device's memory that a group may take.
const GROUP_MEMORY: f64 = 0.5;

/// What a run looks like, for contact sheets.
#[derive(Debug, Clone)]
pub struct Pictures {
    pub picture: RgbImage,
    /// Its error, as in [`heatmap`]; lights one below the other.
    pub error: RgbImage,
}

/// Measures on one device.
pub struct Bench<'a> {
    gpu: &'a Arc<Gpu>,
    protocol: Protocol,
    interrupted: &'a AtomicBool,
}

/// A candidate that has rendered a frame, which the driver may have compiled shaders in: it is not timed.
struct Warm {
    /// Index among the settings of the group.
    index: usize,
    renderer: Renderer,
    frames: Vec<Timings>,
    /// [s] Wall time spent.
    spent: f64,
    errors: Errors,
    pictures: Pictures,
}

impl Warm {
    /// Whether it has a time, and has used up its wall time [s].
    fn is_spent(&self, seconds: f64) -> bool {
        !self.frames.is_empty() && self.spent > seconds
    }
}

impl<'a> Bench<'a> {
    pub fn new(gpu: &'a Arc<Gpu>, protocol: Protocol, interrupted: &'a AtomicBool) -> Self {
        Self {
            gpu,
            protocol,
            interrupted,
        }
    }

    fn options(&self) -> RenderOptions {
        RenderOptions {
            outputs: Outputs { picture: true },
            costs: self.protocol.costs,
            exposure: DEFAULT_EXPOSURE,
        }
    }

    /// Cuts candidates into groups that fit into memory together and are measured in turns.
    pub fn groups(&self, subject: &Subject, settings: Vec<Settings>) -> Vec<Vec<Settings>> {
        let budget = (self.gpu.limits.memory_bytes as f64 * GROUP_MEMORY) as u64;
        let mut groups: Vec<Vec<Settings>> = Vec::new();
        let mut bytes = 0;
        for settings in settings {
            let shot = with_settings(&subject.shot, &settings);
            // What cannot be planned takes no memory: it fails.
            let planned = plan(&shot, self.options().outputs, &self.gpu.limits);
            let own = planned.map_or(0, |plan| plan.memory_bytes());
            match groups.last_mut() {
                Some(group) if group.len() < GROUP && bytes + own <= budget => {
                    group.push(settings);
                    bytes += own;
                }
                _ => {
                    groups.push(vec![settings]);
                    bytes = own;
                }
            }
        }
        groups
    }

    /// Measures a group, a run for each of its settings in their order; a candidate that fails is a run that says so.
    /// `tick` is called before each frame with the name of its candidate.
    ///
    /// # Errors
    /// Interrupted, or the device is lost.
    pub fn measure(
        &self,
        subject: &Subject,
        settings: &[Settings],
        tick: &dyn Fn(&str),
    ) -> Result<Vec<(Run, Option<Pictures>)>> {
        let mut outcomes: BTreeMap<usize, Outcome> = BTreeMap::new();
        let mut warm = Vec::new();
        for (index, candidate) in settings.iter().enumerate() {
            self.check_interrupted()?;
            tick(&candidate.label());
            match self.warm_up(subject, index, candidate) {
                Ok(ready) => warm.push(ready),
                Err(error) if error.is_device_lost() => return Err(error),
                Err(error) => {
                    outcomes.insert(index, Outcome::Failed(error.to_string()));
                }
            }
        }
        self.take_turns(&mut warm, &mut outcomes, settings, tick)?;
        let mut pictures = BTreeMap::new();
        for ready in warm {
            let index = ready.index;
            if outcomes.contains_key(&index) {
                continue;
            }
            let (outcome, seen) = match self.finished(subject, &settings[index], ready) {
                Ok((measured, seen)) => (Outcome::Measured(Box::new(measured)), Some(seen)),
                Err(error) => (Outcome::Failed(error.to_string()), None),
            };
            outcomes.insert(index, outcome);
            pictures.insert(index, seen);
        }
        let runs = outcomes.into_iter().map(|(index, outcome)| {
            let run = self.run(subject, &settings[index], outcome);
            (run, pictures.remove(&index).flatten())
        });
        Ok(runs.collect())
    }

    fn warm_up(&self, subject: &Subject, index: usize, settings: &Settings) -> Result<Warm> {
        let start = Instant::now();
        let shot = with_settings(&subject.shot, settings);
        let mut renderer = Renderer::new(self.gpu, &shot, self.options())?;
        renderer.render()?;
        let spent = start.elapsed().as_secs_f64();
        let (errors, pictures) = judge(subject, &mut renderer)?;
        Ok(Warm {
            index,
            renderer,
            frames: Vec::new(),
            spent,
            errors,
            pictures,
        })
    }

    /// Renders the timed frames, at least one for each candidate. Who has failed has an outcome.
    fn take_turns(
        &self,
        warm: &mut [Warm],
        outcomes: &mut BTreeMap<usize, Outcome>,
        settings: &[Settings],
        tick: &dyn Fn(&str),
    ) -> Result<()> {
        for round in 0..self.protocol.repeat as usize {
            for turn in turns(round, warm.len()) {
                let ready = &mut warm[turn];
                if ready.is_spent(self.protocol.seconds) || outcomes.contains_key(&ready.index) {
                    continue;
                }
                self.check_interrupted()?;
                tick(&settings[ready.index].label());
                let start = Instant::now();
                ready.renderer.invalidate();
                match ready.renderer.render() {
                    Ok(frame) => ready.frames.push(frame.timings),
                    Err(error) if error.is_device_lost() => return Err(error),
                    Err(error) => {
                        outcomes.insert(ready.index, Outcome::Failed(error.to_string()));
                    }
                }
                ready.spent += start.elapsed().as_secs_f64();
            }
        }
        Ok(())
    }

    /// What a candidate has measured; counters and flicker are seen to now.
    fn finished(
        &self,
        subject: &Subject,
        settings: &Settings,
        mut ready: Warm,
    ) -> Result<(Measured, Pictures)> {
        if self.protocol.flicker_frames > 0 {
            let frames = self.protocol.flicker_frames;
            let value = flicker(self.gpu, subject, settings, frames, self.options())?;
            ready.errors.flicker = Some(value);
        }
        let counters = match self.protocol.counters {
            true => self.count(subject, settings)?,
            false => BTreeMap::new(),
        };
        let times = Times(&ready.frames);
        let plan = ready.renderer.plan();
        let resources = plan.memory();
        let resources = resources.map(|(name, bytes)| (name.to_owned(), bytes));
        let measured = Measured {
            frames: ready.frames.len(),
            warm: true,
            shadow_ms: times.of(is_shadow),
            visibility_ms: times.of(is_visibility),
            raster_ms: times.of(is_raster),
            compute_ms: times.of(is_compute),
            total_ms: times.of(|_| true),
            passes: times.by_pass(),
            memory_bytes: plan.memory_bytes(),
            resources: resources.collect(),
            errors: ready.errors,
            counters,
        };
        Ok((measured, ready.pictures))
    }

    /// Counting takes time, so a frame of its own counts.
    fn count(&self, subject: &Subject, settings: &Settings) -> Result<BTreeMap<String, u64>> {
        let mut shot = with_settings(&subject.shot, settings);
        shot.settings.counters = true;
        let mut renderer = Renderer::new(self.gpu, &shot, self.options())?;
        renderer.render()?;
        let counts = renderer.counters()?.since(&Counters::default());
        let counts = counts.into_iter().map(|(name, count)| (name.into(), count));
        Ok(counts.collect())
    }

    fn run(&self, subject: &Subject, settings: &Settings, outcome: Outcome) -> Run {
        let shot = &subject.shot;
        let (file, width, height) = (&subject.file, shot.width, shot.height);
        Run {
            shot: subject.name.clone(),
            shot_file: file.clone(),
            content: subject.content.clone(),
            size: (width, height),
            label: settings.label(),
            settings: settings.clone(),
            command: format!(
                "halfshade render {file} --size {width}x{height} {}",
                settings.flags().join(" ")
            ),
            truth_samples: subject.truth_samples,
            machine: Machine::of(self.gpu),
            outcome,
        }
    }

    fn check_interrupted(&self) -> Result<()> {
        match self.interrupted.load(Ordering::Relaxed) {
            true => Err(Error::Interrupted),
            false => Ok(()),
        }
    }
}

fn with_settings(shot: &Shot, settings: &Settings) -> Shot {
    Shot {
        settings: settings.clone(),
        ..shot.clone()
    }
}

/// How far the last frame is from the truth, and what it looks like.
fn judge(subject: &Subject, renderer: &mut Renderer) -> Result<(Errors, Pictures)> {
    let (width, height) = renderer.plan().size;
    let truth = &subject.visibility;
    let seen = all_lights(renderer, subject.shot.lights.len())?;
    let visibility = Plane::new(truth.width, truth.height, seen)?;
    let picture = RgbImage::from_rgba(width, height, &renderer.picture()?);
    let ideal = RgbImage::from_rgba(width, height, &renderer.picture_of(&truth.data)?);
    let metrics = compare(&visibility, truth, Some(&subject.facing))?;
    let errors = Errors {
        metrics,
        mae_shadow_all: Some(compare(&visibility, truth, None)?.mae_shadow),
        flip: compare_pictures(&picture, &ideal)?.0.flip,
        flicker: None,
    };
    let error = RgbImage {
        width: truth.width as u32,
        height: truth.height as u32,
        rgb8: heatmap(&visibility, truth, Some(&subject.facing))?,
    };
    Ok((errors, Pictures { picture, error }))
}
