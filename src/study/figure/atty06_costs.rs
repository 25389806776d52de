//! [Atty06]: time over map and light.

use super::atty06::{
    CONTOURS, LIGHT, ONE, PATCHES, TWO, contours, patches, scattered, trial, two_sided,
};
use super::check::{CLEAR, Check, all, number, numbers};
use super::row::{Curve, ERROR, ERROR_ASIDE, TIME, TIME_MAX, TIME_MIN, only_scene};
use super::stage::{Model, Stage, knot};
use super::{Candidate, Experiment, Row, Trial};
use crate::technique::Technique;

/// Exponents that count as linear.
const LINEAR: (f64, f64) = (0.8, 1.2);
/// How many times as long two passes may take.
const SECOND: (f64, f64) = (1.4, 2.0);
/// How much more than the fine map's error a coarse map's may be to be similar.
const SIMILAR: f64 = 1.25;

pub const FIG22: Experiment = Experiment {
    name: "atty06-fig22",
    source: "Atty et al. 2006, figure 22: time over the size of the occluder map",
    paper: "time to display a scene of 24,000 polygons with soft shadows on a GeForce 6800 Ultra, over the number of \
            pixels of the occluder map: 10 to 50 ms for 128x128 and 256x256, 150 ms for 512x512",
    claim: "the time is proportional to the number of pixels of the map",
    here: "a torus knot of 24,000 triangles under a light half as large, 128x128 pixels, maps of 64 to 512 texels; beside it \
           micropatches that each pixel reads, and contours that packets walk to",
    missing: "",
    differs: "the paper found the transfer of its map to the CPU to be what takes the time, and there is none here; the soft shadow \
              map has as many texels as the occluder map, so that a finer one scatters more patches over more texels each",
    abscissa: "map_pixels",
    columns: &[TIME, TIME_MIN, TIME_MAX, ERROR_ASIDE],
    frames: 15,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let maps = scale.pick(
            &[32, 64][..],
            &[64, 128, 192, 256, 384, 512],
            &[64, 128, 192, 256, 384, 512],
        );
        let stage = Stage::usual(Model::Knot, LIGHT);
        let candidates = maps.iter().flat_map(|&map| {
            let pixels = f64::from(map) * f64::from(map);
            [
                Candidate::new(ONE, pixels, scattered(map)),
                Candidate::new(TWO, pixels, two_sided(map)),
                Candidate::new(PATCHES, pixels, patches(Technique::Micropatch, map)),
                Candidate::new(CONTOURS, pixels, contours(map)),
            ]
        });
        Ok(vec![Trial {
            scene: "knot of 24,000 triangles".into(),
            shot: stage.shot_of(knot(600), scale.pick(32, 128, 512)),
            ..trial(scale, stage, candidates.collect())?
        }])
    },
    judge: judge_fig22,
};

pub const FIG24: Experiment = Experiment {
    name: "atty06-fig24",
    source: "Atty et al. 2006, figure 24: time and error over the size of the light, for three maps",
    paper: "speed and error of a floating Bunny over the light's size, maps of 64x64, 128x128 and 256x256",
    claim: "time and error rise with the light; larger maps are better for small lights, for large lights a small one \
            is as good",
    here: "a floating figure of boxes under lights of side 0.01 to 0.2, its own size, 128x128 pixels of which those \
           on the ground count",
    missing: "",
    differs: "the model is another one",
    abscissa: "light_size",
    columns: &[ERROR, TIME, TIME_MIN, TIME_MAX],
    frames: 15,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let maps = scale.pick(&MAPS[..2], &MAPS[..], &MAPS[..]);
        let lights = scale.pick(
            &[0.05, 0.2][..],
            &[0.01, 0.03, 0.06, 0.1, 0.15, 0.2],
            &[0.01, 0.03, 0.06, 0.1, 0.15, 0.2],
        );
        let stage = |&light: &f64| {
            let stage = Stage::lifted(Model::Figure, light, 0.5);
            let one = |&map: &u32| Candidate::new(series(ONE, map), light, scattered(map));
            let two = |&map: &u32| Candidate::new(series(TWO, map), light, two_sided(map));
            let candidates = maps.iter().map(one).chain(maps.iter().map(two));
            trial(scale, stage, candidates.collect())
        };
        lights.iter().map(stage).collect()
    },
    judge: judge_fig24,
};

/// [texel]
const MAPS: [u32; 3] = [64, 128, 256];

fn series(passes: &str, map: u32) -> String {
    format!("{passes}, {map}x{map}")
}

fn judge_fig22(rows: &[Row]) -> Vec<Check> {
    let times = |series| Curve::of(rows, only_scene(rows), series, Row::ms);
    let [one, two] = [ONE, TWO].map(times);
    let power = one.power();
    let beside = [TWO, PATCHES, CONTOURS].map(|series| times(series).power());
    let ratios: Vec<f64> = two.0.iter().map(|&(x, ms)| ms / one.at(x)).collect();
    let mut checks = vec![Check::new(
        "the time of one pass goes with the map's pixels (exponent 0.8 to 1.2)",
        format!(
            "exponent {}, from {} to {} ms; of two passes, of micropatches pixel by pixel and of contours {}",
            number(power),
            number(one.first()),
            number(one.last()),
            numbers(beside)
        ),
        (LINEAR.0..=LINEAR.1).contains(&power),
    )];
    if !ratios.is_empty() {
        checks.push(Check::new(
            "two passes take 1.6 to 1.8 times as long as one (§3.5), here within 1.4 to 2",
            format!("{} times", numbers(ratios.iter().copied())),
            all(&ratios, |ratio| (SECOND.0..=SECOND.1).contains(&ratio)),
        ));
    }
    checks
}

fn judge_fig24(rows: &[Row]) -> Vec<Check> {
    let curve = |map, value| Curve::of(rows, only_scene(rows), &series(ONE, map), value);
    let mut checks = Vec::new();
    for (what, value) in [("time", Row::ms as fn(&Row) -> f64), ("error", Row::error)] {
        let trends: Vec<f64> = MAPS
            .into_iter()
            .map(|map| curve(map, value).trend())
            .filter(|trend| trend.is_finite())
            .collect();
        checks.push(Check::new(
            format!("the {what} rises with the light (τ ≥ {CLEAR}) under every map"),
            format!(
                "τ = {} under maps of 64, 128 and 256",
                numbers(trends.iter().copied())
            ),
            all(&trends, |trend| trend >= CLEAR),
        ));
    }
    let ratio = |pick: fn(&Curve) -> f64| {
        let fine = MAPS.iter().rev().map(|&map| curve(map, Row::error));
        let fine = fine.into_iter().find(|curve| !curve.0.is_empty());
        pick(&curve(MAPS[0], Row::error)) / fine.map_or(f64::NAN, |curve| pick(&curve))
    };
    let (small, large) = (ratio(Curve::first), ratio(Curve::last));
    let found = format!("{} times the error of the finest", number(small));
    checks.push(Check::new(
        "under the smallest light the coarsest map errs more than the finest",
        found,
        small > 1.0,
    ));
    checks.push(Check::new(
        "under the largest light it errs at most 1.25 times as much",
        format!("{} times", number(large)),
        large <= SIMILAR,
    ));
    checks
}
