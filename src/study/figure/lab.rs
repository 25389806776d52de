//! Measures the trials of an experiment.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::gpu::Gpu;
use crate::plan::Outputs;
use crate::reference::ReferenceOptions;
use crate::render::{DEFAULT_COSTS, DEFAULT_EXPOSURE, RenderOptions, Renderer};
use crate::shot::Shot;
use crate::spread::Spread;
use crate::technique::Settings;
use crate::{Error, Result};

use super::super::bench::{Bench, Protocol};
use super::super::flicker::all_lights;
use super::super::run::Machine;
use super::super::subject::Subject;
use super::busy::Busy;
use super::check::number;
use super::report::Report;
use super::{Experiment, Row, Scale, Trial, Truth};

/// [s] The wall time after which a candidate gets no further frame but its first timed one.
const SECONDS: [f64; 3] = [30.0, 30.0, 60.0];

/// Where and with what to measure.
pub struct Lab<'a> {
    pub gpu: &'a Arc<Gpu>,
    /// Folder of traced truths.
    pub truths: PathBuf,
    /// Timed frames in place of the experiment's own number.
    pub frames: Option<u32>,
    /// The command line that measures this again.
    pub command: String,
    /// Ends the work when it is set.
    pub interrupted: &'a AtomicBool,
    /// Called with the share that is done, and what is being done.
    pub progress: &'a (dyn Fn(f64, &str) + Sync),
}

/// An experiment at a scale.
#[derive(Debug)]
pub struct Trials {
    pub experiment: &'static Experiment,
    pub scale: Scale,
    pub trials: Vec<Trial>,
}

impl Trials {
    /// Measures all of it with the default cost model, whatever the device's calibration, so that it can be repeated.
    /// A candidate that fails is a row without figures.
    ///
    /// # Errors
    /// A truth cannot be traced, the device is lost, or interrupted.
    pub fn measure(&self, lab: &Lab) -> Result<Report> {
        let experiment = self.experiment;
        let [quick, usual, paper] = SECONDS;
        let protocol = Protocol {
            repeat: lab
                .frames
                .unwrap_or(self.scale.pick(1, experiment.frames, experiment.frames)),
            seconds: self.scale.pick(quick, usual, paper),
            counters: experiment.counters,
            flicker_frames: 0,
            costs: DEFAULT_COSTS,
        };
        let bench = Bench::new(lab.gpu, protocol, lab.interrupted);
        let busy = Busy::watch();
        let mut rows = Vec::new();
        let mut off: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        for (index, trial) in self.trials.iter().enumerate() {
            let part = |share: f64| (index as f64 + share) / self.trials.len() as f64;
            let (subject, rays_off) = lab.subject(trial, &|share| {
                (lab.progress)(part(0.5 * share), &trial.scene);
            })?;
            let progress = |share| (lab.progress)(part(0.5 + 0.5 * share), &trial.scene);
            rows.extend(lab.rows(&bench, protocol, trial, &subject, &progress)?);
            off.entry(trial.scene.clone()).or_default().extend(rays_off);
        }
        Ok(Report {
            experiment,
            scale: self.scale,
            command: lab.command.clone(),
            machine: Machine::of(lab.gpu),
            frames: protocol.repeat,
            others: busy.others(),
            checks: experiment.judge(&rows),
            rows,
            notes: off.iter().filter_map(closed_form).collect(),
        })
    }
}

/// Says of a scene's truth that it is a closed form, if it is.
fn closed_form((scene, off): (&String, &Vec<f64>)) -> Option<String> {
    let spread = Spread::of(off.iter().copied());
    (!off.is_empty()).then(|| {
        format!(
            "{scene}: the truth is the closed form; rays are {} to {} off it on the mean over shadow pixels",
            number(spread.min),
            number(spread.max)
        )
    })
}

impl Lab<'_> {
    /// A trial's shot with its truth, and how far rays are off it where it has a closed form.
    fn subject(
        &self,
        trial: &Trial,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<(Subject, Option<f64>)> {
        let options = ReferenceOptions {
            samples: trial.samples,
            ..ReferenceOptions::default()
        };
        let mut subject = Subject::of_shot(
            &trial.scene,
            Path::new(&trial.scene),
            trial.shot.clone(),
            &self.truths,
            options,
            progress,
            self.interrupted,
        )?;
        let rays_off = trial.truth.apply(&mut subject)?;
        if let Truth::Rendered(settings) = &trial.truth {
            subject.visibility.data = self.rendered(trial, settings)?;
        }
        Ok((subject, rays_off))
    }

    /// The visibility of a trial's lights by other settings, one below the other.
    fn rendered(&self, trial: &Trial, settings: &Settings) -> Result<Vec<f32>> {
        let shot = Shot {
            settings: settings.clone(),
            ..trial.shot.clone()
        };
        let options = RenderOptions {
            outputs: Outputs { picture: false },
            costs: DEFAULT_COSTS,
            exposure: DEFAULT_EXPOSURE,
        };
        let mut renderer = Renderer::new(self.gpu, &shot, options)?;
        renderer.render()?;
        all_lights(&renderer, shot.lights.len())
    }

    fn rows(
        &self,
        bench: &Bench,
        protocol: Protocol,
        trial: &Trial,
        subject: &Subject,
        progress: &dyn Fn(f64),
    ) -> Result<Vec<Row>> {
        let settings = trial.candidates.iter();
        let settings: Vec<Settings> = settings
            .map(|candidate| candidate.settings.clone())
            .collect();
        let frames = (settings.len() as u32 * (protocol.repeat + 1)).max(1);
        let done = Cell::new(0);
        let tick = |_: &str| {
            progress(f64::from(done.get()) / f64::from(frames));
            done.set(done.get() + 1);
        };
        let mut runs = Vec::new();
        for group in bench.groups(subject, settings) {
            runs.extend(bench.measure(subject, &group, &tick)?);
        }
        if runs.len() != trial.candidates.len() {
            return Err(Error::Invalid(format!(
                "{}: {} of {} candidates were measured",
                trial.scene,
                runs.len(),
                trial.candidates.len()
            )));
        }
        let rows = runs.into_iter().zip(&trial.candidates);
        Ok(rows
            .map(|((mut run, _), candidate)| {
                run.command = self.command.clone();
                Row {
                    scene: trial.scene.clone(),
                    series: candidate.series.clone(),
                    x: candidate.x,
                    run,
                }
            })
            .collect())
    }
}
