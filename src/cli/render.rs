//! `halfshade render`: the main job.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use halfshade::gpu::Gpu;
use halfshade::image::{Plane, RgbImage, check_writable, write_atomically, write_exr};
use halfshade::plan::{Outputs, suited_exposure};
use halfshade::render::{DEFAULT_EXPOSURE, RenderOptions, Renderer};
use halfshade::shared::Exposure;
use halfshade::shot::Shot;
use halfshade::{Error, Result};

use super::calibration::Calibration;
use super::given::Given;
use super::outputs::{self, Format, Output};
use super::shot_args::{DeviceArgs, ShotArgs};
use super::stats::Stats;
use super::time_limit::{TimeLimit, parse_seconds};
use super::{REPEAT, print_note, print_notes, progress};

/// Renders a shot: a shaded picture, the visibility of each light, and what it cost.
///
/// Visibility is the share of the light's area that the visible surface sees, 0 (umbra) to 1 (lit), and
/// NaN where there is no surface. Prints a line with the size, the device, the time and the memory.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    shot: ShotArgs,
    #[command(flatten)]
    device: DeviceArgs,
    /// The shaded picture to write
    #[arg(short, long, value_name = "FILE.png")]
    output: Option<PathBuf>,
    /// The visibility to write, 32-bit float: channel Y, or with several lights one each (Y0, Y1, …)
    #[arg(long, value_name = "FILE.exr")]
    visibility: Option<PathBuf>,
    /// Write only this light's visibility, counted from 0, as channel Y [default: all lights]
    #[arg(long, value_name = "N")]
    light: Option<usize>,
    /// Times in ms, memory in bytes and, with --counters, counts to write
    #[arg(long, value_name = "FILE.json")]
    stats: Option<PathBuf>,
    /// Timed frames, 1 to 10000, after one to warm up; each draws its shadow maps anew
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(REPEAT))]
    repeat: u32,
    /// Brightness of the picture in stops, each of which doubles it, or auto: what suits lights in candela, lux and nit, else 0
    #[arg(
        long,
        value_name = "EV",
        default_value = "auto",
        value_parser = parse_exposure,
        allow_hyphen_values = true
    )]
    exposure: Stops,
    /// Constant light from everywhere, 0 or more, so that umbrae are dark rather than black
    #[arg(long, value_name = "RADIANCE", default_value_t = DEFAULT_EXPOSURE.ambient)]
    ambient: f32,
    /// Longest that rendering may take, loading and building of pipelines included [default: as long as it takes]
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    max_seconds: Option<Duration>,
}

/// What a run has made. It is written when the device is closed and the validation layer has had its
/// last word.
struct Products {
    picture: Option<RgbImage>,
    visibility: Option<Vec<(String, Plane)>>,
    stats: Stats,
}

/// # Errors
/// A flag's value is out of its range, or nothing is to be written, or not where it is said.
pub fn check(args: &Args) -> Result<()> {
    args.shot.check()?;
    if !args.ambient.is_finite() || args.ambient < 0.0 {
        return Err(Error::Invalid(
            "--ambient must be finite and not negative".into(),
        ));
    }
    let outputs = args.outputs();
    if outputs.is_empty() {
        return Err(Error::Invalid(
            "nothing to write: give -o, --visibility or --stats".into(),
        ));
    }
    outputs::check(&outputs, &[&args.shot.shot])
}

/// # Errors
/// When the shot can't be read or rendered or a file can't be written; then no unfinished file is left.
pub fn run(args: &Args, given: &Given) -> Result<()> {
    let outputs = args.outputs();
    outputs
        .iter()
        .try_for_each(|output| check_writable(output.path))?;
    let limit = args.max_seconds.map(TimeLimit::start);
    let products = args.device.with_device(|gpu| render(args, given, gpu))?;
    drop(limit);
    products.write(args)?;
    super::print(&format!("{}\n", products.stats.summary()))
}

