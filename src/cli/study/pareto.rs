//! `halfshade study pareto`: sweeps techniques and settings over shots.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use halfshade::gpu::Gpu;
use halfshade::study::{Bench, Folder, Machine, Shard, Subject, front, key};
use halfshade::technique::Settings;
use halfshade::{Error, Result};
use indicatif::ProgressBar;

use super::super::given::Given;
use super::super::shot_args::DeviceArgs;
use super::super::{outputs, print, print_note, progress};
use super::sweep_args::{ProtocolArgs, Setting, SweepArgs};

/// Measures techniques and settings on shots: error against ray-traced truth, GPU time, memory.
///
/// The folder gets results.csv, results.json, pareto.svg, contact sheets and an index.html that shows them all.
/// Finished runs stay: interrupted and started again, a study goes on where it was.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Shot files
    #[arg(required = true, value_name = "SHOT")]
    shots: Vec<PathBuf>,
    /// The folder of the study, new or one to go on with
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,
    #[command(flatten)]
    sweep: SweepArgs,
    #[command(flatten)]
    protocol: ProtocolArgs,
    #[command(flatten)]
    device: DeviceArgs,
    /// Count nodes and samples as well, in a frame of its own
    #[arg(long)]
    counters: bool,
    /// Measure flicker over N frames in which the lights step aside by 1/256 of their width; 0: do not
    #[arg(long, value_name = "N", default_value_t = 0)]
    flicker: u32,
    /// Do only part I of N, counted from 0, such as 0/4; `study merge` joins the parts
    #[arg(long, value_name = "I/N", default_value = "0/1")]
    shard: Shard,
    /// Make tables, plot and page anew from the finished runs, and measure nothing
    #[arg(long)]
    report_only: bool,
}

/// # Errors
/// A flag's value is out of its range.
pub fn check(args: &Args) -> Result<()> {
    args.sweep.check()?;
    args.protocol.check()
}

/// # Errors
/// A shot cannot be read, the folder cannot be written, the device is lost, or Ctrl-C; finished runs stay.
pub fn run(args: &Args, given: &Given) -> Result<()> {
    let folder = Folder::open(&args.output)?;
    check_apart(&folder, &args.shots)?;
    if args.report_only {
        let idle = given
            .flags()
            .filter(|flag| !["output", "report-only"].contains(flag));
        idle.for_each(|flag| {
            print_note(&format!(
                "--{flag} is ignored, for --report-only measures nothing."
            ));
        });
    } else {
        args.device
            .with_device(|gpu| measure(args, gpu, &folder))
            .map_err(|error| match error {
                Error::Interrupted => Error::Invalid(format!(
                    "interrupted; the same command goes on from the {} runs that are in {}",
                    folder.runs().map_or(0, |runs| runs.len()),
                    args.output.display()
                )),
                error => error,
            })?;
    }
    report(&folder)
}

/// Refuses a folder that holds one of the files that are read where it writes its own.
fn check_apart(folder: &Folder, read: &[PathBuf]) -> Result<()> {
    let written = folder.files()?;
    outputs::check_read(written.iter().map(PathBuf::as_path), read)
}

fn measure(args: &Args, gpu: &Arc<Gpu>, folder: &Folder) -> Result<()> {
    let setting = Setting::new(gpu)?;
    let all = args.sweep.settings(&setting.calibration)?;
    let protocol = (args.protocol).protocol(&setting.calibration, args.counters, args.flicker);
    let bench = Bench::new(gpu, protocol, &setting.interrupted);
    let machine = Machine::of(gpu);
    let frames = u64::from(args.protocol.repeat) + 1;
    let subjects = subjects(args, folder, &setting.interrupted)?;
    let bar = progress::bar("measuring", (subjects.len() * all.len()) as u64 * frames);
    for (number, subject) in subjects.iter().enumerate() {
        let own = all.iter().enumerate().filter(|(index, settings)| {
            let known = folder.has(&key(&subject.content, &settings.flags(), &machine));
            args.shard.holds(number * all.len() + index) && !known
        });
        let own: Vec<Settings> = own.map(|(_, settings)| settings.clone()).collect();
        bar.set_position(((number + 1) * all.len() - own.len()) as u64 * frames);
        for group in bench.groups(subject, own) {
            measure_group(&bench, subject, &group, folder, &bar, frames)?;
        }
    }
    bar.finish_and_clear();
    Ok(())
}

/// The shots with their truths; all are read before the first is traced.
fn subjects(args: &Args, folder: &Folder, interrupted: &AtomicBool) -> Result<Vec<Subject>> {
    let mut shots = Vec::new();
    for file in &args.shots {
        let shot = args.protocol.load(file)?;
        check_apart(folder, &shot.scene.files)?;
        shots.push((file, shot));
    }
    let samples = args.protocol.samples;
    let traced = shots
        .into_iter()
        .map(|(file, shot)| args.protocol.subject(file, shot, samples, interrupted));
    traced.collect()
}

fn measure_group(
    bench: &Bench,
    subject: &Subject,
    group: &[Settings],
    folder: &Folder,
    bar: &ProgressBar,
    frames: u64,
) -> Result<()> {
    let start = bar.position();
    let tick = |label: &str| {
        bar.set_message(format!("{}: {label}", subject.name));
        bar.inc(1);
    };
    for (run, pictures) in bench.measure(subject, group, &tick)? {
        folder.keep(&run, pictures.as_ref())?;
    }
    bar.set_position(start + group.len() as u64 * frames);
    Ok(())
}

/// Makes the reports, and prints the fronts.
pub fn report(folder: &Folder) -> Result<()> {
    folder.report()?;
    let runs = folder.runs()?;
    let failed = runs.iter().filter(|run| run.measured().is_none()).count();
    let mut text = String::new();
    let mut shots: Vec<(&str, &str)> = Vec::new();
    for run in &runs {
        let shot = (run.content.as_str(), run.machine.device.as_str());
        if shots.contains(&shot) {
            continue;
        }
        shots.push(shot);
        text += &format!(
            "{} on {}: nothing is both faster and less wrong than\n  {:<52} {:>10} {:>10}\n",
            run.shot, run.machine.device, "", "MAE", "ms"
        );
        let peers = runs
            .iter()
            .filter(|other| (other.content.as_str(), other.machine.device.as_str()) == shot);
        for run in front(peers) {
            if let Some(measured) = run.measured() {
                text += &format!(
                    "  {:<52} {:>10.5} {:>10.2}\n",
                    run.label, measured.errors.metrics.mae_shadow, measured.shadow_ms.median
                );
            }
        }
    }
    text += &format!(
        "{} runs, {failed} of them failed; {}\n",
        runs.len(),
        folder.path().join("index.html").display()
    );
    print(&text)
}
