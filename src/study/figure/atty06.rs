//! [Atty06]: the error over the map's and the light's size and the occluder's place.

use super::check::{CLEAR, Check, all, number, numbers};
use super::row::{Column, Curve, ERROR, SHADOW_PIXELS};
use super::stage::{Model, Stage};
use super::{Candidate, Experiment, Row, Scale, Trial};
use crate::Result;
use crate::technique::{Settings, Technique};

/// The paper's own algorithm.
pub const ONE: &str = "one pass";
pub const TWO: &str = "two passes";
/// The sum of what back-projected patches hide, pixel by pixel [GBP06].
pub const PATCHES: &str = "micropatches with gaps";
pub const CONTOURS: &str = "packet-contour, S = 1";
const VIEWS: &str = "packet-contour, S = 4";

/// [texel] The map of all figures but the 17th.
const MAP: u32 = 128;
/// [scene units] The light of the figures that do not vary it.
pub const LIGHT: f64 = 0.1;
/// Errors below are the rounding of sums over thousands of patches.
const ROUNDING: f64 = 1e-4;
/// How little a finer map may gain, as a share of the error, for the error to be at its limit.
const LIMIT: f64 = 0.25;

const DIFFERS: &str = "maps are fitted to what casts, so the square's sides fall on the borders of texels and what is left \
                       of its error is what pixels interpolate: the turned one stands for the paper's; models, their places and the sizes of light and image are not the paper's; errors are means \
                       over pixels of an oblique view of the ground, not over texels of it";

pub const FIG17: Experiment = Experiment {
    name: "atty06-fig17",
    source: "Atty et al. 2006, figure 17: error over the resolution of the shadow map",
    paper: "mean difference to occlusion queries over pixels in shadow, of a square plate parallel to the light, the \
            Buddha and the Bunny, over the side of the map, for one pass and for two",
    claim: "the error falls with the resolution and hardly further beyond 200x200; the square's curve has spikes; two passes err \
            less than one but on the square",
    here: "the square, the square turned, a torus knot and a figure of boxes, maps of 32 to 512 texels, a light half as large as the \
           occluder, 128x128 pixels of which those on the ground count",
    missing: "",
    differs: DIFFERS,
    abscissa: "map",
    columns: &[ERROR, SHADOW_PIXELS],
    frames: 1,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let maps = scale.pick(&[32, 64][..], &MAPS, &MAPS);
        let stage = |&model: &Model| {
            let series = |map: &u32| candidates(f64::from(*map), *map);
            trial(
                scale,
                Stage::usual(model, LIGHT),
                maps.iter().flat_map(series).collect(),
            )
        };
        models(scale).iter().map(stage).collect()
    },
    judge: judge_fig17,
};

const MAPS: [u32; 11] = [32, 48, 64, 96, 128, 160, 200, 256, 320, 400, 512];

pub const FIG18: Experiment = Experiment {
    name: "atty06-fig18",
    source: "Atty et al. 2006, figure 18: error over the size of the light",
    paper: "the same three scenes, maps of 128x128, lights from a point (0.01) to about the occluder's size (0.2)",
    claim: "a point light's error is large; from there on the error rises with the light",
    here: "the square, the square turned, a torus knot and a figure of boxes 0.2 wide, lights of side 0.01 to 0.2, one unit above the \
           ground, 128x128 pixels of which those on the ground count",
    missing: "",
    differs: DIFFERS,
    abscissa: "light_size",
    columns: &[ERROR, SHADOW_PIXELS],
    frames: 1,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let lights = scale.pick(&[0.05, 0.2][..], &LIGHTS, &LIGHTS);
        over(scale, lights, Stage::usual)
    },
    judge: judge_fig18,
};

const LIGHTS: [f64; 7] = [0.01, 0.02, 0.04, 0.07, 0.1, 0.15, 0.2];

pub const FIG19: Experiment = Experiment {
    name: "atty06-fig19",
    source: "Atty et al. 2006, figure 19: error over the lateral position of the occluder",
    paper: "the same three scenes, maps of 128x128, the occluder moved from left to right under the light",
    claim: "the error is least when the occluder is roughly under the light and rises to both sides",
    here: "the square, the square turned, a torus knot and a figure of boxes, a light half as large, moved by up to one and a half times \
           their size, 128x128 pixels of which those on the ground count",
    missing: "",
    differs: DIFFERS,
    abscissa: "aside",
    columns: &[ERROR, SHADOW_PIXELS],
    frames: 1,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let places = scale.pick(&[0.0, 0.3][..], &PLACES, &PLACES);
        over(scale, places, |model, aside| Stage {
            aside,
            ..Stage::usual(model, LIGHT)
        })
    },
    judge: judge_fig19,
};

const PLACES: [f64; 7] = [-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3];
/// [scene units] How far from the light's middle the least error may be to be roughly under it.
const UNDER: f64 = 0.1;
/// How many times the least error that at both ends has to be for the curve not to be flat.
const AT_THE_ENDS: f64 = 1.1;

