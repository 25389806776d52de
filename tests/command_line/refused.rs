//! What is refused: with one sentence, and without a file.

use std::time::{Duration, Instant};

use halfshade::image::{Plane, write_exr, write_png};

use super::program::{Folder, plate, scenes};
use serde_json::{Value, json};

const RENDER: [&str; 6] = [
    "render",
    "shot.json",
    "-o",
    "a.png",
    "--visibility",
    "a.exr",
];

/// Renders the plate after a change to its shot, which must be refused.
fn refuses_shot(change: impl FnOnce(&mut Value), words: &[&str]) {
    let (folder, mut shot) = (Folder::new(), plate());
    change(&mut shot);
    folder.write_shot(&shot);
    folder.refuses(&RENDER, words);
}

/// lavapipe is no GPU: its shaders have no registers to tell of. `tools/static_cost.sh` asks a driver that has.
#[test]
fn costs_that_the_driver_does_not_tell() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    folder.refuses(
        &["shaders", "shot.json"],
        &["does not say what shaders cost"],
    );
}

#[test]
fn scenes_that_cannot_be_read() {
    let folder = Folder::new();
    folder.refuses(
        &["render", "no.json", "-o", "a.png"],
        &["no.json", "No such file"],
    );
    folder.write("text.glb", "this is no glTF");
    folder.refuses(&["render", "text.glb", "-o", "a.png"], &["text.glb"]);
    let glb = std::fs::read(scenes().join("knot.glb")).unwrap();
    folder.write("cut.glb", &glb[..glb.len() / 2]);
    folder.refuses(&["render", "cut.glb", "-o", "a.png"], &["cut.glb"]);
    let text = std::fs::read(scenes().join("plate.gltf")).unwrap();
    let mut gltf: Value = serde_json::from_slice(&text).unwrap();
    for accessor in gltf["accessors"].as_array_mut().unwrap() {
        accessor["count"] = json!(100_000);
    }
    folder.write("far.gltf", gltf.to_string());
    std::fs::copy(scenes().join("plate.bin"), folder.path("plate.bin")).unwrap();
    folder.refuses(&["render", "far.gltf", "-o", "a.png"], &["far.gltf"]);
}

#[test]
fn shots_that_are_none() {
    let folder = Folder::new();
    folder.write("shot.json", "scene: plate.gltf");
    folder.refuses(&RENDER, &["shot.json", "not a shot file"]);
    folder.write("shot.json", "[1, 2");
    folder.refuses(&RENDER, &["shot.json", "not a shot file"]);
    refuses_shot(|shot| shot["scene"] = json!("gone.glb"), &["gone.glb"]);
    let infinite = plate()
        .to_string()
        .replace("\"vfov_deg\":36", "\"vfov_deg\":1e999");
    folder.write("shot.json", infinite);
    folder.refuses(&RENDER, &["shot.json", "out of range"]);
    refuses_shot(
        |shot| shot["camera"]["vfov_deg"] = json!("NaN"),
        &["shot.json", "NaN"],
    );
}

#[test]
fn cameras_lights_and_sizes_that_make_no_sense() {
    refuses_shot(
        |shot| shot["camera"]["target"] = shot["camera"]["eye"].clone(),
        &["camera", "same point"],
    );
    refuses_shot(
        |shot| shot["lights"][0]["u"] = json!([0, 0, 0]),
        &["light 0", "zero"],
    );
    for side in [0, 100_000] {
        let words = [&*format!("{side}x{side}"), "32768"];
        refuses_shot(
            |shot| {
                shot["camera"]["width"] = json!(side);
                shot["camera"]["height"] = json!(side);
            },
            &words,
        );
    }
}

/// What the shot or the machine has no room for.
#[test]
fn values_that_the_shot_does_not_allow() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    for (flag, value, range) in [
        ("--light", "1", "there is no light 1"),
        ("--scene", "7", "has no scene 7"),
        ("--max-memory", "1KiB", "--max-memory allows 1.0 KiB"),
        (
            "--max-seconds",
            "0.001",
            "after the 0.001 s of --max-seconds",
        ),
    ] {
        folder.refuses(&[&RENDER[..], &[flag, value]].concat(), &[range]);
    }
    folder.refuses(
        &[&RENDER[..], &["--device", "abacus"]].concat(),
        &["abacus", "there are"],
    );
    let many = [
        &["reference", "shot.json", "-o", "r.exr"][..],
        &["--light", "7"],
    ]
    .concat();
    folder.refuses(&many, &["7"]);
}

