//! Stiff and extreme cases, the quick ones. `halfshade study stability` has them all.

use std::sync::atomic::AtomicBool;

use halfshade::plan::{Outputs, plan};
use halfshade::scene::Outline;
use halfshade::study::stability::{cases, csv, examine, summary, truth};
use halfshade::technique::{Settings, Technique};

use super::support::with_gpu;

/// The cases that are tried here: one for each way in which numbers get large, small or equal.
const CASES: [&str; 20] = [
    "plate 1e-7 of the light's height above the ground",
    "plate 1e-7 of the light's height below the light",
    "slats 0.01 below the light, turned by 0",
    "slats 0.02 below the light, turned by 90",
    "cover 1e-6 below the light",
    "cover of a half 1e-6 below the light",
    "ceiling 1e-3 below the light",
    "plate across the light's plane",
    "light without area",
    "light of half width 5e1",
    "aspect 1:10000",
    "triangle of 1:10000, tilted by 80",
    "sphere that touches the ground",
    "sphere around everything",
    "sun of 0.000001 degrees",
    "sun of 179 degrees",
    "sun of 0.1 degrees 89.9 degrees from upright",
    "1e6 away along x",
    "triangles without area",
    "image of 1x1",
];
/// [visibility] Mean error: what a map of 128 texels knows of edges, or what points know of slats before the light.
const MEAN: f64 = 0.02;
/// [visibility] Sums of some hundred areas in f32; no case of `halfshade study stability` but polygons in a single view is off by more than
/// 6e-6.
const TWIN: f64 = 1e-5;
/// [visibility] In a sharp corner the swept area bends between two entries of the sector table, 1/128 apart: 3 · (1/128)² / 4 where
/// its slope changes by 3, as in the triangles here.
const TWIN_OF_CORNERS: f64 = 5e-5;

#[test]
fn extreme_cases_stay_finite_and_in_range() {
    let never = AtomicBool::new(false);
    let all = cases(false);
    with_gpu(|gpu| {
        let mut findings = Vec::new();
        for name in CASES {
            let case = all.iter().find(|case| case.name == name).expect(name);
            let truth = truth(case, &never).expect(name);
            for technique in [Technique::PacketContour, Technique::Pcss] {
                let settings = Settings {
                    split: 1,
                    ..Settings::usual(technique)
                };
                let finding = examine(gpu, case, &truth, &settings).expect(name);
                assert!(finding.is_sound(), "{finding:?}");
                let ours = technique == Technique::PacketContour;
                assert!(!ours || finding.mean < MEAN, "{finding:?}");
                // Points have no kernels that the twin could check.
                let outputs = Outputs { picture: false };
                let planned = plan(&case.with(&settings), outputs, &gpu.limits);
                let integrated = planned.expect(name).near_count() == 0;
                assert_eq!(finding.twin.is_some(), ours && integrated, "{finding:?}");
                let bound = match case.shot.lights[0].outline() {
                    Outline::Polygon(_) => TWIN_OF_CORNERS,
                    _ => TWIN,
                };
                assert!(finding.twin.is_none_or(|twin| twin < bound), "{finding:?}");
                findings.push(finding);
            }
        }
        let table = csv(&findings).expect("a table");
        assert_eq!(table.lines().count(), findings.len() + 1);
        assert!(summary(&findings).contains("pcss"));
    });
}

/// A point of the light and a single receiver span a line, and what crosses it has to be drawn nevertheless.
#[test]
fn hard_shadows_of_a_single_pixel_add_up() {
    // Of 8×8 points of the light, an edge is off by half a row.
    const HALF_A_ROW: f64 = 0.5 / 8.0;
    let all = cases(false);
    let case = all.iter().find(|case| case.name == "image of 1x1");
    let case = case.expect("it is among them");
    with_gpu(|gpu| {
        let truth = truth(case, &AtomicBool::new(false)).expect("a truth");
        let settings = Settings {
            maps: 64,
            ..Settings::usual(Technique::ReferenceMaps)
        };
        let finding = examine(gpu, case, &truth, &settings).expect("an image");
        assert!(
            finding.is_sound() && finding.mean <= HALF_A_ROW,
            "{finding:?}"
        );
    });
}

#[test]
fn no_two_cases_have_the_same_name() {
    let mut names: Vec<String> = cases(true).into_iter().map(|case| case.name).collect();
    let count = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), count);
    assert!(count > 70, "{count}");
}
