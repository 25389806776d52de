//! `halfshade study` as a user runs it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::SystemTime;

use halfshade::technique::Technique;

use super::command::{at_home, program};

const PROGRAM: &str = env!("CARGO_BIN_EXE_halfshade");

fn plate() -> String {
    let root = env!("CARGO_MANIFEST_DIR");
    format!("{root}/scenes/plate.json")
}

/// A small sweep, as flags; truths are kept in `folder`.
fn small(folder: &Path) -> Vec<String> {
    let text = format!(
        "--techniques hard,pcss --maps 32,64 --size 16x16 --samples 16 --repeat 2 --truths {}",
        folder.join("truths").display()
    );
    text.split(' ').map(str::to_owned).collect()
}

fn study(arguments: &[&str], more: &[String]) -> Output {
    program()
        .arg("study")
        .args(arguments)
        .args(more)
        .output()
        .expect("the program runs")
}

fn said(output: &Output) -> String {
    let text = [&output.stdout[..], &output.stderr[..]].concat();
    String::from_utf8(text).expect("UTF-8")
}

/// When each run was written.
fn runs(folder: &Path) -> BTreeMap<PathBuf, SystemTime> {
    let entries = fs::read_dir(folder.join("runs")).expect("runs");
    let time = |path: &Path| {
        path.metadata()
            .and_then(|data| data.modified())
            .expect("a file")
    };
    entries
        .map(|entry| entry.expect("a file").path())
        .map(|path| {
            (
                PathBuf::from(path.file_name().expect("a name")),
                time(&path),
            )
        })
        .collect()
}

#[test]
fn it_goes_on_where_it_was_and_parts_make_the_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).display().to_string();
    let flags = small(folder.path());
    let run = |name: &str, more: &[&str]| {
        let (file, folder) = (plate(), at(name));
        let all = [&["pareto", &file, "-o", &folder], more].concat();
        let output = study(&all, &flags);
        assert!(output.status.success(), "{}", said(&output));
        runs(Path::new(&at(name)))
    };
    let whole = run("whole", &[]);
    // Hard shadows from the nearest sample and from 3×3, pcss; two maps.
    assert_eq!(whole.len(), 6);
    for file in ["results.csv", "results.json", "pareto.svg", "index.html"] {
        assert!(Path::new(&at("whole")).join(file).exists(), "{file}");
    }
    let again = run("whole", &[]);
    assert_eq!(whole, again, "a finished run was measured again");

    let parts = [
        run("first", &["--shard", "0/2"]),
        run("second", &["--shard", "1/2"]),
    ];
    assert_eq!(parts[0].len() + parts[1].len(), 6);
    let output = study(
        &["merge", &at("first"), &at("second"), "-o", &at("merged")],
        &[],
    );
    assert!(output.status.success(), "{}", said(&output));
    let merged = runs(Path::new(&at("merged")));
    assert!(merged.keys().eq(whole.keys()));
}

#[test]
fn the_batch_script_runs_one_part() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = at_home(&mut Command::new("bash"))
        .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/tools/study.sbatch"))
        .arg(folder.path().join("study"))
        .arg(plate())
        .args(small(folder.path()))
        .env("SLURM_ARRAY_TASK_ID", "1")
        .env("SLURM_ARRAY_TASK_COUNT", "3")
        .env("HALFSHADE", PROGRAM)
        .output()
        .expect("bash");
    assert!(output.status.success(), "{}", said(&output));
    assert_eq!(runs(&folder.path().join("study/part-1")).len(), 2);
}

#[test]
fn tuning_prints_a_command_or_says_how_near_it_comes() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = plate();
    let found = study(
        &["tune", &file, "--max-error", "0.9"],
        &small(folder.path()),
    );
    let text = said(&found);
    assert!(found.status.success(), "{text}");
    let command = text
        .lines()
        .find_map(|line| line.strip_prefix("use: halfshade "));
    let words: Vec<&str> = command.expect("a command").split(' ').collect();
    let picture = folder.path().join("picture.png");
    let rendered = program().args(words).arg("-o").arg(&picture).output();
    let rendered = rendered.expect("the program runs");
    assert!(rendered.status.success(), "{}", said(&rendered));
    assert!(picture.exists());

    let never = study(
        &["tune", &file, "--max-error", "1e-9"],
        &small(folder.path()),
    );
    assert_eq!(never.status.code(), Some(1));
    assert!(
        said(&never).contains("the nearest is 0."),
        "{}",
        said(&never)
    );
    for said_before in [
        "the truth's own noise with 16 rays a pixel",
        "it is traced with 65536",
        "with 65536 rays a pixel",
        "that error cannot be told",
    ] {
        assert!(said(&never).contains(said_before), "{}", said(&never));
    }
    assert!(!said(&found).contains("noise"), "{}", said(&found));
    let fast = study(&["tune", &file, "--max-ms", "1e5"], &small(folder.path()));
    assert!(fast.status.success(), "{}", said(&fast));
}

#[test]
fn wrong_use_is_refused_in_a_sentence() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("study").display().to_string();
    let file = plate();
    for (arguments, sentence, code) in [
        (
            vec!["pareto", &file, "-o", &out, "--shard", "3/3"],
            "I/N",
            2,
        ),
        (
            vec!["pareto", &file, "-o", &out, "--techniques", "raytracing"],
            "choose one of",
            2,
        ),
        (
            vec!["pareto", &file, "-o", &out, "--maps", "5"],
            "16 to 8192",
            2,
        ),
        (
            vec!["pareto", "nothing.json", "-o", &out],
            "nothing.json",
            1,
        ),
        (vec!["pareto", &file, "-o", &file], "plate.json", 1),
        (vec!["merge", &out, "-o", &out], "no run is finished", 1),
        (vec!["tune", &file], "--max-error", 2),
        (vec!["tune", &file, "--max-ms", "-1"], "--max-ms", 2),
    ] {
        let output = study(&arguments, &[]);
        let text = said(&output);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        assert!(text.contains(sentence), "{arguments:?}: {text}");
    }
}

#[test]
fn the_program_takes_the_flags_of_all_settings() {
    for settings in Technique::ALL
        .iter()
        .flat_map(|&technique| technique.variants())
    {
        let output = program()
            .args(["plan", &plate()])
            .args(settings.flags())
            .output()
            .expect("the program runs");
        assert!(output.status.success(), "{}", said(&output));
    }
}
