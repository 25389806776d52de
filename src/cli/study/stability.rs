//! `halfshade study stability`: stiff and extreme cases.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use halfshade::gpu::Gpu;
use halfshade::image::{check_writable, write_atomically};
use halfshade::study::stability::{Case, Finding, cases, csv, examine, summary, truth};
use halfshade::technique::{Settings, Technique};
use halfshade::{Error, Result};

use super::super::outputs::{self, Format, Output};
use super::super::shot_args::DeviceArgs;
use super::super::{on_interrupt, print, progress};

/// Runs techniques on stiff and extreme cases: touching occluders, tiny and huge lights and scenes, grazing surfaces,
/// degenerate triangles, closed bodies, odd sizes.
///
/// Prints for each technique and family of cases how many were unsound (not rendered, not finite, beyond [0, 1]), the
/// largest mean error against rays, speckles (pixels that differ from all neighbours by more than the truth does),
/// leaks (pixels with light where there is none) and, for techniques that integrate contours, the largest deviation
/// from the f64 twin, which integrates the same maps.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Techniques, separated by commas [default: all]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    techniques: Vec<Technique>,
    /// Only cases whose name or family has this in it
    #[arg(long, value_name = "TEXT")]
    case: Option<String>,
    /// Also maps of 4096 and 8192 texels
    #[arg(long)]
    large: bool,
    /// A row for each technique and case, written case by case
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Maps of `reference-maps`: it shows how hard shadows add up, not the truth.
const REFERENCE_MAPS: u32 = 64;

/// # Errors
/// No case has that name, or the table is not to be written where it is said.
pub fn check(args: &Args) -> Result<()> {
    let table = args.output.iter().map(|path| Output {
        flag: "-o",
        path,
        format: Format::Csv,
    });
    outputs::check(&table.collect::<Vec<_>>(), &[])?;
    match chosen(args).is_empty() {
        true => Err(Error::Invalid(
            "no case has that in its name or family".into(),
        )),
        false => Ok(()),
    }
}

fn chosen(args: &Args) -> Vec<Case> {
    let mut cases = cases(args.large);
    if let Some(text) = &args.case {
        cases.retain(|case| case.name.contains(text) || case.family.contains(text));
    }
    cases
}

/// # Errors
/// The device is lost, the file cannot be written, or Ctrl-C.
pub fn run(args: &Args) -> Result<()> {
    if let Some(file) = &args.output {
        check_writable(file)?;
    }
    let findings = args.device.with_device(|gpu| measure(args, gpu))?;
    print(&summary(&findings))
}

/// Writes the rows so far, so that a run that is interrupted leaves the cases that it has finished.
fn save(args: &Args, findings: &[Finding]) -> Result<()> {
    let Some(file) = &args.output else {
        return Ok(());
    };
    let table = csv(findings)?;
    write_atomically(file, |out| out.write_all(table.as_bytes()))
}

fn measure(args: &Args, gpu: &Arc<Gpu>) -> Result<Vec<Finding>> {
    let interrupted = on_interrupt()?;
    let cases = chosen(args);
    let techniques = match args.techniques.is_empty() {
        true => Technique::ALL,
        false => &args.techniques,
    };
    let bar = progress::bar("examining", (cases.len() * techniques.len()) as u64);
    let mut findings = Vec::new();
    for case in &cases {
        bar.set_message(case.name.clone());
        let truth = truth(case, &interrupted)?;
        for &technique in techniques {
            if interrupted.load(Ordering::Relaxed) {
                return Err(Error::Interrupted);
            }
            let settings = Settings {
                maps: REFERENCE_MAPS,
                ..Settings::usual(technique)
            };
            findings.push(examine(gpu, case, &truth, &settings)?);
            bar.inc(1);
        }
        save(args, &findings)?;
    }
    bar.finish_and_clear();
    Ok(findings)
}
