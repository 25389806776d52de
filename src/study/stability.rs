//! Stiff and extreme cases: what each technique does where numbers get large, small or equal.
//!
//! Every case is a small shot, made here, whose truth is traced with rays in f64. Looked for: values that are not
//! finite or beyond [0, 1], pixels that stand out from all their neighbours, and how far the image is off.

mod cases;
mod stage;
mod twin;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use serde::Serialize;

use super::table;
use crate::Result;
use crate::compare::{compare, faces_wholly};
use crate::gpu::Gpu;
use crate::image::Plane;
use crate::plan::Outputs;
use crate::reference::{ReferenceImage, ReferenceOptions, trace};
use crate::render::{DEFAULT_COSTS, DEFAULT_EXPOSURE, RenderOptions, Renderer};
use crate::shot::Shot;
use crate::technique::Settings;

pub use cases::cases;
pub use stage::Case;

/// Rays per pixel of the truth.
const SAMPLES: u32 = 1024;
/// By how much more than the truth does a pixel differ from all its neighbours to be a speckle: the truth's own noise
/// is below a tenth of it.
const SPECKLE: f32 = 0.05;

/// What a technique did on a case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    pub family: &'static str,
    pub case: String,
    /// The settings by name.
    pub label: String,
    /// Why it was not rendered.
    pub failure: Option<String>,
    /// [pixel] With a surface whose value is not finite.
    pub non_finite: usize,
    /// [pixel] With a value below 0 or above 1.
    pub out_of_range: usize,
    /// [pixel] That differ from all neighbours by more than the truth does.
    pub speckles: usize,
    /// [pixel] That see a surface which faces the whole light; the figures below are theirs.
    pub pixels: usize,
    /// Largest, mean and 99th percentile of the absolute error; the latter over shadow pixels.
    pub largest: f64,
    pub mean: f64,
    pub p99: f64,
    /// [pixel] With light where there is none at all.
    pub leaks: usize,
    /// Largest deviation from what the frame's own maps say in f64, of techniques that integrate contours and where
    /// that takes no minutes.
    pub twin: Option<f64>,
}

/// A case's truth.
///
/// # Errors
/// It cannot be traced, or `cancel` was set.
pub fn truth(case: &Case, cancel: &AtomicBool) -> Result<ReferenceImage> {
    let options = ReferenceOptions {
        samples: SAMPLES,
        seed: 0,
    };
    trace(&case.shot, 0, options, &|_| {}, cancel)
}

/// What `settings` do on a case; its own map, split or packet go first.
///
/// # Errors
/// The device is lost.
pub fn examine(
    gpu: &Arc<Gpu>,
    case: &Case,
    truth: &ReferenceImage,
    settings: &Settings,
) -> Result<Finding> {
    let shot = case.with(settings);
    let mut finding = Finding {
        family: case.family,
        case: case.name.clone(),
        label: shot.settings.label(),
        failure: None,
        non_finite: 0,
        out_of_range: 0,
        speckles: 0,
        pixels: 0,
        largest: 0.0,
        mean: 0.0,
        p99: 0.0,
        leaks: 0,
        twin: None,
    };
    match render(gpu, &shot) {
        Ok((image, twin)) => {
            finding.twin = twin;
            finding.judge(&image, truth);
        }
        Err(error) if error.is_device_lost() => return Err(error),
        Err(error) => finding.failure = Some(error.to_string()),
    }
    Ok(finding)
}

/// The image, and how far it is off its twin.
fn render(gpu: &Arc<Gpu>, shot: &Shot) -> Result<(Plane, Option<f64>)> {
    let options = RenderOptions {
        outputs: Outputs { picture: false },
        costs: DEFAULT_COSTS,
        exposure: DEFAULT_EXPOSURE,
    };
    let mut renderer = Renderer::new(gpu, shot, options)?;
    renderer.render()?;
    let image = Plane::new(
        shot.width as usize,
        shot.height as usize,
        renderer.visibility(0)?,
    )?;
    let twin = twin::largest_deviation(&mut renderer, shot, &image)?;
    Ok((image, twin))
}

impl Finding {
    fn judge(&mut self, image: &Plane, truth: &ReferenceImage) {
        let exact = &truth.visibility;
        for (index, (&value, &wanted)) in image.data.iter().zip(&exact.data).enumerate() {
            // A silhouette's pixel may see a surface in only one of the images.
            if wanted.is_nan() {
                continue;
            }
            let facing = truth.facing.data[index];
            self.non_finite += usize::from(!value.is_finite() && !near_silhouette(exact, index));
            self.out_of_range += usize::from(value.is_finite() && !(0.0..=1.0).contains(&value));
            self.leaks += usize::from(faces_wholly(facing) && is_dark(exact, index) && value > 0.0);
        }
        self.speckles = speckles(image, truth);
        // Without a pixel to compare the figures stay 0, and `pixels` says so.
        if let Ok(metrics) = compare(image, exact, Some(&truth.facing)) {
            self.pixels = metrics.pixels;
            self.largest = metrics.max;
            self.mean = metrics.mae;
            self.p99 = metrics.p99;
        }
    }

