//! Our own: how many views to cut a number of texels into.

use super::check::{Check, number, numbers};
use super::row::{Curve, ERROR, TIME, TIME_MAX, TIME_MIN, distinct};
use super::{Candidate, Column, Experiment, NamedShot, Row, Trial, Truth};
use crate::shot::{Overrides, Shot};
use crate::technique::{Settings, Technique};

/// The scenes without any of the user's.
const SCENES: [&str; 4] = ["knot", "staircase", "colonnade", "tree"];
const SPLITS: [u32; 4] = [1, 2, 4, 8];
/// How much of the error of one view four by four may have at most, and how many times fewer nodes they visit at least.
const ERROR_SHARE: f64 = 0.5;
const FEWER_NODES: f64 = 12.0;

/// Pixels are those that a view looks at.
const NODES_VISITED: Column = Column {
    name: "nodes_per_pixel_and_view",
    plotted: true,
    of: nodes,
};
const NODES_OF_ALL: Column = Column {
    name: "nodes_of_all_views",
    plotted: false,
    of: |row| row.count("nodes_visited"),
};

pub const EQUAL_TEXELS: Experiment = Experiment {
    name: "equal-texels",
    source: "our own: S × S views of a constant number of texels",
    paper: "a prototype on real models, 1024x1024 texels as one map, and as 4x4 of 256x256",
    claim: "S = 4 has a quarter to a half of the error of S = 1 and visits 12 to 30 times fewer nodes per pixel and view",
    here: "shots given on the command line, else built-in ones, 128x128 pixels where they are built in: 1024x1024 and \
           512x512 texels in all as S = 1, 2, 4 and 8; with the pruning by the light's footprint",
    missing: "",
    differs: "the prototype had other models and no pruning by the light's footprint, which leaves one view less to visit; \
              it compared with the receiver's depth alone, so that a single view erred 3 to 5 times as much where \
              surfaces are tilted; \
              once texels are coarser than what casts, their bias and their width are what is wrong, and more views \
              of coarser texels err more",
    abscissa: "S",
    columns: &[ERROR, NODES_VISITED, TIME, TIME_MIN, TIME_MAX, NODES_OF_ALL],
    frames: 15,
    counters: true,
    takes_shots: true,
    trials: |scale, shots| {
        let side = scale.pick(32, 128, 512);
        let budgets = scale.pick(&[128][..], &[1024, 512], &[1024, 512]);
        let splits = scale.pick(&SPLITS[..2], &SPLITS[..], &SPLITS[..]);
        let overrides = Overrides {
            size: Some((side, side)),
            ..Overrides::default()
        };
        let built_in = |name: &&str| {
            Ok(NamedShot {
                name: (*name).into(),
                shot: Shot::built_in(name, &overrides)?,
            })
        };
        let shots = match shots {
            [] => scale
                .pick(&SCENES[..1], &SCENES[..], &SCENES[..])
                .iter()
                .map(built_in)
                .collect::<crate::Result<_>>()?,
            _ => shots.to_vec(),
        };
        let candidates = budgets.iter().flat_map(|&budget| {
            splits.iter().map(move |&split| {
                let settings = Settings {
                    split,
                    map: budget / split,
                    ..Settings::published(Technique::PacketContour)
                };
                Candidate::new(series(budget), f64::from(split), settings)
            })
        });
        let candidates: Vec<Candidate> = candidates.collect();
        Ok(shots
            .into_iter()
            .map(|named: NamedShot| Trial {
                scene: named.name,
                shot: named.shot,
                truth: Truth::Rays,
                samples: scale.pick(64, 1024, 1024),
                candidates: candidates.clone(),
            })
            .collect())
    },
    judge,
};

fn series(budget: u32) -> String {
    format!("{budget}x{budget} texels in all")
}

fn nodes(row: &Row) -> f64 {
    row.count("nodes_visited") / row.count("pixels")
}

fn judge(rows: &[Row]) -> Vec<Check> {
    let mut checks = Vec::new();
    for scene in distinct(rows, |row| &row.scene) {
        for series in distinct(rows, |row| &row.series) {
            let curve = |value| Curve::of(rows, scene, series, value);
            let (errors, visited, times) = (curve(Row::error), curve(nodes), curve(Row::ms));
            let best = |curve: &Curve| number(curve.lowest().map_or(f64::NAN, |point| point.0));
            let share = errors.at(4.0) / errors.at(1.0);
            checks.push(Check::new(
                format!("{scene}, {series}: S = 4 has at most half of the error of S = 1"),
                format!(
                    "{} of it ({}); least with S = {}, fastest with S = {}",
                    number(share),
                    numbers(errors.0.iter().map(|point| point.1)),
                    best(&errors),
                    best(&times)
                ),
                share <= ERROR_SHARE,
            ));
            let fewer = visited.at(1.0) / visited.at(4.0);
            checks.push(Check::new(
                format!("{scene}, {series}: S = 4 visits at least 12 times fewer nodes per pixel and view"),
                format!("{} times fewer", number(fewer)),
                fewer >= FEWER_NODES,
            ));
        }
    }
    checks
}
