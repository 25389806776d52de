//! [Kirsch03]: what the map of shadow widths costs.

use super::check::{Check, all, number, numbers};
use super::row::{Curve, ERROR_ASIDE};
use super::{Candidate, Column, Experiment, Row, Trial, Truth};
use crate::Result;
use crate::shot::{Overrides, Shot};
use crate::technique::{Neighbours, Settings, Technique};

const SCENE: &str = "staircase";
const FLOOD: &str = "jump flooding";
/// Starting differences, as their reciprocals.
const STARTS: [u32; 4] = [4, 16, 64, 256];
/// How many times as long six neighbours take in the paper, and 1/256 as 1/4, and twice the side: from its frame rates, those
/// of hard shadows taken off.
const SIX: (f64, f64) = (1.4, 2.6);
const FINEST: (f64, f64) = (2.0, 6.0);
const TWICE: (f64, f64) = (2.5, 5.5);

const BUILD_TIME: Column = Column {
    name: "width_ms",
    plotted: true,
    of: |row| row.pass_ms("width_seed") + row.pass_ms("width_spread"),
};

pub const TABLE1: Experiment = Experiment {
    name: "kirsch03-table1",
    source: "Kirsch and Döllner 2003, table 1: frames per second with maps of shadow widths",
    paper: "on a GeForce3 Ti200, maps of 256x256 to 2048x2048 texels: hard shadows 97.9 to 17.0 frames a second; starting \
            differences of 1/4 to 1/256 with three neighbours 86.1 to 2.4, with six 77.4 to 1.3. Less the hard shadows, six \
            neighbours take 2.0 times as long as three, 1/256 takes 4.2 times as long as 1/4, twice the side 4.1 times",
    claim: "the cost of the map follows from its texels, from the number of passes, which the starting difference decides, and \
            from the neighbours that each pass samples, and from nothing else",
    here: "the passes that build the map of widths on the built-in staircase, with three and six neighbours and by jump flooding",
    missing: "the software method, which copies the map to the host: nothing is read back here",
    differs: "passes read and write a buffer instead of textures; on a CPU driver an invocation's start and its own texel take most \
              of a pass, so that three more neighbours add a fifth, where a GPU of 2002 paid for each texture",
    abscissa: "map",
    columns: &[BUILD_TIME, ERROR_ASIDE],
    frames: 9,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let all = [256, 512, 1024, 2048];
        let maps = scale.pick(&[64, 128][..], &all[..], &all[..]);
        Ok(vec![trial(maps)?])
    },
    judge,
};

fn series(neighbours: Neighbours, start: u32) -> String {
    match neighbours {
        Neighbours::Flood => FLOOD.into(),
        Neighbours::Three => format!("1/{start}, 3 neighbours"),
        Neighbours::Six => format!("1/{start}, 6 neighbours"),
    }
}

fn trial(maps: &[u32]) -> Result<Trial> {
    // Pixels matter to nothing here.
    let overrides = Overrides {
        size: Some((16, 16)),
        ..Overrides::default()
    };
    let both = [Neighbours::Three, Neighbours::Six];
    let iterated = both
        .into_iter()
        .flat_map(|kind| STARTS.map(|start| (kind, start)));
    let kinds: Vec<_> = iterated.chain([(Neighbours::Flood, STARTS[0])]).collect();
    let candidate = |map: u32, (neighbours, start)| {
        let settings = Settings {
            map,
            neighbours,
            start,
            ..Settings::published(Technique::ShadowWidth)
        };
        Candidate::new(series(neighbours, start), f64::from(map), settings)
    };
    let candidates = maps
        .iter()
        .flat_map(|&map| kinds.iter().map(move |&kind| candidate(map, kind)));
    Ok(Trial {
        scene: SCENE.into(),
        shot: Shot::built_in(SCENE, &overrides)?,
        truth: Truth::Rays,
        samples: 64,
        candidates: candidates.collect(),
    })
}

fn judge(rows: &[Row]) -> Vec<Check> {
    let times = |kind, start| Curve::of(rows, SCENE, &series(kind, start), BUILD_TIME.of);
    let ratios = |over: &Curve, under: &Curve| -> Vec<f64> {
        let points = over.0.iter();
        points.map(|&(x, ms)| ms / under.at(x)).collect()
    };
    let both = [Neighbours::Three, Neighbours::Six];
    let six: Vec<f64> = (STARTS.iter())
        .flat_map(|&start| ratios(&times(both[1], start), &times(both[0], start)))
        .collect();
    let finest: Vec<f64> = (both.iter())
        .flat_map(|&kind| ratios(&times(kind, STARTS[3]), &times(kind, STARTS[0])))
        .collect();
    let twice: Vec<f64> = (both.iter())
        .flat_map(|&kind| STARTS.map(|start| times(kind, start)))
        .flat_map(|curve| {
            curve
                .0
                .windows(2)
                .map(|pair| pair[1].1 / pair[0].1)
                .collect::<Vec<_>>()
        })
        .collect();
    [
        (
            "six neighbours take 1.4 to 2.6 times as long as three",
            six,
            SIX,
        ),
        (
            "a start of 1/256 takes 2 to 6 times as long as one of 1/4",
            finest,
            FINEST,
        ),
        (
            "a map of twice the side takes 2.5 to 5.5 times as long",
            twice,
            TWICE,
        ),
    ]
    .into_iter()
    .map(|(claim, found, (least, most))| {
        let median = median(&found);
        Check::new(
            format!("{claim}, at the median"),
            format!(
                "{} times; all: {}",
                number(median),
                numbers(found.iter().copied())
            ),
            all(&[median], |ratio| (least..=most).contains(&ratio)),
        )
    })
    .collect()
}

/// NaN of nothing.
fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}