pub const FIG20: Experiment = Experiment {
    name: "atty06-fig20",
    source: "Atty et al. 2006, figure 20: error over the vertical position of the occluder",
    paper: "the same three scenes, maps of 128x128, the occluder moved from the ground up to the light",
    claim: "the error rises as the occluder nears the light",
    here: "the square, the square turned, a torus knot and a figure of boxes, a light half as large, from the ground (0) nearly up to \
           the light (1), 128x128 pixels of which those on the ground count",
    missing: "",
    differs: DIFFERS,
    abscissa: "height",
    columns: &[ERROR, OVERLAP, SHADOW_PIXELS],
    frames: 1,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let heights = scale.pick(&[0.2, 0.6][..], &HEIGHTS, &HEIGHTS);
        over(scale, heights, |model, height| {
            Stage::lifted(model, LIGHT, height)
        })
    },
    judge: judge_fig20,
};

/// Equation 3 for a pair of patches at the occluder's highest and at its lowest place, as a share of the light.
const OVERLAP: Column = Column {
    name: "overlap_bound",
    plotted: false,
    of: |row| {
        let model = Model::ALL
            .into_iter()
            .find(|model| model.name() == row.scene);
        model.map_or(f64::NAN, |model| {
            Stage::lifted(model, LIGHT, row.x).largest_overlap()
        })
    },
};

const HEIGHTS: [f64; 7] = [0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9];

/// The models of a scale.
fn models(scale: Scale) -> &'static [Model] {
    scale.pick(&Model::ALL[1..3], &Model::ALL[..], &Model::ALL[..])
}

/// A stage for each model and x, under maps of the usual size.
fn over(scale: Scale, xs: &[f64], stage: fn(Model, f64) -> Stage) -> Result<Vec<Trial>> {
    let map = scale.pick(64, MAP, MAP);
    let models = models(scale).iter();
    let places = models.flat_map(|&model| xs.iter().map(move |&x| (model, x)));
    places
        .map(|(model, x)| trial(scale, stage(model, x), candidates(x, map)))
        .collect()
}

pub fn trial(scale: Scale, stage: Stage, candidates: Vec<Candidate>) -> Result<Trial> {
    Ok(Trial {
        scene: stage.model.name().into(),
        shot: stage.shot(scale.pick(32, 128, 256)),
        truth: stage.truth(),
        samples: scale.pick(64, 1024, 4096),
        candidates,
    })
}

fn candidates(x: f64, map: u32) -> Vec<Candidate> {
    let views = Settings {
        split: 4,
        ..contours(map)
    };
    vec![
        Candidate::new(ONE, x, scattered(map)),
        Candidate::new(TWO, x, two_sided(map)),
        Candidate::new(PATCHES, x, patches(Technique::MicropatchHierarchical, map)),
        Candidate::new(CONTOURS, x, contours(map)),
        Candidate::new(VIEWS, x, views),
    ]
}

/// The paper's own algorithm in one pass.
pub fn scattered(map: u32) -> Settings {
    Settings {
        map,
        ..Settings::published(Technique::OccluderDriven)
    }
}

pub fn two_sided(map: u32) -> Settings {
    Settings {
        two_sided: true,
        ..scattered(map)
    }
}

/// Ours with a single view.
pub fn contours(map: u32) -> Settings {
    Settings {
        split: 1,
        map,
        ..Settings::published(Technique::PacketContour)
    }
}

/// Patches as [Atty06] has them.
pub fn patches(technique: Technique, map: u32) -> Settings {
    Settings {
        map,
        gap_filling: false,
        ..Settings::published(technique)
    }
}

/// Checks of each model's curve, with what the curve is called; one that is nothing but rounding says nothing.
fn checks(
    rows: &[Row],
    judge: fn(model: Model, name: &str, errors: &Curve) -> Vec<Check>,
) -> Vec<Check> {
    let mut checks = Vec::new();
    for model in Model::ALL {
        for series in [ONE, TWO, CONTOURS] {
            let errors = Curve::of(rows, model.name(), series, Row::error);
            let name = format!("{}, {series}", model.name());
            let largest = errors.0.iter().map(|point| point.1).reduce(f64::max);
            match largest {
                None => {}
                Some(largest) if largest < ROUNDING => checks.push(Check::new(
                    format!("{name}: there is an error to speak of (above {ROUNDING})"),
                    format!("{} at most, which is rounding", number(largest)),
                    false,
                )),
                Some(_) => checks.extend(judge(model, &name, &errors)),
            }
        }
    }
    checks
}

/// That two passes err no more than one, and less on what is closed.
fn two_against_one(rows: &[Row]) -> Vec<Check> {
    let mut checks = Vec::new();
    for model in Model::ALL {
        let [one, two] = [ONE, TWO].map(|series| Curve::of(rows, model.name(), series, Row::error));
        let ratios: Vec<f64> = one.0.iter().map(|&(x, error)| two.at(x) / error).collect();
        if ratios.is_empty() {
            continue;
        }
        let (claim, most) = match Model::CLOSED.contains(&model) {
            true => ("two passes err less than one under every map", 1.0),
            false => (
                "without thickness two passes err as one does (within 1 %)",
                1.01,
            ),
        };
        checks.push(Check::new(
            format!("{}: {claim}", model.name()),
            format!("{} times as much", numbers(ratios.iter().copied())),
            all(&ratios, |ratio| ratio < most),
        ));
    }
    checks
}

