//! [Schwarz08]: what budgets of micro-occluders cost and save, and what queries have to hold.

use super::check::{CLEAR, Check, all, number, numbers};
use super::row::{Curve, ERROR_ASIDE, TIME, distinct};
use super::{Candidate, Column, Experiment, Row, Scale, Trial, Truth};
use crate::Result;
use crate::shot::{Overrides, Shot};
use crate::technique::{Hierarchy, Settings, Technique};

/// Built-in shots: near and far occluders, and a lattice with large kernels.
const SCENES: [&str; 2] = ["knot", "staircase"];
/// [texel] Of the map, as in the paper.
const MAP: u32 = 1024;

fn shot(scale: Scale, scene: &str) -> Result<Shot> {
    let overrides = Overrides {
        size: Some(scale.pick((24, 24), (192, 192), (1024, 768))),
        ..Overrides::default()
    };
    Shot::built_in(scene, &overrides)
}

/// Micropatches within a budget.
fn limited(scale: Scale, budget: Option<u32>) -> Settings {
    Settings {
        budget,
        map: scale.pick(128, MAP, MAP),
        hierarchy: Hierarchy::Ysm,
        ..Settings::published(Technique::Micropatch)
    }
}

const PENUMBRA: Column = Column {
    name: "integrated_share",
    plotted: false,
    of: |row| row.count("penumbra") / row.count("pixels"),
};

/// The values of a series in a scene, x ascending.
fn curve(rows: &[Row], scene: &str, series: &str, column: &Column) -> Curve {
    Curve::of(rows, scene, series, column.of)
}

const TIGHT: &str = "without growth";
const GROWN: &str = "with growth";

const CUT: Column = Column {
    name: "cut_share",
    plotted: true,
    of: |row| row.metrics(|metrics| metrics.share_over_0_05_shadow),
};
const STEP: Column = Column {
    name: "largest_step",
    plotted: false,
    of: |row| row.metrics(|metrics| metrics.max),
};

pub const FIG7: Experiment = Experiment {
    name: "schwarz08-fig7",
    source: "Schwarz and Stamminger 2008, figure 7: over-precision at the interface to lit regions",
    paper: "a picture: with an MSSM, a border of shadow ends in a step where pixels are classified as lit by what their search \
            area holds, and goes on where the queried region is grown to the support of the micro-occluders",
    claim: "queries that hold no more than the search area classify pixels as lit that coarse micro-occluders hide light from",
    here: "micropatches over an MSSM with queries as they are and grown; the truth is the image with growth. cut_share: share of \
           its shadow pixels that are off by more than 0.05 without; largest_step: the most that one is off",
    missing: "",
    differs: "kernels shrink in up to eight rounds here, so that they are tighter and more is cut",
    abscissa: "budget",
    columns: &[CUT, STEP, PENUMBRA],
    frames: 1,
    counters: true,
    takes_shots: false,
    trials: |scale, _| {
        let budgets = scale.pick(&[4, 8][..], &[5, 9, 12, 16][..], &[5, 9, 12, 16][..]);
        let trials = SCENES
            .iter()
            .flat_map(|scene| budgets.iter().map(move |&budget| (*scene, budget)));
        trials
            .map(|(scene, budget)| growth(scale, scene, budget))
            .collect()
    },
    judge: judge_growth,
};

fn growth(scale: Scale, scene: &str, budget: u32) -> Result<Trial> {
    let grown = Settings {
        hierarchy: Hierarchy::Mssm,
        ..limited(scale, Some(budget))
    };
    let tight = Settings {
        query_growth: false,
        ..grown.clone()
    };
    let x = f64::from(budget);
    Ok(Trial {
        scene: scene.into(),
        shot: shot(scale, scene)?,
        truth: Truth::Rendered(Box::new(grown.clone())),
        samples: 16,
        candidates: vec![
            Candidate::new(TIGHT, x, tight),
            Candidate::new(GROWN, x, grown),
        ],
    })
}

fn judge_growth(rows: &[Row]) -> Vec<Check> {
    let scenes = distinct(rows, |row| &row.scene);
    let of = |series, column: &Column| -> Vec<f64> {
        let values = scenes
            .iter()
            .flat_map(|scene| curve(rows, scene, series, column).0);
        values.map(|point| point.1).collect()
    };
    let steps = of(TIGHT, &STEP);
    let more: Vec<f64> = of(GROWN, &PENUMBRA)
        .iter()
        .zip(of(TIGHT, &PENUMBRA))
        .map(|(grown, tight)| grown / tight)
        .collect();
    let cut = scenes.iter().map(|scene| curve(rows, scene, TIGHT, &CUT));
    let trends: Vec<f64> = cut.map(|curve| curve.trend()).collect();
    vec![
        Check::new(
            "without growth some shadow ends in a step of at least 0.1, whatever the budget",
            format!("largest steps {}", numbers(steps.iter().copied())),
            all(&steps, |step| step >= 0.1),
        ),
        Check::new(
            "the smaller the budget, the more of the shadow is cut (τ ≤ −0.6)",
            format!("τ = {}", numbers(trends.iter().copied())),
            all(&trends, |trend| trend <= -CLEAR),
        ),
        Check::new(
            "with growth more pixels are integrated",
            format!("{} times as many", numbers(more.iter().copied())),
            all(&more, |ratio| ratio > 1.0),
        ),
    ]
}