#[test]
fn a_frame_that_takes_too_long_is_given_up() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    // Every cell of large kernels for every pixel: half a minute, most of it within a submission.
    let slow = ["--technique", "pixel-contour", "--size", "256x256"];
    let limited = [&RENDER[..], &slow, &["--max-seconds", "3"]].concat();
    let start = Instant::now();
    folder.refuses(
        &limited,
        &["after the 3 s of --max-seconds", "nothing was written"],
    );
    // Nor does the end of the process wait for the device.
    assert!(start.elapsed() < Duration::from_secs(15));
}

#[test]
fn wrong_usage() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    for (flag, value, word) in [
        ("--map", "0", "16 to 8192"),
        ("--map", "15", "16 to 8192"),
        ("--map", "8193", "16 to 8192"),
        ("--split", "0", "1 to 16"),
        ("--split", "17", "1 to 16"),
        ("--packet", "9x9", "1x1 to 8x8"),
        ("--mssm-bits", "24", "16 or 32"),
        ("--layers", "5", "1 to 4"),
        ("--light-samples", "7", "8 to 16"),
        ("--blocker-samples", "0", "1 to 1024"),
        ("--filter-samples", "1025", "1 to 1024"),
        ("--maps", "4097", "1 to 4096"),
        ("--bias", "NaN", "finite"),
        ("--bias", "inf", "finite"),
        ("--radius", "NaN", "from 0"),
        ("--sun-angle", "180", "less than 180"),
        ("--ambient", "inf", "finite"),
        ("--exposure", "inf", "auto"),
        ("--exposure", "128", "between -128 and 128"),
        ("--technique", "sorcery", "packet-contour"),
        ("--leaf", "oak", "per-pixel"),
        ("--mapping", "mercator", "lanes"),
        ("--size", "0x0", "32768"),
        ("--size", "100000x100000", "32768"),
        ("--packet", "4", "4x4"),
        ("--repeat", "0", "1..=10000"),
        ("--max-memory", "much", "512MiB"),
        ("--max-seconds", "0", "above 0"),
        ("--max-seconds", "1e300", "above 0"),
        ("--frobnicate", "1", "--frobnicate"),
    ] {
        folder.refuses_usage(&[&RENDER[..], &[flag, value]].concat(), &[word]);
    }
    folder.refuses_usage(&["paint", "shot.json"], &["paint"]);
    folder.refuses_usage(&["reference", "shot.json"], &["required"]);
    folder.refuses_usage(&["compare", "a.exr"], &["required"]);
    folder.refuses_usage(
        &["compare", "a.png", "b.exr"],
        &["cannot be compared with each other"],
    );
    for more in [&["--facing"][..], &["--channel", "Y1"]] {
        let args = [&["compare", "a.png", "b.png"], more].concat();
        folder.refuses_usage(&args, &["for .exr images"]);
    }
    folder.refuses_usage(&["plan", "shot.json", "--split", "17"], &["1 to 16"]);
    folder.refuses_usage(&["plan", "shot.json", "--radius=-1"], &["from 0"]);
    folder.refuses_usage(
        &["reference", "shot.json", "-o", "r.exr", "--samples", "8"],
        &["16..=65536"],
    );
    // Usage goes before what the machine or a file lacks.
    folder.refuses_usage(
        &[
            "render", "no.json", "--device", "abacus", "--map", "15", "-o", "no/a.png",
        ],
        &["16 to 8192"],
    );
}

