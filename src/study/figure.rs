//! Figures and tables of the publications as experiments: what they claim, what is measured here in their place, and
//! a verdict that is worked out from the numbers.

mod atty06;
mod atty06_costs;
mod atty06_format;
mod busy;
mod check;
mod equal_texels;
mod kirsch03;
mod lab;
mod plot;
mod report;
mod row;
mod schwarz08;
mod schwarz08_quality;
mod schwarz08_samples;
mod stage;
mod truth;
mod yang09;
mod yang09_packets;

use std::path::{Path, PathBuf};

use crate::shot::Shot;
use crate::technique::Settings;
use crate::{Error, Result};

pub use busy::Busy;
pub use check::{Check, Verdict};
pub use lab::{Lab, Trials};
pub use report::{Report, list};
pub use row::{Column, Curve, Row};
pub use truth::Truth;

/// A figure or table, and what is run in its place.
#[derive(Debug)]
pub struct Experiment {
    pub name: &'static str,
    /// The publication and what in it.
    pub source: &'static str,
    /// What was measured there, on what.
    pub paper: &'static str,
    /// What it says came out.
    pub claim: &'static str,
    /// What is run here.
    pub here: &'static str,
    /// What of it cannot be run, and why; empty: nothing is missing.
    pub missing: &'static str,
    /// Why the results may differ from the paper's.
    pub differs: &'static str,
    /// What `Row::x` is.
    pub abscissa: &'static str,
    pub columns: &'static [Column],
    /// Timed frames of each candidate, after one to warm up.
    pub frames: u32,
    /// Whether nodes and samples are counted.
    pub counters: bool,
    /// Whether it runs on shots of the user's.
    pub takes_shots: bool,
    /// What is measured at a scale, on these shots if it takes any.
    trials: fn(Scale, &[NamedShot]) -> Result<Vec<Trial>>,
    /// What the rows say about the claim.
    judge: fn(&[Row]) -> Vec<Check>,
}

/// How large an experiment is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scale {
    /// In seconds, to see that it works; the numbers mean little.
    Quick,
    /// In minutes on a CPU driver.
    Usual,
    /// In the paper's sizes where they are known, for a GPU.
    Paper,
}

impl Scale {
    /// The value for this scale.
    fn pick<T>(self, quick: T, usual: T, paper: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Usual => usual,
            Self::Paper => paper,
        }
    }
}

/// A shot and what it is called.
#[derive(Debug, Clone)]
pub struct NamedShot {
    pub name: String,
    pub shot: Shot,
}

/// A shot, and the candidates that are measured on it in turns.
#[derive(Debug, Clone)]
pub struct Trial {
    pub scene: String,
    pub shot: Shot,
    pub truth: Truth,
    /// Rays per pixel.
    pub samples: u32,
    pub candidates: Vec<Candidate>,
}

/// A point of a curve.
#[derive(Debug, Clone)]
pub struct Candidate {
    pub series: String,
    pub x: f64,
    pub settings: Settings,
}

impl Candidate {
    fn new(series: impl Into<String>, x: f64, settings: Settings) -> Self {
        Self {
            series: series.into(),
            x,
            settings,
        }
    }
}

/// All experiments, by publication.
pub static EXPERIMENTS: [Experiment; 19] = [
    yang09::FIG8,
    yang09::FIG9,
    yang09::FIG11,
    yang09_packets::FIG12,
    yang09_packets::FIG13,
    schwarz08_quality::FIG7,
    schwarz08_quality::FIG8,
    schwarz08_samples::FIG9,
    schwarz08::TABLE1,
    schwarz08_quality::TABLE2,
    atty06_format::FIG14,
    atty06::FIG17,
    atty06::FIG18,
    atty06::FIG19,
    atty06::FIG20,
    atty06_costs::FIG22,
    atty06_costs::FIG24,
    kirsch03::TABLE1,
    equal_texels::EQUAL_TEXELS,
];

impl Experiment {
    /// # Errors
    /// There is none of this name.
    pub fn find(name: &str) -> Result<&'static Self> {
        let found = EXPERIMENTS.iter().find(|known| known.name == name);
        found.ok_or_else(|| {
            let names: Vec<&str> = EXPERIMENTS.iter().map(|known| known.name).collect();
            Error::Invalid(format!(
                "there is no figure {name:?}; choose one of {}",
                names.join(", ")
            ))
        })
    }

    /// What the rows say about the claim.
    pub fn judge(&self, rows: &[Row]) -> Vec<Check> {
        (self.judge)(rows)
    }

    /// # Errors
    /// There are shots and it takes none.
    pub fn check_shots(&self, count: usize) -> Result<()> {
        match count == 0 || self.takes_shots {
            true => Ok(()),
            false => Err(Error::Invalid(format!(
                "{} brings its own scenes; leave out the shots",
                self.name
            ))),
        }
    }

    /// Its files in a folder: table, everything, and plot.
    pub fn files(&self, folder: &Path) -> [PathBuf; 3] {
        ["csv", "json", "svg"].map(|ending| folder.join(format!("{}.{ending}", self.name)))
    }

    /// What is measured at a scale.
    ///
    /// # Errors
    /// There are shots and it takes none, or one cannot be made.
    pub fn trials(&'static self, scale: Scale, shots: &[NamedShot]) -> Result<Trials> {
        self.check_shots(shots.len())?;
        Ok(Trials {
            experiment: self,
            scale,
            trials: (self.trials)(scale, shots)?,
        })
    }
}
