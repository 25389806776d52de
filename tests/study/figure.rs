//! Figures of the publications: that each runs, what it leaves, and that verdicts follow from the numbers.

use std::collections::BTreeSet;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use halfshade::shot::{Overrides, Shot};
use halfshade::study::figure::{
    EXPERIMENTS, Experiment, Lab, NamedShot, Report, Row, Scale, Verdict,
};
use halfshade::technique::Technique;
use serde_json::Value;

use super::command::program;
use super::made_up;
use super::support::with_gpu;

/// What the issue asks for.
const NAMES: [&str; 19] = [
    "yang09-fig8",
    "yang09-fig9",
    "yang09-fig11",
    "yang09-fig12",
    "yang09-fig13",
    "schwarz08-fig7",
    "schwarz08-fig8",
    "schwarz08-fig9",
    "schwarz08-table1",
    "schwarz08-table2",
    "atty06-fig14",
    "atty06-fig17",
    "atty06-fig18",
    "atty06-fig19",
    "atty06-fig20",
    "atty06-fig22",
    "atty06-fig24",
    "kirsch03-table1",
    "equal-texels",
];

#[test]
fn the_list_is_complete_and_says_what_is_claimed() {
    let names: Vec<&str> = EXPERIMENTS
        .iter()
        .map(|experiment| experiment.name)
        .collect();
    assert_eq!(names, NAMES);
    for experiment in &EXPERIMENTS {
        for text in [
            experiment.source,
            experiment.paper,
            experiment.claim,
            experiment.here,
            experiment.differs,
        ] {
            assert!(text.len() > 20, "{}: {text:?}", experiment.name);
        }
    }
}

/// Every figure at its smallest, on one device under the validation layer.
#[test]
fn every_figure_runs_and_leaves_its_files() {
    let folder = tempfile::tempdir().expect("a folder");
    with_gpu(|gpu| {
        for experiment in &EXPERIMENTS {
            let trials = experiment.trials(Scale::Quick, &[]).expect("trials");
            let shares = Mutex::new(Vec::new());
            let report = trials
                .measure(&Lab {
                    gpu,
                    truths: folder.path().join("truths"),
                    frames: None,
                    command: "halfshade study figure".into(),
                    interrupted: &AtomicBool::new(false),
                    progress: &|share, _| shares.lock().expect("no panic").push(share),
                })
                .expect("a report");
            let wanted: usize = trials
                .trials
                .iter()
                .map(|trial| trial.candidates.len())
                .sum();
            assert_eq!(report.rows.len(), wanted, "{}", experiment.name);
            check_rows(&report);
            report.write(folder.path()).expect("files");
            check_files(&report, folder.path());
            let shares = shares.into_inner().expect("no panic");
            assert!(shares.iter().all(|share| (0.0..=1.0).contains(share)));
            assert!(shares.last() > shares.first(), "{}", experiment.name);
        }
    });
}

/// No figure is missing.
fn check_rows(report: &Report) {
    for row in &report.rows {
        for column in report.experiment.columns {
            let value = (column.of)(row);
            let place = format!(
                "{}: {} of {}, {}",
                report.experiment.name, column.name, row.scene, row.series
            );
            assert!(
                value.is_finite(),
                "{place} is {value}: {:?}",
                row.run.outcome
            );
            assert!(value >= 0.0, "{place} is {value}");
        }
        // Truths are no noise: half of the error of nothing at all would be 0.25.
        assert!(row.error() < 0.4, "{}, {}", row.scene, row.series);
    }
}

fn check_files(report: &Report, folder: &std::path::Path) {
    let name = report.experiment.name;
    let read = |ending: &str| {
        std::fs::read_to_string(folder.join(format!("{name}.{ending}"))).expect("a file")
    };
    let csv = read("csv");
    assert_eq!(csv.lines().count(), report.rows.len() + 1, "{csv}");
    let json: Value = serde_json::from_str(&read("json")).expect("JSON");
    assert_eq!(
        json["rows"].as_array().map(Vec::len),
        Some(report.rows.len())
    );
    for key in ["device", "driver", "commit"] {
        assert!(
            json["machine"][key]
                .as_str()
                .is_some_and(|text| !text.is_empty())
        );
    }
    let svg = read("svg");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    for row in &report.rows {
        assert!(
            svg.contains(&row.series.replace('\'', "&apos;")),
            "{name}: {}",
            row.series
        );
    }
    let text = report.text();
    for part in [report.experiment.claim, "verdict: "] {
        assert!(text.contains(part), "{text}");
    }
    for check in &report.checks {
        assert!(text.contains(&check.found), "{text}");
    }
}

/// A made-up point of a curve.
fn row(scene: &str, series: &str, x: f64, ms: f64, error: f64) -> Row {
    Row {
        scene: scene.into(),
        series: series.into(),
        x,
        run: made_up::run(scene, Technique::Hard, ms, error),
    }
}

fn verdict(name: &str, rows: &[Row]) -> Verdict {
    Verdict::of(&Experiment::find(name).expect("a figure").judge(rows))
}

