//! Studies: what they measure, that they go on where they were, that parts make a whole, and the page they end in.

#[path = "../command_line/program.rs"]
#[allow(dead_code)] // The command line's own tests use the rest.
mod command;
mod figure;
mod made_up;
mod page;
mod program;
mod stability;

#[path = "../support/gpu.rs"]
mod support;

use std::cell::RefCell;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use halfshade::Error;
use halfshade::image::Plane;
use halfshade::reference::ReferenceOptions;
use halfshade::render::DEFAULT_COSTS;
use halfshade::shot::Overrides;
use halfshade::study::{Bench, Folder, Outcome, Protocol, Subject, front};
use halfshade::technique::{Settings, Technique};
use support::with_gpu;

const PROTOCOL: Protocol = Protocol {
    repeat: 3,
    seconds: 60.0,
    counters: true,
    flicker_frames: 1,
    costs: DEFAULT_COSTS,
};

/// The plate, 32 pixels wide, with a truth of few rays.
fn subject(cache: &Path) -> Subject {
    let overrides = Overrides {
        size: Some((32, 32)),
        ..Overrides::default()
    };
    let options = ReferenceOptions {
        samples: 64,
        seed: 0,
    };
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/plate.json");
    let never = AtomicBool::new(false);
    Subject::load(&file, &overrides, cache, options, &|_| {}, &never).expect("the plate")
}

fn settings(technique: Technique) -> Settings {
    Settings {
        map: 64,
        split: 1,
        ..Settings::usual(technique)
    }
}

#[test]
fn a_group_is_measured_in_turns_and_survives_what_fails() {
    let folder = tempfile::tempdir().expect("a folder");
    let subject = subject(folder.path());
    let candidates = [
        settings(Technique::MicropatchHierarchical),
        // No such map: the run says so.
        Settings {
            map: 8,
            ..settings(Technique::Hard)
        },
        settings(Technique::Hard),
    ];
    with_gpu(|gpu| {
        let interrupted = AtomicBool::new(false);
        let bench = Bench::new(gpu, PROTOCOL, &interrupted);
        let runs = bench
            .measure(&subject, &candidates, &|_| {})
            .expect("it is measured");
        let labels: Vec<&str> = runs.iter().map(|(run, _)| run.label.as_str()).collect();
        let wanted: Vec<String> = candidates.iter().map(Settings::label).collect();
        assert_eq!(labels, wanted);
        let Outcome::Failed(reason) = &runs[1].0.outcome else {
            panic!("a map of 8 texels was rendered");
        };
        assert!(reason.contains("16 to 8192"), "{reason}");
        for (run, pictures) in [&runs[0], &runs[2]] {
            let measured = run.measured().expect("it is measured");
            assert_eq!((measured.frames, measured.warm), (3, true));
            let (parts, whole) = (
                measured.raster_ms.min + measured.compute_ms.min,
                measured.shadow_ms.max,
            );
            assert!(parts <= whole, "{parts} {whole}");
            assert!(measured.visibility_ms.median > 0.0);
            assert!(measured.counters["samples_read"] > 0);
            assert!(measured.errors.flicker.expect("it was asked for") >= 0.0);
            let pictures = pictures.as_ref().expect("it was rendered");
            assert_eq!((pictures.picture.width, pictures.error.height), (32, 32));
            let flags = run.settings.flags().join(" ");
            assert!(run.command.ends_with(&flags), "{}", run.command);
        }
        // A hard shadow of an area light is far off; micropatches of a plate are not.
        let error = |index: usize| {
            runs[index]
                .0
                .measured()
                .map(|m| m.errors.metrics.mae_shadow)
        };
        assert!(error(0) < Some(0.05), "{:?}", error(0));
        assert!(error(2) > Some(0.1), "{:?}", error(2));
        assert!(
            runs[0].0.measured().map(|m| m.errors.flip)
                < runs[2].0.measured().map(|m| m.errors.flip)
        );
    });
}

/// A first frame may have the driver's compiling in it, however little time a candidate has.
#[test]
fn a_time_is_that_of_a_frame_after_the_first() {
    let folder = tempfile::tempdir().expect("a folder");
    let subject = subject(folder.path());
    let candidates = [settings(Technique::Hard), settings(Technique::Pcss)];
    with_gpu(|gpu| {
        let interrupted = AtomicBool::new(false);
        let protocol = Protocol {
            seconds: 1e-9,
            counters: false,
            flicker_frames: 0,
            ..PROTOCOL
        };
        let frames = RefCell::new(Vec::new());
        let tick = |label: &str| frames.borrow_mut().push(label.to_owned());
        let bench = Bench::new(gpu, protocol, &interrupted);
        let runs = bench.measure(&subject, &candidates, &tick);
        for (run, _) in runs.expect("it is measured") {
            let measured = run.measured().expect("it is measured");
            assert_eq!((measured.frames, measured.warm), (1, true));
            assert!(measured.shadow_ms.median > 0.0);
            let rendered = frames.borrow();
            let own = rendered.iter().filter(|label| **label == run.label);
            assert_eq!(own.count(), 2, "one to warm up and one that is timed");
        }
    });
}