const HSM: &str = "HSM";
const MSSM: &str = "MSSM";
const MSSM_TIGHT: &str = "MSSM without growth";
const YSM: &str = "YSM";

const LEVEL: Column = Column {
    name: "mean_level",
    plotted: true,
    of: |row| row.per_penumbra_pixel("coarse_levels"),
};

pub const FIG8: Experiment = Experiment {
    name: "schwarz08-fig8",
    source: "Schwarz and Stamminger 2008, figure 8: levels that acceleration structures take to meet a budget of 16",
    paper: "a picture of levels by colour: an HSM takes coarser levels and has more pixels integrated than an MSSM, a YSM \
            hardly; the growth of queries makes an MSSM's levels a little coarser",
    claim: "tighter search areas allow finer levels for the same budget, and a YSM's are nearly as tight as an MSSM's",
    here: "the mean over integrated pixels of the whole level that keeps to a budget of 16, by hierarchy, for micropatches; maps of \
           512x512 to 2048x2048 texels, the coarse map of the YSM has 256x256",
    missing: "the picture of levels",
    differs: "queries are asked again with nodes half as large, and kernels shrink in up to eight rounds: sparse structures lose less",
    abscissa: "map",
    columns: &[LEVEL, PENUMBRA, ERROR_ASIDE],
    frames: 1,
    counters: true,
    takes_shots: false,
    trials: |scale, _| {
        SCENES
            .iter()
            .map(|scene| structures(scale, scene))
            .collect()
    },
    judge: judge_structures,
};

fn structures(scale: Scale, scene: &str) -> Result<Trial> {
    let all = [512, 1024, 2048];
    let maps = scale.pick(&[64, 512][..], &all[..], &all[..]);
    let kinds = [
        (HSM, Hierarchy::Hsm, true),
        (YSM, Hierarchy::Ysm, true),
        (MSSM, Hierarchy::Mssm, true),
        (MSSM_TIGHT, Hierarchy::Mssm, false),
    ];
    let candidates = maps.iter().flat_map(|&map| {
        kinds.map(|(series, hierarchy, query_growth)| {
            let settings = Settings {
                map,
                hierarchy,
                query_growth,
                ..limited(scale, Some(16))
            };
            Candidate::new(series, f64::from(map), settings)
        })
    });
    Ok(Trial {
        scene: scene.into(),
        shot: shot(scale, scene)?,
        truth: Truth::Rays,
        samples: 64,
        candidates: candidates.collect(),
    })
}

fn judge_structures(rows: &[Row]) -> Vec<Check> {
    let scenes = distinct(rows, |row| &row.scene);
    let ratios = |over, under, column: &Column| -> Vec<f64> {
        let of_scene = |scene: &&str| {
            let under = curve(rows, scene, under, column);
            let over = curve(rows, scene, over, column).within(512.0, f64::MAX);
            over.0
                .iter()
                .map(|point| point.1 / under.at(point.0))
                .collect::<Vec<_>>()
        };
        scenes.iter().flat_map(of_scene).collect()
    };
    let coarser = |over, under, column, claim: &str, holds: fn(f64) -> bool| {
        let found = ratios(over, under, column);
        Check::new(
            claim,
            format!("{} times", numbers(found.iter().copied())),
            all(&found, holds),
        )
    };
    vec![
        coarser(
            HSM,
            MSSM,
            &LEVEL,
            "an HSM takes coarser levels than an MSSM",
            |ratio| ratio > 1.0,
        ),
        coarser(
            HSM,
            MSSM,
            &PENUMBRA,
            "and has more pixels integrated",
            |ratio| ratio > 1.0,
        ),
        coarser(
            YSM,
            MSSM,
            &LEVEL,
            "a YSM's levels are at most a tenth coarser than an MSSM's",
            |ratio| ratio < 1.1,
        ),
        coarser(
            MSSM,
            MSSM_TIGHT,
            &PENUMBRA,
            "the growth of queries has more pixels integrated",
            |ratio| ratio > 1.0,
        ),
    ]
}

const UNIFORM: &str = "one budget";
const FALLING: &str = "12, falling to 5 at the border";
/// A budget that no kernel exceeds.
const UNLIMITED: f64 = 4096.0;

const OCCLUDERS: Column = Column {
    name: "occluders_per_pixel",
    plotted: true,
    of: |row| row.per_penumbra_pixel("edges_extracted"),
};
const VISIBILITY: Column = Column {
    name: "visibility_ms",
    plotted: true,
    of: Row::visibility_ms,
};