/// Of the studies, none of which starts to measure.
#[test]
fn wrong_usage_of_studies() {
    let folder = Folder::new();
    let pareto = ["study", "pareto", "no.json", "-o", "out"];
    let tune = ["study", "tune", "no.json"];
    for (command, more, word) in [
        (&pareto[..], &["--maps", "512,15"][..], "16 to 8192"),
        (&pareto, &["--splits", "17"], "1 to 16"),
        (&pareto, &["--packets", "9x9"], "1x1 to 8x8"),
        (&pareto, &["--biases", "NaN"], "finite"),
        (&pareto, &["--seconds", "0"], "more than 0"),
        (&pareto, &["--seconds", "NaN"], "more than 0"),
        (&pareto, &["--repeat", "0"], "1..=10000"),
        (&pareto, &["--samples", "8"], "16..=65536"),
        (&pareto, &["--shard", "3/3"], "I/N"),
        // Whether a technique reads it or not.
        (
            &pareto,
            &["--techniques", "hard", "--layers", "1,9"],
            "1 to 4",
        ),
        (&tune, &["--max-error", "0"], "--max-error"),
        (&tune, &["--max-ms", "NaN"], "--max-ms"),
        (&tune, &[], "required"),
        (&tune, &["--max-ms", "1", "--splits", "0"], "1 to 16"),
        (
            &["study", "figure", "yang09-fig99"],
            &[],
            "there is no figure",
        ),
        (
            &["study", "figure", "yang09-fig9", "no.json"],
            &[],
            "leave out the shots",
        ),
        (&["study", "figure", "--quick"], &[], "required"),
        (&["study", "figure", "--repeat", "2"], &[], "required"),
        (&["study", "stability"], &["--case", "no such"], "no case"),
        (&["study", "stability"], &["-o", "a.json"], "another format"),
        (&["study", "merge", "part"], &[], "required"),
        (&["calibrate"], &["--seconds", "0"], "1..=86400"),
    ] {
        folder.refuses_usage(&[command, more].concat(), &[word]);
    }
}

#[test]
fn outputs_that_cannot_be_written() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    std::fs::create_dir(folder.path("taken")).unwrap();
    for flag in ["-o", "--visibility", "--stats"] {
        folder.refuses(&["render", "shot.json", flag, "no/a"], &["does not exist"]);
        folder.refuses(
            &["render", "shot.json", flag, "taken"],
            &["taken", "folder"],
        );
    }
    folder.refuses(
        &["reference", "shot.json", "-o", "no/a.exr"],
        &["does not exist"],
    );
    folder.refuses_usage(
        &["render", "shot.json"],
        &["nothing to write", "--visibility"],
    );
}

/// Root may write anywhere, so that there is nothing to refuse then.
#[cfg(unix)]
#[test]
fn a_folder_that_may_not_be_written() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    folder.write_shot(&plate());
    let locked = folder.path("locked");
    std::fs::create_dir(&locked).unwrap();
    std::fs::set_permissions(&locked, PermissionsExt::from_mode(0o555)).unwrap();
    let may_write = std::fs::write(locked.join("probe"), "").is_ok();
    if !may_write {
        folder.refuses(
            &["render", "shot.json", "-o", "locked/a.png"],
            &["ermission denied"],
        );
    }
    std::fs::set_permissions(&locked, PermissionsExt::from_mode(0o755)).unwrap();
}

#[test]
fn comparisons_that_make_no_sense() {
    let folder = Folder::new();
    folder.refuses(&["compare", "a.exr", "b.exr"], &["a.exr", "No such file"]);
    folder.write("a.exr", "no image");
    folder.refuses(
        &["compare", "a.exr", "a.exr", "--heatmap", "h.png"],
        &["a.exr"],
    );
}

#[test]
fn images_beyond_a_limit() {
    let folder = Folder::new();
    let plane = Plane::new(4, 3, vec![0.5; 12]).unwrap();
    write_exr(&folder.path("a.exr"), &[("Y", &plane)]).unwrap();
    write_png(&folder.path("a.png"), 4, 3, &[7; 36]).unwrap();
    for (file, samples) in [("a.exr", 12), ("a.png", 36)] {
        let compare = |limit: u64| {
            let limit = limit.to_string();
            ["compare", file, file, "--max-samples", &limit].map(str::to_owned)
        };
        let refused = compare(samples - 1);
        folder.refuses(
            &refused.each_ref().map(String::as_str),
            &[file, "4x3 pixels", "limit"],
        );
        folder.does(&compare(samples).each_ref().map(String::as_str));
    }
}