#[test]
fn the_noise_of_a_truth_is_its_standard_error_in_shadow() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut subject = subject(folder.path());
    let noise = subject.noise();
    assert!(noise > 0.0 && noise < 0.05, "{noise}");
    // Four pixels count by hand: one lit, one that faces a part of the light, one without a surface, one in shadow.
    let plane = |data: [f32; 4]| Plane::new(2, 2, data.to_vec()).expect("a plane");
    subject.visibility = plane([1.0, 0.5, f32::NAN, 0.5]);
    subject.facing = plane([1.0, 0.5, f32::NAN, 1.0]);
    subject.standard_error = plane([0.5, 0.5, f32::NAN, 0.25]);
    assert_eq!(subject.noise(), 0.25);
    subject.visibility.data[3] = 1.0;
    assert_eq!(subject.noise(), 0.0);
}

#[test]
fn an_interrupted_group_is_an_error() {
    let folder = tempfile::tempdir().expect("a folder");
    let subject = subject(folder.path());
    with_gpu(|gpu| {
        let interrupted = AtomicBool::new(true);
        let bench = Bench::new(gpu, PROTOCOL, &interrupted);
        let result = bench.measure(&subject, &[settings(Technique::Hard)], &|_| {});
        assert!(matches!(result, Err(Error::Interrupted)));
    });
}

#[test]
fn groups_hold_all_candidates_in_order() {
    let folder = tempfile::tempdir().expect("a folder");
    let subject = subject(folder.path());
    let all: Vec<Settings> = (0..20)
        .map(|index| Settings {
            map: 64 + index,
            ..settings(Technique::Hard)
        })
        .collect();
    with_gpu(|gpu| {
        let interrupted = AtomicBool::new(false);
        let bench = Bench::new(gpu, PROTOCOL, &interrupted);
        let groups = bench.groups(&subject, all.clone());
        assert!(groups.len() > 1 && groups.iter().all(|group| group.len() > 1));
        assert_eq!(groups.concat(), all);
    });
}

#[test]
fn a_truth_is_traced_once_and_again_if_its_file_is_damaged() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = subject(folder.path());
    let files = || -> Vec<_> {
        let entries = std::fs::read_dir(folder.path()).expect("the cache");
        entries.map(|entry| entry.expect("a file").path()).collect()
    };
    assert_eq!(files().len(), 1);
    let bytes = std::fs::read(&files()[0]).expect("the truth");
    std::fs::write(&files()[0], &bytes[..bytes.len() / 2]).expect("a damaged file");
    let second = subject(folder.path());
    assert_eq!(std::fs::read(&files()[0]).expect("the truth"), bytes);
    let bits = |subject: &Subject| -> Vec<u32> {
        subject
            .visibility
            .data
            .iter()
            .map(|v| v.to_bits())
            .collect()
    };
    assert_eq!(bits(&first), bits(&second));
}

#[test]
fn the_front_has_what_nothing_beats() {
    let run = |ms, error| made_up::run("plate", Technique::Hard, ms, error);
    let runs = [
        run(3.0, 0.1),
        run(1.0, 0.5),
        run(2.0, 0.5),
        run(4.0, 0.2),
        run(9.0, 0.0),
    ];
    let times: Vec<f64> = front(&runs)
        .iter()
        .filter_map(|run| Some(run.measured()?.shadow_ms.median))
        .collect();
    assert_eq!(times, [1.0, 3.0, 9.0]);
}

#[test]
fn merged_parts_are_the_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let keep = |name: &str, technique, ms| {
        let part = Folder::open(&at(name)).expect("a folder");
        let run = made_up::run("plate", technique, ms, 0.1);
        part.keep(&run, Some(&made_up::pictures())).expect("kept");
    };
    keep("a", Technique::Hard, 1.0);
    keep("b", Technique::Pcss, 2.0);
    // The same run again: the first stays.
    keep("b", Technique::Hard, 3.0);
    let whole = Folder::open(&at("whole")).expect("a folder");
    for part in ["a", "b"] {
        let part = Folder::existing(&at(part)).expect("a study");
        whole.merge(&part).expect("merged");
    }
    whole.report().expect("reports");
    let runs = whole.runs().expect("runs");
    let times: Vec<f64> = runs
        .iter()
        .filter_map(|run| Some(run.measured()?.shadow_ms.median))
        .collect();
    assert_eq!(times, [1.0, 2.0]);
    let table = std::fs::read_to_string(at("whole/results.csv")).expect("a table");
    assert_eq!(table.lines().count(), 3);
    assert!(Folder::existing(&at("nothing")).is_err());
    std::fs::create_dir(at("other")).expect("a folder");
    std::fs::write(at("other/letter.txt"), "dear").expect("a file");
    assert!(Folder::open(&at("other")).is_err());
}