pub const TABLE2: Experiment = Experiment {
    name: "schwarz08-table2",
    source: "Schwarz and Stamminger 2008, table 2: frame rates, pixels that are integrated and micro-occluders by budget",
    paper: "on a GeForce 8800 GTX, 1024x768 pixels, YSM of 1024x1024 with 256x256: figure 1 with budgets of 5, 5 to 12, 12 and \
            none: 82.6, 35.8, 27.1 and 23.9 frames a second, 15.6, 13.0, 11.7 and 11.0 % of the pixels integrated, 33, 164, 480 \
            and 548 micro-occluders for each; figure 8 with 9 and none: 46.7 and 15.0, 9.2 and 8.0 %, 158 and 1372; figure 10 \
            with 10 and none: 24.8 and 7.1, 12.7 and 11.2 %, 194 and 3632",
    claim: "a budget saves time even though two levels are blended, the more the smaller it is; somewhat more pixels are \
            integrated; a budget that falls towards the border costs what lies between",
    here: "micropatches over a YSM with budgets of 5 to 24, 12 that falls to 5, and none (x = 4096); occluders_per_pixel of both \
           levels together",
    missing: "the standard deviation of the number of micro-occluders, which no counter tells",
    differs: "kernels are tighter, so that without a budget there is less to save",
    abscissa: "budget",
    columns: &[TIME, VISIBILITY, OCCLUDERS, PENUMBRA, ERROR_ASIDE],
    frames: 5,
    counters: true,
    takes_shots: false,
    trials: |scale, _| SCENES.iter().map(|scene| budgets(scale, scene)).collect(),
    judge: judge_budgets,
};

fn budgets(scale: Scale, scene: &str) -> Result<Trial> {
    let numbers = scale.pick(&[5, 12][..], &[5, 9, 12, 24][..], &[5, 9, 12, 24][..]);
    let of =
        |budget: &u32| Candidate::new(UNIFORM, f64::from(*budget), limited(scale, Some(*budget)));
    let mut candidates: Vec<Candidate> = numbers.iter().map(of).collect();
    candidates.push(Candidate::new(UNIFORM, UNLIMITED, limited(scale, None)));
    let falling = Settings {
        budget_falloff: 5.0 / 12.0,
        ..limited(scale, Some(12))
    };
    candidates.push(Candidate::new(FALLING, 12.0, falling));
    Ok(Trial {
        scene: scene.into(),
        shot: shot(scale, scene)?,
        truth: Truth::Rays,
        samples: 64,
        candidates,
    })
}

fn judge_budgets(rows: &[Row]) -> Vec<Check> {
    let scenes = distinct(rows, |row| &row.scene);
    let at = |scene: &str, series, column: &Column, x| curve(rows, scene, series, column).at(x);
    let each = |value: &dyn Fn(&str) -> f64| -> Vec<f64> {
        scenes.iter().map(|scene| value(scene)).collect()
    };
    let faster = each(&|scene| {
        at(scene, UNIFORM, &VISIBILITY, UNLIMITED) / at(scene, UNIFORM, &VISIBILITY, 12.0)
    });
    let trends = each(&|scene| curve(rows, scene, UNIFORM, &OCCLUDERS).trend());
    let more = each(&|scene| {
        at(scene, UNIFORM, &PENUMBRA, 5.0) / at(scene, UNIFORM, &PENUMBRA, UNLIMITED)
    });
    // Where between 5 and 12 the falling budget comes to lie.
    let between = each(&|scene| {
        let [least, most] = [5.0, 12.0].map(|x| at(scene, UNIFORM, &OCCLUDERS, x));
        (at(scene, FALLING, &OCCLUDERS, 12.0) - least) / (most - least)
    });
    vec![
        Check::new(
            "a budget of 12 integrates faster than none (1.1 times the frame rate in the paper's figure 1)",
            format!("{} times as fast", numbers(faster.iter().copied())),
            all(&faster, |ratio| ratio > 1.0),
        ),
        Check::new(
            "the larger the budget, the more micro-occluders a pixel takes (τ ≥ 0.6)",
            format!("τ = {}", numbers(trends.iter().copied())),
            all(&trends, |trend| trend >= CLEAR),
        ),
        Check::new(
            "a budget of 5 integrates 1 to 1.6 times as many pixels as none (1.4 in the paper)",
            format!("{} times", numbers(more.iter().copied())),
            all(&more, |ratio| (1.0..=1.6).contains(&ratio)),
        ),
        Check::new(
            "a budget that falls from 12 to 5 takes a number of micro-occluders between theirs",
            format!(
                "{} of the way from 5 to 12",
                between
                    .iter()
                    .map(|share| number(*share))
                    .collect::<Vec<_>>()
                    .join(", ")
            ),
            all(&between, |share| (0.0..=1.0).contains(&share)),
        ),
    ]
}
