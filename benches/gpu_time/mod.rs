//! Criterion on the GPU's clock: a measurement whose values are GPU times of passes, and a record of each benchmark
//! with the device that it ran on.

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use criterion::measurement::{Measurement, ValueFormatter};
use criterion::{Bencher, BenchmarkGroup, Criterion, SamplingMode, Throughput};
use halfshade::gpu::{Gpu, Options};
use halfshade::plan::Outputs;
use halfshade::render::{DEFAULT_COSTS, DEFAULT_EXPOSURE, RenderOptions, Renderer};
use halfshade::shot::{Overrides, Shot};
use halfshade::spread::Spread;
use halfshade::study::Machine;
use halfshade::technique::Settings;

/// The file of every benchmark that was measured, a JSON object a line; criterion's own reports do not know the device.
fn records() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("criterion/records.jsonl")
}

/// GPU time in milliseconds.
pub struct GpuTime;

impl Measurement for GpuTime {
    type Intermediate = ();
    type Value = f64;

    /// Frames report their own times, so there is no clock to start: benchmarks use `iter_custom`.
    fn start(&self) {}

    fn end(&self, (): ()) -> f64 {
        0.0
    }

    fn add(&self, a: &f64, b: &f64) -> f64 {
        a + b
    }

    fn zero(&self) -> f64 {
        0.0
    }

    fn to_f64(&self, ms: &f64) -> f64 {
        *ms
    }

    fn formatter(&self) -> &dyn ValueFormatter {
        &Milliseconds
    }
}

struct Milliseconds;

impl ValueFormatter for Milliseconds {
    fn scale_values(&self, typical: f64, values: &mut [f64]) -> &'static str {
        let (factor, unit) = match typical {
            ms if ms < 1.0 => (1e3, "µs"),
            ms if ms < 1e3 => (1.0, "ms"),
            _ => (1e-3, "s"),
        };
        values.iter_mut().for_each(|value| *value *= factor);
        unit
    }

    /// No benchmark states a throughput.
    fn scale_throughputs(&self, _: f64, _: &Throughput, values: &mut [f64]) -> &'static str {
        self.scale_for_machines(values)
    }

    fn scale_for_machines(&self, _: &mut [f64]) -> &'static str {
        "ms"
    }
}

/// Criterion with the GPU's clock, and settings that suit frames.
pub fn criterion() -> Criterion<GpuTime> {
    Criterion::default()
        .with_measurement(GpuTime)
        .sample_size(15)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2))
        .configure_from_args()
}

/// Opens the device that `HALFSHADE_DEVICE` names a part of, or the best there is, and says which it is.
pub fn open() -> Arc<Gpu> {
    let options = Options {
        device: std::env::var("HALFSHADE_DEVICE").ok(),
        ..Options::default()
    };
    let gpu = Gpu::open(&options).unwrap_or_else(|error| panic!("{error}"));
    let machine = Machine::of(&gpu);
    eprintln!(
        "{} ({}), {}, subgroups of {}, commit {}; records in {}",
        machine.device,
        machine.device_kind,
        machine.driver,
        machine.subgroup_size,
        machine.commit,
        records().display()
    );
    gpu
}

/// A shot of `scenes/`.
pub fn shot(name: &str, size: u32) -> Shot {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.json"));
    let overrides = Overrides {
        size: Some((size, size)),
        ..Overrides::default()
    };
    Shot::load(&file, &overrides).unwrap_or_else(|error| panic!("{error}"))
}

/// A renderer without a picture, which nobody measures here, that has rendered a frame: drivers compile in the first.
pub fn renderer(gpu: &Arc<Gpu>, shot: &Shot, settings: Settings) -> Renderer {
    let shot = Shot {
        settings,
        ..shot.clone()
    };
    let options = RenderOptions {
        outputs: Outputs { picture: false },
        costs: DEFAULT_COSTS,
        exposure: DEFAULT_EXPOSURE,
    };
    let mut renderer = Renderer::new(gpu, &shot, options).unwrap_or_else(|error| panic!("{error}"));
    frame_ms(&mut renderer, |_| true);
    renderer
}

/// Benchmarks the GPU time of the passes that `counts`, and records it. The renderer is made, and its pipelines
/// compiled, only if the command line's filter lets the benchmark run.
pub fn bench(
    group: &mut BenchmarkGroup<GpuTime>,
    gpu: &Arc<Gpu>,
    id: &str,
    bytes: fn(&Renderer) -> u64,
    counts: fn(&str) -> bool,
    renderer: impl Fn() -> Renderer,
) {
    group.sampling_mode(SamplingMode::Flat);
    let mut ready: Option<Renderer> = None;
    let mut times = Vec::new();
    group.bench_function(id, |bencher: &mut Bencher<GpuTime>| {
        let renderer = ready.get_or_insert_with(&renderer);
        bencher.iter_custom(|frames| {
            let frames = (0..frames).map(|_| frame_ms(renderer, counts));
            let frames: Vec<f64> = frames.collect();
            times.extend(&frames);
            frames.iter().sum()
        });
    });
    if let Some(renderer) = &ready {
        record(gpu, id, &times, bytes(renderer));
    }
}

fn frame_ms(renderer: &mut Renderer, counts: fn(&str) -> bool) -> f64 {
    renderer.invalidate();
    let frame = renderer.render().unwrap_or_else(|error| panic!("{error}"));
    frame.timings.ms(counts)
}

/// Adds a line to the records; the frames that warm up are among `times`.
fn record(gpu: &Gpu, id: &str, times: &[f64], bytes: u64) {
    let line = serde_json::json!({
        "benchmark": id,
        "frames": times.len(),
        "gpu_ms": Spread::of(times.iter().copied()),
        "bytes": bytes,
        "machine": Machine::of(gpu),
    });
    let file = records();
    let written = fs::create_dir_all(file.parent().unwrap_or(&file))
        .and_then(|()| OpenOptions::new().create(true).append(true).open(&file))
        .and_then(|mut file| writeln!(file, "{line}"));
    if let Err(error) = written {
        eprintln!("{} cannot be written: {error}", file.display());
    }
}
