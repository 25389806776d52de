//! `halfshade render`: the main job.

use std::path::PathBuf;
use std::sync::Arc;

use halfshade::gpu::Gpu;
use halfshade::image::{Plane, check_writable, write_atomically, write_exr, write_png};
use halfshade::plan::Outputs;
use halfshade::render::{DEFAULT_EXPOSURE, RenderOptions, Renderer};
use halfshade::shared::Exposure;
use halfshade::shot::Shot;
use halfshade::{Error, Result};
use indicatif::ProgressBar;

use super::calibration::Calibration;
use super::shot_args::{DeviceArgs, ShotArgs};
use super::stats::Stats;

/// Renders a shot: a shaded picture, the visibility of each light, and what it cost.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    shot: ShotArgs,
    #[command(flatten)]
    device: DeviceArgs,
    /// The shaded picture to write
    #[arg(short, long, value_name = "FILE.png")]
    output: Option<PathBuf>,
    /// The visibility to write: channel Y, or one channel per light (Y0, Y1, …)
    #[arg(long, value_name = "FILE.exr")]
    visibility: Option<PathBuf>,
    /// Write only this light's visibility, counted from 0
    #[arg(long, value_name = "N")]
    light: Option<usize>,
    /// Times, memory and, with --counters, counts to write
    #[arg(long, value_name = "FILE.json")]
    stats: Option<PathBuf>,
    /// Timed frames, after one to warm up; each draws its shadow maps anew
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10000))]
    repeat: u32,
    /// Factor on the picture's brightness, as a power of two
    #[arg(
        long,
        value_name = "EV",
        default_value_t = 0.0,
        allow_hyphen_values = true
    )]
    exposure: f32,
    /// Constant light from everywhere, so that umbrae are dark rather than black
    #[arg(long, value_name = "RADIANCE", default_value_t = DEFAULT_EXPOSURE.ambient)]
    ambient: f32,
}

/// # Errors
/// When the shot can't be read or rendered or a file can't be written; then no file is left.
pub fn run(args: &Args) -> Result<()> {
    if args.output.is_none() && args.visibility.is_none() && args.stats.is_none() {
        return Err(Error::Invalid(
            "nothing to write: give -o, --visibility or --stats".into(),
        ));
    }
    let files = [&args.output, &args.visibility, &args.stats];
    files
        .into_iter()
        .flatten()
        .try_for_each(|file| check_writable(file))?;
    if !args.exposure.is_finite() || !args.ambient.is_finite() || args.ambient < 0.0 {
        return Err(Error::Invalid(
            "--exposure and --ambient must be finite, --ambient not negative".into(),
        ));
    }
    args.device.with_device(|gpu| render(args, gpu))
}

fn render(args: &Args, gpu: &Arc<Gpu>) -> Result<()> {
    let calibration = Calibration::of(&gpu.info);
    let shot = args.shot.load(&calibration)?;
    if let Some(light) = args.light.filter(|&light| light >= shot.lights.len()) {
        return Err(Error::Invalid(format!(
            "there is no light {light}: the shot has {}",
            shot.lights.len()
        )));
    }
    let options = RenderOptions {
        outputs: Outputs {
            picture: args.output.is_some(),
        },
        costs: calibration.costs(),
        exposure: Exposure {
            scale: args.exposure.exp2(),
            ambient: args.ambient,
            light_count: 0,
        },
    };
    let mut renderer = Renderer::new(gpu, &shot, options)?;
    let stats = timed_frames(args, gpu, &shot, &mut renderer)?;
    if let Some(file) = &args.output {
        write_png(file, shot.width, shot.height, &rgb_of(&renderer.picture()?))?;
    }
    if let Some(file) = &args.visibility {
        write_visibility(file, args.light, &shot, &renderer)?;
    }
    if let Some(file) = &args.stats {
        let text = serde_json::to_string_pretty(&stats)
            .map_err(|error| Error::Invalid(error.to_string()))?;
        write_atomically(file, |out| writeln!(out, "{text}"))?;
    }
    super::print(&format!("{}\n", stats.summary()))
}

fn timed_frames(
    args: &Args,
    gpu: &Arc<Gpu>,
    shot: &Shot,
    renderer: &mut Renderer,
) -> Result<Stats> {
    // Without timing, the first frame is the only one.
    let warm_up = args.stats.is_some() || args.repeat > 1;
    let mut frames = Vec::new();
    let bar = ProgressBar::new(u64::from(args.repeat));
    for round in 0..args.repeat + u32::from(warm_up) {
        renderer.invalidate()?;
        let before = renderer.counters()?;
        let frame = renderer.render()?;
        if round > 0 || !warm_up {
            frames.push((frame, before));
            bar.inc(1);
        }
    }
    bar.finish_and_clear();
    Stats::new(gpu, shot, renderer, &frames, args.shot.counters)
}

fn write_visibility(
    file: &std::path::Path,
    light: Option<usize>,
    shot: &Shot,
    renderer: &Renderer,
) -> Result<()> {
    let lights: Vec<usize> =
        light.map_or_else(|| (0..shot.lights.len()).collect(), |light| vec![light]);
    let mut planes = Vec::new();
    for &light in &lights {
        let name = if lights.len() == 1 {
            "Y".to_owned()
        } else {
            format!("Y{light}")
        };
        planes.push((
            name,
            Plane::new(
                shot.width as usize,
                shot.height as usize,
                renderer.visibility(light)?,
            )?,
        ));
    }
    let channels: Vec<(&str, &Plane)> = planes
        .iter()
        .map(|(name, plane)| (name.as_str(), plane))
        .collect();
    write_exr(file, &channels)
}

fn rgb_of(rgba: &[u8]) -> Vec<u8> {
    rgba.chunks_exact(4)
        .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
        .collect()
}
