//! Stiff and extreme cases, the quick ones. `halfshade study stability` has them all.

use std::sync::atomic::AtomicBool;

use halfshade::shot::{Settings, Technique};
use halfshade::study::stability::{cases, csv, examine, summary, truth};

use super::support::with_gpu;

/// The cases that are tried here: one for each way in which numbers get large, small or equal.
const CASES: [&str; 8] = [
    "plate 1e-7 of the light's height above the ground",
    "plate 1e-7 of the light's height below the light",
    "plate across the light's plane",
    "light without area",
    "aspect 1:10000",
    "1e6 away along x",
    "triangles without area",
    "image of 1x1",
];
/// [visibility] Mean error where the plate does not touch the light: what a map of 128 texels knows of its edges.
const MEAN: f64 = 0.02;
/// [visibility] As in `tests/passes.rs`: sums of some hundred areas in f32.
const TWIN: f64 = 1e-4;

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
                if ours && case.family != "near the light" {
                    assert!(finding.mean < MEAN, "{finding:?}");
                }
                assert_eq!(finding.twin.is_some(), ours, "{finding:?}");
                assert!(finding.twin.is_none_or(|twin| twin < TWIN), "{finding:?}");
                findings.push(finding);
            }
        }
        let table = csv(&findings).expect("a table");
        assert_eq!(table.lines().count(), findings.len() + 1);
        assert!(summary(&findings).contains("pcss"));
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