impl Args {
    fn outputs(&self) -> Vec<Output<'_>> {
        let all = [
            ("-o", &self.output, Format::Png),
            ("--visibility", &self.visibility, Format::Exr),
            ("--stats", &self.stats, Format::Json),
        ];
        let named = all.into_iter().filter_map(|(flag, path, format)| {
            let path = path.as_deref()?;
            Some(Output { flag, path, format })
        });
        named.collect()
    }

    /// A note on each flag that is for an output which is not asked for.
    fn idle_flags(&self, given: &Given) -> Vec<String> {
        let all = [
            ("light", "--visibility", self.visibility.is_some()),
            ("exposure", "-o", self.output.is_some()),
            ("ambient", "-o", self.output.is_some()),
            ("counters", "--stats", self.stats.is_some()),
        ];
        let idle = all
            .into_iter()
            .filter(|(flag, _, asked)| given.has(flag) && !asked);
        idle.map(|(flag, output, _)| {
            format!("--{flag} is ignored, for it is about {output}, which is not given.")
        })
        .collect()
    }
}

fn render(args: &Args, given: &Given, gpu: &Arc<Gpu>) -> Result<Products> {
    let calibration = Calibration::of(&gpu.info);
    let mut shot = args.shot.load(&calibration, given)?;
    shot.notes.extend(args.idle_flags(given));
    print_notes(&shot);
    let written = args.outputs().into_iter().map(|output| output.path);
    outputs::check_read(written, &shot.scene.files)?;
    if let Some(light) = args.light.filter(|&light| light >= shot.lights.len()) {
        return Err(Error::Invalid(format!(
            "there is no light {light}: the shot has {}, counted from 0",
            shot.lights.len()
        )));
    }
    let options = RenderOptions {
        outputs: Outputs {
            picture: args.output.is_some(),
        },
        costs: calibration.costs(),
        exposure: Exposure {
            scale: exposure(args, &mut shot),
            ambient: args.ambient,
            light_count: 0,
        },
    };
    let mut renderer = progress::spin("building pipelines", || Renderer::new(gpu, &shot, options))?;
    let stats = timed_frames(args, gpu, &mut shot, &mut renderer)?;
    let picture = args.output.as_ref().map(|_| renderer.picture());
    let visibility = (args.visibility.as_ref()).map(|_| planes(args.light, &shot, &renderer));
    Ok(Products {
        picture: picture
            .transpose()?
            .map(|rgba| RgbImage::from_rgba(shot.width, shot.height, &rgba)),
        visibility: visibility.transpose()?,
        stats,
    })
}

/// \[stop\] None: what suits the shot.
type Stops = Option<f32>;

fn parse_exposure(text: &str) -> std::result::Result<Stops, String> {
    match text.parse::<f32>() {
        _ if text == "auto" => Ok(None),
        Ok(stops) if stops.abs() < 128.0 => Ok(Some(stops)),
        _ => Err("an exposure is auto, or a number of stops between -128 and 128".into()),
    }
}

/// Factor on radiance; notes what was chosen for lights in physical units.
fn exposure(args: &Args, shot: &mut Shot) -> f32 {
    let Some(stops) = args.exposure else {
        let suited = suited_exposure(shot);
        if args.output.is_some() && shot.physical {
            let note = format!(
                "The lights are in candela, lux or nit; the picture is exposed by {:.1} stops (--exposure says otherwise).",
                suited.log2()
            );
            print_note(&note);
            shot.notes.push(note);
        }
        return suited;
    };
    stops.exp2()
}

