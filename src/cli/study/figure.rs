//! `halfshade study figure`: what the publications measured, measured here.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use halfshade::shot::{Overrides, Shot};
use halfshade::study::figure::{Experiment, Lab, NamedShot, Report, Scale, Trials, list};
use halfshade::{Error, Result};

use super::super::shot_args::DeviceArgs;
use super::super::{REPEAT, on_interrupt, outputs, print, print_notes, progress};
use super::sweep_args::truths_folder;

/// Repeats a figure or table of a publication as near as can be, and says whether its claim is found here.
///
/// Without a name it lists them all.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Name of the figure, such as yang09-fig9
    name: Option<String>,
    /// Shot files for equal-texels [default: built-in ones]; the others bring their own scenes
    #[arg(value_name = "SHOT")]
    shots: Vec<PathBuf>,
    /// List all figures
    #[arg(long, conflicts_with_all = ["name", "output", "quick", "paper"])]
    list: bool,
    /// Also write NAME.csv, NAME.json and NAME.svg into a folder
    #[arg(short, long, value_name = "FOLDER", requires = "name")]
    output: Option<PathBuf>,
    /// Small and few, in seconds, to see that it works
    #[arg(long, conflicts_with = "paper", requires = "name")]
    quick: bool,
    /// The paper's sizes where they are known: for a GPU
    #[arg(long, requires = "name")]
    paper: bool,
    /// Timed frames of each candidate, 1 to 10000, after one to warm up [default: the figure's]
    #[arg(long, value_name = "N", requires = "name", value_parser = clap::value_parser!(u32).range(REPEAT))]
    repeat: Option<u32>,
    /// Folder of traced truths, by what they show [default: in the user's cache folder]
    #[arg(long, value_name = "FOLDER", requires = "name")]
    truths: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// # Errors
/// There is no such figure, or it takes no shots.
pub fn check(args: &Args) -> Result<()> {
    match &args.name {
        Some(name) => Experiment::find(name)?.check_shots(args.shots.len()),
        None => Ok(()),
    }
}

/// # Errors
/// A shot cannot be read, a file cannot be written, the device is lost, or Ctrl-C.
pub fn run(args: &Args) -> Result<()> {
    let Some(name) = &args.name else {
        return print(&list());
    };
    let scale = match (args.quick, args.paper) {
        (true, _) => Scale::Quick,
        (_, true) => Scale::Paper,
        _ => Scale::Usual,
    };
    let shots: Vec<NamedShot> = args
        .shots
        .iter()
        .map(|file| named_shot(file))
        .collect::<Result<_>>()?;
    let experiment = Experiment::find(name)?;
    if let Some(folder) = &args.output {
        let written = experiment.files(folder);
        for named in &shots {
            let read = &named.shot.scene.files;
            outputs::check_read(written.iter().map(PathBuf::as_path), read)?;
        }
    }
    let trials = experiment.trials(scale, &shots)?;
    let report = measure(args, &trials)?;
    if let Some(folder) = &args.output {
        report.write(folder)?;
    }
    print(&report.text())
}

fn named_shot(file: &Path) -> Result<NamedShot> {
    let shot = Shot::load(file, &Overrides::default())?;
    print_notes(&shot);
    Ok(NamedShot {
        name: file.display().to_string(),
        shot,
    })
}

fn measure(args: &Args, trials: &Trials) -> Result<Report> {
    let truths = truths_folder(args.truths.as_deref())?;
    let interrupted = on_interrupt()?;
    let bar = progress::bar(trials.experiment.name, 1000);
    let shown = bar.clone();
    let report = args.device.with_device(|gpu| {
        trials.measure(&Lab {
            gpu,
            truths,
            frames: args.repeat,
            command: command(),
            interrupted: &interrupted,
            progress: &|share, what| {
                shown.set_message(format!("{}: {what}", trials.experiment.name));
                shown.set_position((share * 1000.0) as u64);
            },
        })
    });
    bar.finish_and_clear();
    report.map_err(|error| match error {
        Error::Interrupted => Error::Invalid(
            "interrupted; truths that were traced are kept, the rest starts anew".into(),
        ),
        error => error,
    })
}

/// The command line, to be kept with the results.
fn command() -> String {
    let words = std::env::args_os().skip(1);
    let words: Vec<OsString> = std::iter::once("halfshade".into()).chain(words).collect();
    words.join(" ".as_ref()).to_string_lossy().into_owned()
}
