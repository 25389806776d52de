//! [Schwarz08]: what several samples of a pixel cost where they have one visibility together.

use super::check::{Check, all, number, numbers};
use super::row::{Curve, ERROR_ASIDE, distinct};
use super::{Candidate, Column, Experiment, Row, Trial, Truth};
use crate::gpu::SAMPLES;
use crate::shot::{Overrides, Shot};
use crate::technique::{Hierarchy, Settings, Technique};

/// Built-in shots with many silhouettes.
const SCENES: [&str; 2] = ["knot", "tree"];
const SINGLE: &str = "one sample";
const OWN: &str = "four samples, one visibility";
const NEIGHBOURS: &str = "four samples, neighbours' visibility";
/// The paper's bound on the overhead.
const NEGLIGIBLE: f64 = 0.1;

const TOTAL: Column = Column {
    name: "frame_ms",
    plotted: true,
    of: Row::frame_ms,
};
const SURFACE: Column = Column {
    name: "gbuffer_ms",
    plotted: false,
    of: |row| row.pass_ms("gbuffer"),
};
const SHADING: Column = Column {
    name: "shade_ms",
    plotted: false,
    of: |row| row.pass_ms("shade"),
};

pub const FIG9: Experiment = Experiment {
    name: "schwarz08-fig9",
    source: "Schwarz and Stamminger 2008, figure 9 and section 8: multisampled rendering with single-sampled visibility",
    paper: "a picture: samples that take their pixel's visibility speckle silhouettes, those that look at the neighbours do not; over a \
            range of scenes multisampling has an overhead of less than 9 %, of which 5 % are without shadows as well",
    claim: "four samples of a pixel with one visibility cost less than a tenth more than one sample",
    here: "whole frames of micropatches within a budget of 12, maps of 1024x1024 texels",
    missing: "the pictures: a test holds them against pictures of 16 samples with a visibility each",
    differs: "shading is a pass of its own over all samples' positions, normals and colours, which the paper's renderer shades while \
              it draws; a CPU driver rasterises four samples at about twice the cost of one",
    abscissa: "samples",
    columns: &[TOTAL, SURFACE, SHADING, ERROR_ASIDE],
    frames: 9,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let trial = |scene: &&str| {
            let overrides = Overrides {
                size: Some(scale.pick((24, 24), (192, 192), (1024, 768))),
                ..Overrides::default()
            };
            let settings = Settings {
                budget: Some(12),
                map: scale.pick(128, 1024, 1024),
                hierarchy: Hierarchy::Ysm,
                ..Settings::published(Technique::Micropatch)
            };
            Ok(Trial {
                scene: (*scene).into(),
                shot: Shot::built_in(scene, &overrides)?,
                truth: Truth::Rays,
                samples: 64,
                candidates: candidates(&settings),
            })
        };
        SCENES.iter().map(trial).collect()
    },
    judge,
};

fn candidates(settings: &Settings) -> Vec<Candidate> {
    let with = |series, multisample, neighbour_visibility| {
        let settings = Settings {
            multisample,
            neighbour_visibility,
            ..settings.clone()
        };
        Candidate::new(series, f64::from(multisample), settings)
    };
    vec![
        with(SINGLE, 1, true),
        with(OWN, SAMPLES, false),
        with(NEIGHBOURS, SAMPLES, true),
    ]
}

fn judge(rows: &[Row]) -> Vec<Check> {
    let overhead = |column: &Column, series: &str| -> Vec<f64> {
        let of_scene = |scene: &&str| {
            let time = |series| Curve::of(rows, scene, series, column.of).first();
            time(series) / time(SINGLE) - 1.0
        };
        distinct(rows, |row| &row.scene)
            .iter()
            .map(of_scene)
            .collect()
    };
    let percent = |shares: &[f64]| numbers(shares.iter().map(|share| 100.0 * share));
    let whole = overhead(&TOTAL, NEIGHBOURS);
    let own = overhead(&TOTAL, OWN);
    let apart: Vec<f64> = whole
        .iter()
        .zip(&own)
        .map(|(whole, own)| (whole - own).abs())
        .collect();
    vec![
        Check::new(
            format!(
                "four samples take less than {} % longer than one (9 % in the paper)",
                number(100.0 * NEGLIGIBLE)
            ),
            format!("{} % longer", percent(&whole)),
            all(&whole, |share| share < NEGLIGIBLE),
        ),
        Check::new(
            "whether samples look at neighbours makes no more than 3 % of the frame",
            format!("{} %", percent(&apart)),
            all(&apart, |share| share <= 0.03),
        ),
    ]
}
