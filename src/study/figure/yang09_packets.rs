//! [Yang09]: what packets and the hierarchy save.

use super::check::{Check, all, number, numbers};
use super::row::{Curve, ERROR_ASIDE, TIME_ASIDE, distinct, only_scene};
use super::yang09::{FLAT, HIERARCHICAL, PACKETS, hierarchical, knot, packets, rival};
use super::{Candidate, Column, Experiment, Row, Trial, Truth};
use crate::shot::{Overrides, Shot};
use crate::technique::{Settings, Technique};

/// [pixel] Sides of packets.
const SIDES: [u32; 6] = [1, 2, 3, 4, 6, 8];
/// How much slower than the best a good packet size may be.
const GOOD: f64 = 1.25;
const PRUNED: &str = "hierarchical contours, 3x3 packets, pruned by the light's footprint";
const PACKET_TIME: &str = "packets";
/// What the hierarchy is claimed to save at least, and all of it together for a large light.
const HIERARCHY: f64 = 1.5;
const TOGETHER: f64 = 10.0;
/// Errors that differ by no more are the same: what sums of f32 in another order do to a mean.
const SAME_ERROR: f64 = 1e-4;

/// Of the passes that integrate visibility, and of their choice of packets.
const VISIBILITY_TIME: Column = Column {
    name: "visibility_ms",
    plotted: true,
    of: visibility_ms,
};

pub const FIG12: Experiment = Experiment {
    name: "yang09-fig12",
    source: "Yang et al. 2009, figure 12: packet size and image resolution",
    paper: "average speed on the scene of figure 1a in three image sizes with six packet sizes, without the \
            hierarchical optimisation",
    claim: "larger images do better with larger packets; 2x2 or 3x3 are good choices",
    here: "the built-in colonnade in three image sizes, 256x256 map, one view, no pruning by the light's footprint, \
           divergent packets reprocessed",
    missing: "packets without the hierarchy: packets walk the MSSM here; 1x1 is the pixel-wise path",
    differs: "with the hierarchy, which makes reading cheap, less is left to share; a CPU driver keeps a packet's \
              pixels in memory rather than in registers, so large packets do not run out of them, and eight packets \
              side by side take as long as the longest",
    abscissa: "packet_side",
    columns: &[VISIBILITY_TIME, TIME_ASIDE, ERROR_ASIDE],
    frames: 15,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let sizes = scale.pick(
            &[(32, 32), (64, 64)][..],
            &[(128, 128), (256, 256), (512, 512)],
            &[(640, 480), (1024, 768), (1280, 1024)],
        );
        let map = scale.pick(64, 256, 512);
        let sides = scale.pick(&SIDES[..2], &SIDES[..], &SIDES[..]);
        let trial = |&size: &(u32, u32)| {
            let overrides = Overrides {
                size: Some(size),
                ..Overrides::default()
            };
            let candidates = sides.iter().map(|&side| {
                let settings = Settings {
                    packet: (side, side),
                    ..packets(map)
                };
                Candidate::new(PACKET_TIME, f64::from(side), settings)
            });
            Ok(Trial {
                scene: format!("colonnade, {}x{} pixels", size.0, size.1),
                shot: Shot::built_in("colonnade", &overrides)?,
                truth: Truth::Rays,
                samples: 64,
                candidates: candidates.collect(),
            })
        };
        sizes.iter().map(trial).collect()
    },
    judge: judge_fig12,
};

