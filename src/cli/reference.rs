//! `halfshade reference`: ray-traced ground truth.

use std::path::PathBuf;
use std::time::Instant;

use halfshade::image::{check_writable, write_exr};
use halfshade::number::sum;
use halfshade::reference::{BATCHES, ReferenceImage, ReferenceOptions, trace};
use halfshade::scene::AreaLight;
use halfshade::shot::Shot;
use halfshade::{Error, Result};

use super::given::Given;
use super::load_args::LoadArgs;
use super::outputs::{self, Format, Output};
use super::{SAMPLES, on_interrupt, print, print_notes, progress};

/// Traces the true visibility of a light with rays, on the CPU.
///
/// Writes three channels: Y (visibility), facing (share of the light in front of the surface) and
/// stderr (standard error of Y).
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A shot file (.json), or a .gltf or .glb with a camera and a light
    shot: PathBuf,
    /// The image to write
    #[arg(short, long, value_name = "FILE.exr")]
    output: PathBuf,
    /// Shadow rays per pixel, 16 to 65536, rounded up to a multiple of 8
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(SAMPLES))]
    samples: u32,
    /// Another seed gives independent noise, the same seed the same image
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    seed: u64,
    /// Which of the shot's lights, counted from 0
    #[arg(long, value_name = "N", default_value_t = 0)]
    light: usize,
    #[command(flatten)]
    load: LoadArgs,
}

/// # Errors
/// The image is not to be written where it is said.
pub fn check(args: &Args) -> Result<()> {
    outputs::check(&[args.written()], &[&args.shot])
}

impl Args {
    fn written(&self) -> Output<'_> {
        Output {
            flag: "-o",
            path: &self.output,
            format: Format::Exr,
        }
    }
}

/// # Errors
/// When the shot cannot be read or traced, when the image cannot be written, or on Ctrl-C; then no
/// file is left.
pub fn run(args: &Args, given: &Given) -> Result<()> {
    check_writable(&args.output)?;
    let overrides = args.load.overrides();
    let mut shot = progress::spin("loading", || Shot::load(&args.shot, &overrides))?;
    if shot.lights.get(args.light).is_some_and(AreaLight::is_point) {
        let idle = given
            .flags()
            .filter(|flag| ["samples", "seed"].contains(flag));
        shot.notes.extend(idle.map(|flag| {
            format!("--{flag} is ignored, for one ray decides about a light without extent.")
        }));
    }
    print_notes(&shot);
    outputs::check_read([&*args.output], &shot.scene.files)?;
    let cancel = on_interrupt()?;
    let start = Instant::now();
    let options = ReferenceOptions {
        samples: args.samples,
        seed: args.seed,
    };
    let bar = progress::bar("tracing", 1000);
    let advance = |share: f64| bar.set_position((share * 1000.0) as u64);
    let traced = trace(&shot, args.light, options, &advance, &cancel);
    bar.finish_and_clear();
    let image = traced.map_err(|error| match error {
        Error::Interrupted => Error::Invalid(format!(
            "interrupted, {} was not written",
            args.output.display()
        )),
        error => error,
    })?;
    let channels = [
        ("Y", &image.visibility),
        ("facing", &image.facing),
        ("stderr", &image.standard_error),
    ];
    write_exr(&args.output, &channels)?;
    print(&summary(args, &image, start.elapsed().as_secs_f64()))
}

fn summary(args: &Args, image: &ReferenceImage, seconds: f64) -> String {
    let errors: Vec<f64> = (image.standard_error.data.iter())
        .filter(|error| !error.is_nan())
        .map(|&error| f64::from(error))
        .collect();
    let squares = sum(errors.iter().map(|error| error * error));
    let root_mean_square = (squares / errors.len().max(1) as f64).sqrt();
    let largest = errors.iter().copied().fold(0.0, f64::max);
    let samples = args.samples.next_multiple_of(BATCHES);
    format!(
        "{}: {}×{} pixels, {samples} rays each, in {seconds:.1} s; standard error {root_mean_square:.5} \
         (root mean square over {} pixels with a surface), at most {largest:.5}\n",
        args.output.display(),
        image.visibility.width,
        image.visibility.height,
        errors.len()
    )
}
