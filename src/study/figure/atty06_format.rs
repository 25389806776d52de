//! [Atty06]: the format that shares add up in.

use super::atty06::{LIGHT, ONE, scattered, trial};
use super::check::{Check, all, number, numbers};
use super::row::{Curve, ERROR, SHADOW_PIXELS};
use super::stage::{Model, Stage};
use super::{Candidate, Experiment, Row};
use crate::technique::{Accumulate, Settings};

const ONE_16: &str = "one pass, fp16";

pub const FIG14: Experiment = Experiment {
    name: "atty06-fig14",
    source: "Atty et al. 2006, figure 14 and appendix A: sums in 16 and in 32 bits over the resolution of the shadow map",
    paper: "pictures of the Buddha's shadow, added up in 16 bits on a GeForce 6800 with maps of 128x128 and 512x512, and of the \
            latter in 32 bits on the CPU",
    claim: "with too fine a map 16 bits give wrong shadows, where coarser maps and 32 bits do not; equation 4 tells from where on",
    here: "the square turned and a torus knot under a light half as large, half way up, maps of 32 to 512 texels: equation 4 holds \
           up to 128 texels; 128x128 pixels of which those on the ground count",
    missing: "",
    differs: "lavapipe truncates sums in 16 bits, so that each addition loses half a step on the mean and errors grow with the number \
              of patches before equation 4 fails, where a device that rounds loses nothing; models, their places and sizes are not \
              the paper's",
    abscissa: "map",
    columns: &[ERROR, SHADOW_PIXELS],
    frames: 1,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let maps = scale.pick(&[64, 256][..], &FORMAT_MAPS, &FORMAT_MAPS);
        let models = [Model::Turned, Model::Knot];
        let stage = |&model: &Model| {
            let candidates = maps.iter().flat_map(|&map| {
                let x = f64::from(map);
                [
                    Candidate::new(ONE, x, scattered(map)),
                    Candidate::new(ONE_16, x, in_16_bits(map)),
                ]
            });
            trial(scale, Stage::usual(model, LIGHT), candidates.collect())
        };
        models.iter().map(stage).collect()
    },
    judge: judge_fig14,
};

const FORMAT_MAPS: [u32; 5] = [32, 64, 128, 256, 512];
/// [texel] The largest map under which equation 4 holds, and the next one.
const HOLDS: f64 = 128.0;
const FAILS: f64 = 256.0;
/// Errors that differ by less are the same; how many times the error a wrong shadow has at least.
const SAME: f64 = 0.005;
const WRONG: f64 = 2.0;

fn in_16_bits(map: u32) -> Settings {
    Settings {
        accumulate: Accumulate::Fp16,
        ..scattered(map)
    }
}

fn judge_fig14(rows: &[Row]) -> Vec<Check> {
    let mut checks = Vec::new();
    for model in Model::ALL {
        let [half, full] =
            [ONE_16, ONE].map(|series| Curve::of(rows, model.name(), series, Row::error));
        if full.0.is_empty() {
            continue;
        }
        let (name, points) = (model.name(), half.0.iter());
        let worse: Vec<(f64, f64)> = points
            .map(|&(map, error)| (map, error - full.at(map)))
            .collect();
        let coarse: Vec<f64> = worse.iter().filter(|p| p.0 <= HOLDS).map(|p| p.1).collect();
        let times = |map| half.at(map) / full.at(map);
        let last = half.0.last().map_or(f64::NAN, |point| point.0);
        checks.extend([
            Check::new(
                format!("{name}: where equation 4 holds 16 bits err like 32 (within {SAME})"),
                format!("by {} more", numbers(coarse.iter().copied())),
                all(&coarse, |error| error < SAME),
            ),
            Check::new(
                format!(
                    "{name}: beyond, 16 bits err at least twice as much, and more with every step"
                ),
                format!(
                    "{} times as much under the first such map, {} times under the last",
                    number(times(FAILS)),
                    number(times(last))
                ),
                times(FAILS) >= WRONG
                    && half
                        .within(FAILS, f64::INFINITY)
                        .0
                        .windows(2)
                        .all(|pair| pair[1].1 > pair[0].1),
            ),
            Check::new(
                format!("{name}: in 32 bits the finest map errs no more than the coarsest"),
                format!("{} and {}", number(full.last()), number(full.first())),
                full.last() <= full.first(),
            ),
        ]);
    }
    checks
}