pub const FIG13: Experiment = Experiment {
    name: "yang09-fig13",
    source: "Yang et al. 2009, figure 13: packets and hierarchy over the size of the light",
    paper: "speed over the light's size on the scene of figure 9, 1280x1024 pixels, one view, 3x3 packets: neither, \
            packets, and packets with the hierarchy",
    claim: "packets are always faster, small penumbrae included; the hierarchy makes it another 1.5 to 4 times as \
            fast, together an order of magnitude for large lights, without loss of accuracy",
    here: "the built-in knot under square lights of the proportions of figure 9, 320x256 pixels, 256x256 map, one view",
    missing: "packets without the hierarchy: packets walk the MSSM here, so the hierarchy is tried on single pixels",
    differs: "on a CPU driver eight pixels side by side share a walk's instructions anyway, and its lookups are \
              no slower than its sums; kernels of small maps have less to skip; contours tell ground uphill from \
              occluders sample by sample, where the paper's depth test takes it for one",
    abscissa: "light_size",
    columns: &[VISIBILITY_TIME, TIME_ASIDE, ERROR_ASIDE],
    frames: 15,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let size = scale.pick((32, 24), (320, 256), (1280, 1024));
        let map = scale.pick(64, 256, 512);
        let all = [10.0, 20.0, 40.0, 80.0, 160.0];
        let lights = scale.pick(&all[3..4], &all[..], &all[..]);
        let pruned = Settings {
            footprint_pruning: true,
            ..packets(map)
        };
        let series = [
            (FLAT, rival(Technique::PixelContour, map)),
            (HIERARCHICAL, hierarchical(map)),
            (PACKETS, packets(map)),
            (PRUNED, pruned),
        ];
        let trial = |&light: &f64| knot(size, light, 64, &series);
        lights.iter().map(trial).collect()
    },
    judge: judge_fig13,
};

fn visibility_ms(row: &Row) -> f64 {
    row.pass_ms("classify") + row.visibility_ms()
}

fn judge_fig12(rows: &[Row]) -> Vec<Check> {
    let scenes = distinct(rows, |row| &row.scene);
    let curves: Vec<Curve> = scenes
        .iter()
        .map(|scene| Curve::of(rows, scene, PACKET_TIME, visibility_ms))
        .collect();
    let best: Vec<f64> = curves
        .iter()
        .map(|curve| curve.lowest().map_or(f64::NAN, |point| point.0))
        .collect();
    let slower: Vec<f64> = curves
        .iter()
        .map(|curve| {
            let least = curve.lowest().map_or(f64::NAN, |point| point.1);
            curve
                .within(2.0, 3.0)
                .lowest()
                .map_or(f64::NAN, |point| point.1)
                / least
        })
        .collect();
    let sides = format!(
        "sides of {} are best in {}",
        numbers(best.iter().copied()),
        scenes.join("; ")
    );
    vec![
        Check::new(
            "packets beat single pixels in every size",
            sides.clone(),
            all(&best, |side| side > 1.0),
        ),
        Check::new(
            "the best packet does not shrink as the image grows",
            sides,
            !best.is_empty() && best.is_sorted(),
        ),
        Check::new(
            "2x2 or 3x3 takes at most 1.25 times as long as the best in every size",
            format!("{} times", numbers(slower.iter().copied())),
            all(&slower, |ratio| ratio <= GOOD),
        ),
    ]
}

fn judge_fig13(rows: &[Row]) -> Vec<Check> {
    let scene = only_scene(rows);
    let curve = |series| Curve::of(rows, scene, series, visibility_ms);
    let speed = |slow: &Curve, fast: &Curve| -> Vec<f64> {
        slow.0.iter().map(|p| p.1 / fast.at(p.0)).collect()
    };
    let (flat, pixels, packets) = (curve(FLAT), curve(HIERARCHICAL), curve(PACKETS));
    let (shared, pruned) = (speed(&pixels, &packets), speed(&flat, &pixels));
    let together = flat.last() / packets.last();
    let times = |ratios: &[f64]| format!("{} times as fast", numbers(ratios.iter().copied()));
    let errors: Vec<f64> = [FLAT, HIERARCHICAL, PACKETS]
        .iter()
        .map(|series| Curve::of(rows, scene, series, Row::error).last())
        .collect();
    let spread = errors.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        - errors.iter().copied().fold(f64::INFINITY, f64::min);
    vec![
        Check::new(
            "packets are faster than single pixels under every light",
            times(&shared),
            all(&shared, |ratio| ratio > 1.0),
        ),
        Check::new(
            "the hierarchy is at least 1.5 times as fast under every light",
            times(&pruned),
            all(&pruned, |ratio| ratio >= HIERARCHY),
        ),
        Check::new(
            "together they are ten times as fast under the largest light",
            times(&[together]),
            together >= TOGETHER,
        ),
        Check::new(
            "without loss of accuracy (mean errors within 0.0001 of each other)",
            format!("{} apart", number(spread)),
            (0.0..=SAME_ERROR).contains(&spread),
        ),
    ]
}
