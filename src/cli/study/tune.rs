//! `halfshade study tune`: the settings to use.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use halfshade::gpu::Gpu;
use halfshade::reference::SAMPLES;
use halfshade::study::{Bench, Goal, Protocol, Run, Subject, best};
use halfshade::technique::Settings;
use halfshade::{Error, Result};

use super::super::shot_args::DeviceArgs;
use super::super::{print, print_note, progress};
use super::sweep_args::{ProtocolArgs, Setting, SweepArgs};

/// Finds the fastest settings within an error, or the least wrong within a time, and prints the command to use.
///
/// All candidates are measured shortly; those that reach the goal and are best then race against each other.
#[derive(Debug, clap::Args)]
#[command(group = clap::ArgGroup::new("goal").required(true))]
pub struct Args {
    /// A shot file
    shot: PathBuf,
    /// The largest mean absolute error of the visibility over shadow pixels that will do, such as 0.02
    #[arg(long, value_name = "E", group = "goal")]
    max_error: Option<f64>,
    /// The longest that the shadow passes may take on this device, in ms
    #[arg(long, value_name = "T", group = "goal")]
    max_ms: Option<f64>,
    #[command(flatten)]
    sweep: SweepArgs,
    #[command(flatten)]
    protocol: ProtocolArgs,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Timed frames of the first look at each candidate.
const LOOKS: u32 = 2;
/// Candidates that race in the end.
const FINALISTS: usize = 6;

/// # Errors
/// A flag's value is out of its range.
pub fn check(args: &Args) -> Result<()> {
    goal(args)?;
    args.sweep.check()?;
    args.protocol.check()
}

/// # Errors
/// The shot cannot be read or rendered, no settings reach the goal, or Ctrl-C.
pub fn run(args: &Args) -> Result<()> {
    let goal = goal(args)?;
    let runs = args.device.with_device(|gpu| measure(args, gpu, goal))?;
    print(&written(&runs, goal)?)
}

fn goal(args: &Args) -> Result<Goal> {
    let (flag, limit, goal) = match (args.max_error, args.max_ms) {
        (Some(error), _) => ("--max-error", error, Goal::MaxError(error)),
        (None, ms) => {
            let ms = ms.unwrap_or_default();
            ("--max-ms", ms, Goal::MaxMs(ms))
        }
    };
    match limit > 0.0 {
        true => Ok(goal),
        false => Err(Error::Invalid(format!("{flag} is more than 0"))),
    }
}

/// Runs of the finalists, or of all candidates if none of them reaches the goal.
fn measure(args: &Args, gpu: &Arc<Gpu>, goal: Goal) -> Result<Vec<Run>> {
    let setting = Setting::new(gpu)?;
    let all = args.sweep.settings(&setting.calibration)?;
    let protocol = args.protocol.protocol(&setting.calibration, false, 0);
    let subject = subject(args, goal, &setting.interrupted)?;
    let look = |repeat, settings| {
        let protocol = Protocol { repeat, ..protocol };
        let bench = Bench::new(gpu, protocol, &setting.interrupted);
        measure_all(&bench, &subject, settings, u64::from(repeat) + 1)
    };
    let looked = look(LOOKS.min(args.protocol.repeat), all)?;
    let finalists: Vec<Settings> = best(&looked, goal)
        .into_iter()
        .take(FINALISTS)
        .map(|run| run.settings.clone())
        .collect();
    if finalists.is_empty() {
        return Ok(looked);
    }
    look(args.protocol.repeat, finalists)
}

/// The shot with a truth whose own noise is below the error that is asked for, if any number of rays gives that.
fn subject(args: &Args, goal: Goal, interrupted: &AtomicBool) -> Result<Subject> {
    let shot = args.protocol.load(&args.shot)?;
    let mut samples = args.protocol.samples;
    loop {
        let file = &args.shot;
        let subject = (args.protocol).subject(file, shot.clone(), samples, interrupted)?;
        let noise = subject.noise();
        let Goal::MaxError(limit) = goal else {
            return Ok(subject);
        };
        if noise < limit {
            return Ok(subject);
        }
        let reached = format!(
            "the truth's own noise with {samples} rays a pixel, {noise:.1e}, reaches the error asked for"
        );
        if samples == *SAMPLES.end() {
            print_note(&format!(
                "{reached}, and there are no more; that error cannot be told."
            ));
            return Ok(subject);
        }
        samples = more_samples(samples, noise / limit);
        print_note(&format!("{reached}; it is traced with {samples}."));
    }
}

/// Rays per pixel that bring a noise of `excess` ≥ 1 times what is asked for to half of that, as a random walk would
/// need them; at least twice as many as before.
fn more_samples(samples: u32, excess: f64) -> u32 {
    let needed = f64::from(samples) * (2.0 * excess).powi(2);
    // Beyond u32 it is the largest of them.
    let needed = (needed.ceil() as u32).max(samples.saturating_mul(2));
    needed.min(*SAMPLES.end())
}

fn measure_all(
    bench: &Bench,
    subject: &Subject,
    settings: Vec<Settings>,
    frames: u64,
) -> Result<Vec<Run>> {
    let bar = progress::bar("measuring", settings.len() as u64 * frames);
    let mut runs = Vec::new();
    for group in bench.groups(subject, settings) {
        let tick = |label: &str| {
            bar.set_message(label.to_owned());
            bar.inc(1);
        };
        let measured = bench.measure(subject, &group, &tick)?;
        runs.extend(measured.into_iter().map(|(run, _)| run));
    }
    bar.finish_and_clear();
    Ok(runs)
}

/// The finalists as a table, and the command.
fn written(runs: &[Run], goal: Goal) -> Result<String> {
    let reached = best(runs, goal);
    let Some(first) = reached.first() else {
        return Err(out_of_reach(runs, goal));
    };
    let mut text = format!("{:<52} {:>10} {:>10}\n", "", "MAE", "ms");
    for run in &reached {
        text += &line(run);
    }
    Ok(text + "\nuse: " + &first.command + "\n")
}

fn line(run: &Run) -> String {
    run.measured().map_or_else(String::new, |measured| {
        format!(
            "{:<52} {:>10.5} {:>10.2}\n",
            run.label, measured.errors.metrics.mae_shadow, measured.shadow_ms.median
        )
    })
}

/// Says how near to the goal anything comes.
fn out_of_reach(runs: &[Run], goal: Goal) -> Error {
    let other = match goal {
        Goal::MaxError(_) => Goal::MaxMs(f64::INFINITY),
        Goal::MaxMs(_) => Goal::MaxError(f64::INFINITY),
    };
    let (what, nearest) = match (
        goal,
        best(runs, other)
            .first()
            .and_then(|run| Some((run, run.measured()?))),
    ) {
        (_, None) => return Error::Invalid("none of the candidates could be rendered".into()),
        (Goal::MaxError(limit), Some((run, measured))) => (
            format!("an error of {limit}"),
            format!(
                "{:.5}, by {}",
                measured.errors.metrics.mae_shadow, run.label
            ),
        ),
        (Goal::MaxMs(limit), Some((run, measured))) => (
            format!("{limit} ms"),
            format!("{:.2} ms, by {}", measured.shadow_ms.median, run.label),
        ),
    };
    Error::Invalid(format!(
        "nothing that was tried reaches {what}; the nearest is {nearest}; try other --maps, --splits or --techniques"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_rays_are_as_many_as_noise_asks_for() {
        assert_eq!(more_samples(16, 1.0), 64);
        assert_eq!(more_samples(1000, 2.0), 16000);
        assert_eq!(more_samples(16, 1e6), *SAMPLES.end());
        assert_eq!(more_samples(*SAMPLES.end() - 8, 1.0), *SAMPLES.end());
        assert_eq!(more_samples(16, f64::INFINITY), *SAMPLES.end());
    }
}