/// The same experiment is judged by what its rows say.
#[test]
fn verdicts_follow_from_the_numbers() {
    let series = "one pass";
    let heights = |errors: [f64; 4]| -> Vec<Row> {
        let points = [0.1, 0.3, 0.6, 0.9].into_iter().zip(errors);
        points
            .map(|(x, error)| row("knot", series, x, 1.0, error))
            .collect()
    };
    let fig20 = |errors| verdict("atty06-fig20", &heights(errors));
    assert_eq!(fig20([0.01, 0.02, 0.03, 0.04]), Verdict::SameTrend);
    // Equation 3 allows more.
    assert_eq!(fig20([0.04, 0.03, 0.02, 0.01]), Verdict::SameTrendInPart);
    assert_eq!(fig20([4.0, 3.0, 2.0, 1.0]), Verdict::Differs);

    let maps = |times: [f64; 3]| -> Vec<Row> {
        let points = [64.0f64, 128.0, 256.0].into_iter().zip(times);
        points
            .map(|(map, ms)| row("knot", series, map * map, ms, 0.01))
            .collect()
    };
    assert_eq!(
        verdict("atty06-fig22", &maps([1.0, 4.0, 16.0])),
        Verdict::SameTrend
    );
    assert_eq!(
        verdict("atty06-fig22", &maps([1.0, 2.0, 4.0])),
        Verdict::Differs
    );

    let techniques = |four_views: f64, error: f64| {
        [
            ("one view (GBP07)", 45.0, 0.1),
            ("packets, S = 2", 15.0, 0.05),
            ("packets, S = 4", four_views, error),
            ("4 layers, bitmask (SS07)", 77.0, 0.06),
            ("4 layers, depth peeling (BCS08)", 71.0, 0.05),
        ]
        .map(|(series, ms, error)| row("staircase", series, 1.0, ms, error))
    };
    // As in the paper; with four views slower than layers.
    for (four_views, error, expected) in [
        (55.0, 0.02, Verdict::SameTrend),
        (90.0, 0.02, Verdict::SameTrendInPart),
    ] {
        assert_eq!(
            verdict("yang09-fig11", &techniques(four_views, error)),
            expected
        );
    }
}

/// What could not be measured agrees with nothing.
#[test]
fn without_numbers_there_is_no_agreement() {
    for experiment in &EXPERIMENTS {
        let checks = experiment.judge(&[]);
        assert!(
            checks.iter().all(|check| !check.holds),
            "{}: {checks:?}",
            experiment.name
        );
        assert_eq!(Verdict::of(&checks), Verdict::Differs);
    }
}

#[test]
fn shots_are_taken_by_equal_texels_alone() {
    let overrides = Overrides {
        size: Some((8, 8)),
        ..Overrides::default()
    };
    let named = NamedShot {
        name: "mine".into(),
        shot: Shot::built_in("tree", &overrides).expect("a shot"),
    };
    let trials = |name: &str| {
        let experiment = Experiment::find(name).expect("a figure");
        experiment.trials(Scale::Usual, std::slice::from_ref(&named))
    };
    let own = trials("equal-texels").expect("trials");
    assert_eq!(own.trials.len(), 1);
    // As many texels in all, whatever the split.
    let texels = own.trials[0].candidates.iter().map(|candidate| {
        let settings = &candidate.settings;
        (candidate.series.clone(), settings.map * settings.split)
    });
    assert_eq!(texels.collect::<BTreeSet<_>>().len(), 2);
    let refused = trials("yang09-fig9").expect_err("it has scenes of its own");
    assert!(refused.to_string().contains("leave out the shots"));
}

fn figure(arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = program()
        .args(["study", "figure"])
        .args(arguments)
        .output()
        .expect("the program runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    (
        output.status.code(),
        text(output.stdout),
        text(output.stderr),
    )
}

#[test]
fn the_command_lists_refuses_and_measures() {
    let (code, list, _) = figure(&[]);
    assert_eq!(code, Some(0));
    for name in NAMES {
        assert!(list.contains(name), "{list}");
    }
    assert_eq!(figure(&["--list"]).1, list);
    let (code, out, err) = figure(&["yang09-fig99"]);
    assert_eq!((code, out.as_str()), (Some(2), ""), "{err}");
    assert!(
        err.contains("yang09-fig99") && err.contains("yang09-fig9,"),
        "{err}"
    );

    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).display().to_string();
    let (results, truths) = (at("results"), at("truths"));
    let (code, out, err) = figure(&[
        "schwarz08-table1",
        "--quick",
        "-o",
        &results,
        "--truths",
        &truths,
    ]);
    assert_eq!(code, Some(0), "{err}");
    assert!(
        out.contains("run here   one hierarchy") && out.contains("verdict: "),
        "{out}"
    );
    for ending in ["csv", "json", "svg"] {
        let file = folder
            .path()
            .join(format!("results/schwarz08-table1.{ending}"));
        assert!(file.exists(), "{ending}");
    }
}