    /// Whether all that is promised of any technique holds: it renders, all values are finite and in [0, 1].
    pub fn is_sound(&self) -> bool {
        self.failure.is_none() && self.non_finite == 0 && self.out_of_range == 0
    }
}

/// The pixels round a pixel, inside the image.
fn neighbours(plane: &Plane, index: usize) -> impl Iterator<Item = usize> {
    let (width, height) = (plane.width as isize, plane.height as isize);
    let (x, y) = (index as isize % width, index as isize / width);
    let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)));
    around
        .filter(|&offset| offset != (0, 0))
        .map(move |(dx, dy)| (x + dx, y + dy))
        .filter(move |&(x, y)| (0..width).contains(&x) && (0..height).contains(&y))
        .map(move |(x, y)| (y * width + x) as usize)
}

fn near_silhouette(truth: &Plane, index: usize) -> bool {
    neighbours(truth, index).any(|other| truth.data[other].is_nan())
}

/// Whether the truth is 0 in a pixel and around it.
fn is_dark(truth: &Plane, index: usize) -> bool {
    truth.data[index] == 0.0 && neighbours(truth, index).all(|other| truth.data[other] == 0.0)
}

fn speckles(image: &Plane, truth: &ReferenceImage) -> usize {
    let exact = &truth.visibility;
    let stands_out = |&index: &usize| {
        let (value, wanted) = (image.data[index], exact.data[index]);
        let (mut least, mut most) = (f32::INFINITY, 0.0f32);
        for other in neighbours(image, index) {
            least = least.min((value - image.data[other]).abs());
            most = most.max((wanted - exact.data[other]).abs());
        }
        least.is_finite() && least > most + SPECKLE
    };
    let counts =
        |&index: &usize| faces_wholly(truth.facing.data[index]) && !near_silhouette(exact, index);
    (0..image.data.len())
        .filter(counts)
        .filter(stands_out)
        .count()
}

/// Findings as a table for people: for each technique and family the worst case.
pub fn summary(findings: &[Finding]) -> String {
    let mut text = format!(
        "{:<46} {:<16} {:>5} {:>7} {:>7} {:>8} {:>6} {:>8}  {}\n",
        "technique",
        "family",
        "cases",
        "unsound",
        "mean",
        "speckles",
        "leaks",
        "twin",
        "worst case"
    );
    let mut groups: Vec<(&str, &str)> = Vec::new();
    for finding in findings {
        let group = (technique_of(finding), finding.family);
        if !groups.contains(&group) {
            groups.push(group);
        }
    }
    groups.sort_unstable();
    for group in groups {
        let of_group =
            || (findings.iter()).filter(|finding| (technique_of(finding), finding.family) == group);
        let Some(worst) = of_group().max_by(|a, b| a.mean.total_cmp(&b.mean)) else {
            continue;
        };
        let sum = |value: fn(&Finding) -> usize| of_group().map(value).sum::<usize>();
        let twin = of_group()
            .filter_map(|finding| finding.twin)
            .reduce(f64::max);
        text += &format!(
            "{:<46} {:<16} {:>5} {:>7} {:>7.4} {:>8} {:>6} {:>8}  {}\n",
            group.0,
            group.1,
            of_group().count(),
            sum(|finding| usize::from(!finding.is_sound())),
            worst.mean,
            sum(|finding| finding.speckles),
            sum(|finding| finding.leaks),
            twin.map_or("-".into(), |twin| format!("{twin:.1e}")),
            worst.case
        );
    }
    for failed in findings.iter().filter(|finding| !finding.is_sound()) {
        text += &format!(
            "unsound: {} on {}: {} not finite, {} beyond [0, 1]{}\n",
            failed.label,
            failed.case,
            failed.non_finite,
            failed.out_of_range,
            failed
                .failure
                .as_ref()
                .map_or(String::new(), |why| format!("; {why}"))
        );
    }
    text
}

/// The label without what a case changes.
fn technique_of(finding: &Finding) -> &str {
    finding.label.split(',').next().unwrap_or(&finding.label)
}

/// All findings as CSV, with a header.
///
/// # Errors
/// A value cannot be written.
pub fn csv(findings: &[Finding]) -> Result<String> {
    table::written(findings.iter())
}
