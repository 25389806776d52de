//! The flags that studies share: what to try, and how to measure it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use halfshade::gpu::Gpu;
use halfshade::reference::ReferenceOptions;
use halfshade::shot::{Overrides, Shot};
use halfshade::study::{Protocol, Subject};
use halfshade::technique::Settings;
use halfshade::{Error, Result};

use super::super::calibration::Calibration;
use super::super::knob_args::SweepValues;
use super::super::{
    REPEAT, SAMPLES, parse_size, print_note, print_notes, progress, project_folders,
};

/// What to try. Values are separated by commas; a knob that a technique does not read multiplies nothing.
#[derive(Debug, clap::Args)]
pub struct SweepArgs {
    #[command(flatten)]
    values: SweepValues,
}

impl SweepArgs {
    /// # Errors
    /// A value is out of its range.
    pub fn check(&self) -> Result<()> {
        let sweep = self.values.sweep(&Calibration::default());
        sweep.settings().map(drop)
    }

    /// All settings to try; packets, mapping and leaf rule as calibrated where no flag names them. A flag that none of
    /// them reads is noted on stderr.
    ///
    /// # Errors
    /// As for [`Self::check`].
    pub fn settings(&self, calibration: &Calibration) -> Result<Vec<Settings>> {
        let mut all = self.values.sweep(calibration).settings()?;
        for settings in &mut all {
            settings.leaf = calibration.leaf;
            settings.mapping = calibration.mapping;
        }
        for flag in self.values.unread(&all) {
            print_note(&format!(
                "--{flag} is ignored, for none of the techniques reads it."
            ));
        }
        Ok(all)
    }
}

/// How to measure.
#[derive(Debug, clap::Args)]
pub struct ProtocolArgs {
    /// Size of the images in pixels, each side 1 to 32768 [default: the shots']
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<(u32, u32)>,
    /// Rays per pixel of the truth, 16 to 65536
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(SAMPLES))]
    pub samples: u32,
    /// Timed frames of each candidate, 1 to 10000, after one to warm up; candidates take turns
    #[arg(long, value_name = "N", default_value_t = 15, value_parser = clap::value_parser!(u32).range(REPEAT))]
    pub repeat: u32,
    /// Give a candidate no further frame after this wall time, but one to warm up and a timed one in any case
    #[arg(long, value_name = "S", default_value_t = 60.0)]
    seconds: f64,
    /// Folder of traced truths, by what they show [default: in the user's cache folder]
    #[arg(long, value_name = "FOLDER")]
    truths: Option<PathBuf>,
}

impl ProtocolArgs {
    /// # Errors
    /// A value is out of its range.
    pub fn check(&self) -> Result<()> {
        match self.seconds > 0.0 {
            true => Ok(()),
            false => Err(Error::Invalid("--seconds is more than 0".into())),
        }
    }

    pub fn protocol(
        &self,
        calibration: &Calibration,
        counters: bool,
        flicker_frames: u32,
    ) -> Protocol {
        Protocol {
            repeat: self.repeat,
            seconds: self.seconds,
            counters,
            flicker_frames,
            costs: calibration.costs(),
        }
    }

    /// A shot, with its notes on stderr.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn load(&self, file: &Path) -> Result<Shot> {
        let overrides = Overrides {
            size: self.size,
            ..Overrides::default()
        };
        let shot = Shot::load(file, &overrides)?;
        print_notes(&shot);
        Ok(shot)
    }

    /// A shot with its truth by `samples` rays per pixel, traced under a progress bar where it is not known yet.
    ///
    /// # Errors
    /// It cannot be traced, or was interrupted.
    pub fn subject(
        &self,
        file: &Path,
        shot: Shot,
        samples: u32,
        interrupted: &AtomicBool,
    ) -> Result<Subject> {
        let options = ReferenceOptions {
            samples,
            ..ReferenceOptions::default()
        };
        let cache = truths_folder(self.truths.as_deref())?;
        let bar = progress::bar("tracing the truth", 1000);
        let advance = |share: f64| bar.set_position((share * 1000.0) as u64);
        let name = Subject::name_of(file);
        let subject = Subject::of_shot(&name, file, shot, &cache, options, &advance, interrupted);
        bar.finish_and_clear();
        subject
    }
}

/// Where traced truths are kept: the folder that is named, else one in the user's cache folder.
///
/// # Errors
/// There is neither.
pub fn truths_folder(named: Option<&Path>) -> Result<PathBuf> {
    match (named, project_folders()) {
        (Some(folder), _) => Ok(folder.to_owned()),
        (None, Some(folders)) => Ok(folders.cache_dir().join("truths")),
        (None, None) => Err(Error::Invalid(
            "there is no home folder to keep traced truths in; name one with --truths".into(),
        )),
    }
}

/// What is known of a device, and the flag that Ctrl-C sets.
pub struct Setting {
    pub calibration: Calibration,
    pub interrupted: Arc<AtomicBool>,
}

impl Setting {
    /// # Errors
    /// Ctrl-C cannot be caught.
    pub fn new(gpu: &Gpu) -> Result<Self> {
        Ok(Self {
            calibration: Calibration::of(&gpu.info),
            interrupted: super::super::on_interrupt()?,
        })
    }
}