fn judge_fig17(rows: &[Row]) -> Vec<Check> {
    let mut all = two_against_one(rows);
    all.extend(over_maps(rows));
    all
}

fn over_maps(rows: &[Row]) -> Vec<Check> {
    checks(rows, |model, name, errors| {
        let coarse = errors.within(0.0, 200.0);
        let falls = Check::new(
            format!("{name}: the error falls up to 200 texels (τ ≤ −{CLEAR})"),
            format!(
                "τ = {}, from {} to {}",
                number(coarse.trend()),
                number(coarse.first()),
                number(coarse.last())
            ),
            coarse.trend() <= -CLEAR,
        );
        let fine = errors.within(200.0, f64::INFINITY);
        let gain = 1.0 - fine.last() / fine.first();
        let rises = |pair: &&[(f64, f64)]| pair[1].1 > pair[0].1.max(ROUNDING);
        let rises = errors.0.windows(2).filter(rises).count();
        let then = match Model::CLOSED.contains(&model) {
            true => Check::new(
                format!("{name}: beyond 200 texels it falls by no more than a quarter"),
                format!("by {} %", number(100.0 * gain)),
                gain <= LIMIT,
            ),
            false => Check::new(
                format!("{name}: its curve has spikes (rises somewhere above {ROUNDING})"),
                format!(
                    "rises in {rises} of {} steps",
                    errors.0.len().saturating_sub(1)
                ),
                rises > 0,
            ),
        };
        vec![falls, then]
    })
}

fn judge_fig18(rows: &[Row]) -> Vec<Check> {
    checks(rows, |_, name, errors| {
        let least = errors.lowest().map_or(f64::NAN, |point| point.0);
        let larger = errors.within(least, f64::INFINITY);
        vec![
            Check::new(
                format!("{name}: the smallest light's error is more than the least"),
                format!(
                    "{}, the least is that of {}",
                    number(errors.first()),
                    number(least)
                ),
                errors.first() > errors.at(least),
            ),
            Check::new(
                format!("{name}: from there on it rises with the light (τ ≥ {CLEAR})"),
                format!(
                    "τ = {}, up to {}",
                    number(larger.trend()),
                    number(larger.last())
                ),
                larger.trend() >= CLEAR,
            ),
        ]
    })
}

fn judge_fig19(rows: &[Row]) -> Vec<Check> {
    checks(rows, |_, name, errors| {
        let (least, lowest) = errors.lowest().unwrap_or((f64::NAN, f64::NAN));
        let sides = [
            errors.within(f64::NEG_INFINITY, 0.0).trend(),
            errors.within(0.0, f64::INFINITY).trend(),
        ];
        let rise = errors.first().min(errors.last()) / lowest;
        vec![
            Check::new(
                format!(
                    "{name}: the error is least roughly under the light (within {UNDER}), at the ends a tenth more"
                ),
                format!(
                    "least at {}, at the ends {} times it",
                    number(least),
                    number(rise)
                ),
                least.abs() <= UNDER && rise >= AT_THE_ENDS,
            ),
            Check::new(
                format!("{name}: it rises to both sides (τ ≤ −{CLEAR}, ≥ {CLEAR})"),
                format!("τ = {}", numbers(sides)),
                sides[0] <= -CLEAR && sides[1] >= CLEAR,
            ),
        ]
    })
}

fn judge_fig20(rows: &[Row]) -> Vec<Check> {
    let mut all = checks(rows, |_, name, errors| {
        vec![Check::new(
            format!("{name}: the error rises towards the light (τ ≥ {CLEAR})"),
            format!(
                "τ = {}, from {} to {}",
                number(errors.trend()),
                number(errors.first()),
                number(errors.last())
            ),
            errors.trend() >= CLEAR,
        )]
    });
    all.extend(
        Model::CLOSED
            .into_iter()
            .filter_map(|model| within_equation_3(rows, model)),
    );
    all
}

/// That the mean error stays below what a single pair of patches may overlap by.
fn within_equation_3(rows: &[Row], model: Model) -> Option<Check> {
    let [errors, bounds] =
        [Row::error, OVERLAP.of].map(|value| Curve::of(rows, model.name(), ONE, value));
    let shares: Vec<f64> = errors
        .0
        .iter()
        .map(|&(x, error)| error / bounds.at(x))
        .collect();
    (!shares.is_empty()).then(|| {
        Check::new(
            format!(
                "{}, {ONE}: the error is below what equation 3 allows two patches",
                model.name()
            ),
            format!("{} of it", numbers(shares.iter().copied())),
            all(&shares, |share| share < 1.0),
        )
    })
}
