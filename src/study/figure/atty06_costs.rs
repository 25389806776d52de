//! [Atty06]: time over map and light.

use super::atty06::{LIGHT, PATCHES, patches, trial};
use super::check::{CLEAR, Check, all, number, numbers};
use super::row::{Curve, ERROR, ERROR_ASIDE, TIME, TIME_MAX, TIME_MIN, only_scene};
use super::stage::{Model, Stage, knot};
use super::{Candidate, Experiment, Row, Trial};
use crate::technique::{Settings, Technique};

const CONTOURS: &str = "packet-contour, S = 1";
/// Exponents that count as linear.
const LINEAR: (f64, f64) = (0.8, 1.2);
/// How much more than the fine map's error a coarse map's may be to be similar.
const SIMILAR: f64 = 1.25;

pub const FIG22: Experiment = Experiment {
    name: "atty06-fig22",
    source: "Atty et al. 2006, figure 22: time over the size of the occluder map",
    paper: "time to display a scene of 24,000 polygons with soft shadows on a GeForce 6800 Ultra, over the number of \
            pixels of the occluder map: 10 to 50 ms for 128x128 and 256x256, 150 ms for 512x512",
    claim: "the time is proportional to the number of pixels of the map",
    here: "a torus knot of 24,000 triangles under a light half as large, 128x128 pixels, maps of 64 to 512 texels; \
           micropatches are read pixel by pixel, contours are walked to by packets",
    missing: "the paper's own algorithm: it draws a rectangle for each texel of the map, here each pixel reads the \
              texels of its kernel",
    differs: "the paper found the transfer of its map to the CPU to be what takes the time, and there is none here; \
              drawing and g-buffer cost the same under every map",
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
            let contours = Settings {
                split: 1,
                map,
                ..Settings::published(Technique::PacketContour)
            };
            [
                Candidate::new(PATCHES, pixels, patches(Technique::Micropatch, map)),
                Candidate::new(CONTOURS, pixels, contours),
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
    missing: "the paper's own algorithm and its second pass; micropatches with gaps hide the same of the light",
    differs: "the model is another one; each pixel reads its kernel, whose size goes with the light's, where the \
              paper draws each patch's shadow",
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
            let candidates = maps.iter().map(|&map| {
                let settings = patches(Technique::Micropatch, map);
                Candidate::new(series(map), light, settings)
            });
            trial(scale, stage, candidates.collect())
        };
        lights.iter().map(stage).collect()
    },
    judge: judge_fig24,
};

/// [texel]
const MAPS: [u32; 3] = [64, 128, 256];

fn series(map: u32) -> String {
    format!("{PATCHES}, {map}x{map}")
}

fn judge_fig22(rows: &[Row]) -> Vec<Check> {
    let times = Curve::of(rows, only_scene(rows), PATCHES, Row::ms);
    let contours = Curve::of(rows, only_scene(rows), CONTOURS, Row::ms);
    let power = times.power();
    vec![Check::new(
        "the time of micropatches goes with the map's pixels (exponent 0.8 to 1.2)",
        format!(
            "exponent {}, from {} to {} ms; that of contours {}, from {} to {} ms",
            number(power),
            number(times.first()),
            number(times.last()),
            number(contours.power()),
            number(contours.first()),
            number(contours.last())
        ),
        (LINEAR.0..=LINEAR.1).contains(&power),
    )]
}

fn judge_fig24(rows: &[Row]) -> Vec<Check> {
    let curve = |map, value| Curve::of(rows, only_scene(rows), &series(map), value);
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