fn timed_frames(
    args: &Args,
    gpu: &Arc<Gpu>,
    shot: &mut Shot,
    renderer: &mut Renderer,
) -> Result<Stats> {
    // Without timing, the first frame is the only one.
    let warm_up = args.stats.is_some() || args.repeat > 1;
    let mut frames = Vec::new();
    let rounds = args.repeat + u32::from(warm_up);
    let bar = progress::bar("rendering", u64::from(rounds));
    for round in 0..rounds {
        renderer.invalidate();
        let before = renderer.counters()?;
        let frame = renderer.render()?;
        if round > 0 || !warm_up {
            frames.push((frame, before));
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    for note in renderer.notes()? {
        print_note(&note);
        shot.notes.push(note);
    }
    Stats::new(gpu, shot, renderer, &frames, shot.settings.counters)
}

/// The visibility of one light or of all, by the name of its channel.
fn planes(light: Option<usize>, shot: &Shot, renderer: &Renderer) -> Result<Vec<(String, Plane)>> {
    let lights: Vec<usize> =
        light.map_or_else(|| (0..shot.lights.len()).collect(), |light| vec![light]);
    let (width, height) = (shot.width as usize, shot.height as usize);
    let alone = lights.len() == 1;
    let plane = |light| {
        let name = if alone {
            "Y".into()
        } else {
            format!("Y{light}")
        };
        let plane = Plane::new(width, height, renderer.visibility(light)?)?;
        Ok((name, plane))
    };
    lights.into_iter().map(plane).collect()
}

impl Products {
    fn write(&self, args: &Args) -> Result<()> {
        if let (Some(file), Some(picture)) = (&args.output, &self.picture) {
            picture.write(file)?;
        }
        if let (Some(file), Some(planes)) = (&args.visibility, &self.visibility) {
            let channels: Vec<(&str, &Plane)> = planes
                .iter()
                .map(|(name, plane)| (name.as_str(), plane))
                .collect();
            write_exr(file, &channels)?;
        }
        if let Some(file) = &args.stats {
            let text = serde_json::to_string_pretty(&self.stats)
                .map_err(|error| Error::Invalid(error.to_string()))?;
            write_atomically(file, |out| writeln!(out, "{text}"))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use clap::Parser;

    use super::*;
    use crate::faults::{self, with_fault};
    use crate::slow;

    #[derive(clap::Parser)]
    struct Program {
        #[command(flatten)]
        render: Args,
    }

    /// Names and contents of all files in a folder.
    fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
        let entries = std::fs::read_dir(folder).expect("the folder is there");
        let paths = entries.map(|entry| entry.expect("it can be listed").path());
        let mut files: Vec<_> = paths
            .map(|path| {
                let bytes = std::fs::read(&path).expect("it can be read");
                (path, bytes)
            })
            .collect();
        files.sort();
        files
    }

    /// Whichever call fails, no file appears and none changes. `HALFSHADE_SLOW=1` fails every call.
    #[test]
    fn a_failure_leaves_no_file() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = |name: &str| folder.path().join(name).display().to_string();
        let shot = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/plate.json");
        let (picture, visibility, stats) = (file("a.png"), file("a.exr"), file("a.json"));
        let arguments = [
            "render",
            shot,
            "--technique",
            "hard",
            "--size",
            "16x16",
            "--map",
            "16",
            "-o",
            &picture,
            "--visibility",
            &visibility,
            "--stats",
            &stats,
        ];
        let mut program = Program::parse_from(arguments);
        program.render.device.loader = Some(faults::loader);
        let given = Given::default();
        let (result, called) = with_fault(None, || run(&program.render, &given));
        result.expect("nothing failed");
        assert_eq!(contents(folder.path()).len(), 3);
        for name in ["a.exr", "a.json"] {
            std::fs::remove_file(file(name)).expect("it is there");
        }
        std::fs::write(&picture, "old").expect("it can be written");
        let before = contents(folder.path());
        // A picture without a cache is as good.
        let fatal = |&index: &usize| called[index] != "vkCreatePipelineCache";
        let step = slow::cases(16, 1) as usize;
        for index in (0..called.len()).filter(fatal).step_by(step) {
            let (result, _) = with_fault(Some(index), || run(&program.render, &given));
            let (error, name) = (result.expect_err("it failed").to_string(), called[index]);
            assert!(error.contains(name), "{name} failed, not: {error}");
            assert!(contents(folder.path()) == before, "{name}, call {index}");
        }
    }
}
