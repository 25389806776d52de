//! What is ignored is said, a sentence each, and nothing else is.

use std::path::Path;

use super::program::{Folder, plate, scenes};
use serde_json::{Value, json};

/// The notes on stderr of a run that does as it is told.
fn notes(folder: &Folder, args: &[&str]) -> Vec<String> {
    let run = folder.run(args);
    assert_eq!(run.code, Some(0), "{args:?}: {}", run.err);
    let note = |line: &str| line.strip_prefix("note: ").expect("a note").to_owned();
    run.err.lines().map(note).collect()
}

/// The flags that the notes on a plan of the shot name, when it is made with `flags`.
fn ignored(folder: &Folder, shot: &str, flags: &[&str]) -> Vec<String> {
    let notes = notes(folder, &[&["plan", shot], flags].concat());
    let flag = |note: &String| {
        let flag = note.split_once(" is ignored, for ").expect("a sentence").0;
        assert!(note.ends_with('.'), "{note}");
        flag.to_owned()
    };
    notes.iter().map(flag).collect()
}

#[test]
fn unknown_keys_are_noted_and_ignored() {
    let (folder, mut shot) = (Folder::new(), plate());
    shot["weather"] = json!("fine");
    shot["lights"][0]["mood"] = json!("warm");
    folder.write_shot(&shot);
    assert_eq!(
        notes(&folder, &["plan", "shot.json"]),
        [
            "The key \"lights.0.mood\" is ignored.",
            "The key \"weather\" is ignored."
        ]
    );
}

#[test]
fn what_is_for_people_is_ignored_silently() {
    let (folder, mut shot) = (Folder::new(), plate());
    for object in ["/camera", "/lights/0", ""] {
        let object = shot.pointer_mut(object).expect("it is there");
        object["name"] = json!("plate");
        object["what"] = json!("a penumbra");
    }
    folder.write_shot(&shot);
    folder.does(&["plan", "shot.json"]);
    for entry in std::fs::read_dir(scenes()).expect("the scenes") {
        let file = entry.expect("it is listed").path();
        if file
            .extension()
            .is_some_and(|extension| extension == "json")
        {
            let run = folder.run(&["plan", file.to_str().expect("UTF-8")]);
            assert_eq!(run.code, Some(0), "{}", run.err);
            assert!(!run.err.contains("ignored"), "{}", run.err);
        }
    }
}

#[test]
fn flags_that_a_technique_does_not_read() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    let of = |flags: &str| {
        let flags: Vec<&str> = flags.split_whitespace().collect();
        ignored(&folder, "shot.json", &flags).join(" ")
    };
    for (flags, ignored) in [
        ("--layers 2", "--layers"),
        (
            "--technique pixel-contour --packet 2x2 --leaf reprocess --mapping serial",
            "--packet --leaf --mapping",
        ),
        (
            "--technique pixel-contour --percentage-closer --hierarchical",
            "--percentage-closer",
        ),
        (
            "--technique hard --percentage-closer --mssm-bits 16",
            "--mssm-bits",
        ),
        ("--technique reference-maps --maps 4 --split 1", "--split"),
        (
            "--technique pcss --filter-samples 8 --light-samples 8 --pattern regular",
            "--light-samples --pattern",
        ),
        (
            "--technique micropatch-hierarchical --no-gap-filling --occluders contours",
            "--occluders",
        ),
        (
            "--technique bitmask --layers 2 --no-gap-filling --no-footprint-pruning",
            "--no-footprint-pruning --no-gap-filling",
        ),
        ("--packet 1x1 --leaf per-pixel", "--leaf"),
        // Read, or no setting of a technique; a default that is named is given all the same.
        (
            "--packet 2x2 --leaf per-pixel --mapping lanes --split 1 --map 64 --bias 1 --mssm-bits 16",
            "",
        ),
        (
            "--size 8x8 --scene 0 --visibility-only --allow-outside-paths",
            "",
        ),
        ("--blocker-samples 16", "--blocker-samples"),
        ("", ""),
    ] {
        assert_eq!(of(flags), ignored, "{flags}");
    }
}

#[test]
fn flags_that_lights_without_extent_do_not_read() {
    let (folder, mut shot) = (Folder::new(), plate());
    let point = json!({"type": "disc", "center": [0, 3, 0], "normal": [0, -1, 0], "radius": 0});
    let flags = [
        "--technique",
        "pcss",
        "--split",
        "2",
        "--map",
        "64",
        "--packet",
        "2x2",
    ];
    shot["lights"]
        .as_array_mut()
        .expect("lights")
        .push(point.clone());
    folder.write_shot(&shot);
    // One of the lights has an extent.
    assert_eq!(ignored(&folder, "shot.json", &flags), ["--packet"]);
    shot["lights"] = json!([point]);
    folder.write_shot(&shot);
    assert_eq!(
        ignored(&folder, "shot.json", &flags),
        ["--technique", "--split", "--packet"]
    );
    let hard = ["--technique", "hard", "--percentage-closer", "--bias", "1"];
    assert!(ignored(&folder, "shot.json", &hard).is_empty());
    let trace = ["reference", "shot.json", "-o", "r.exr", "--light", "0"];
    folder.does(&trace);
    let told = notes(
        &folder,
        &[&trace[..], &["--samples", "16", "--seed", "1"]].concat(),
    );
    assert_eq!(told.len(), 2, "{told:?}");
}

/// The plate's scene with a point light, in the folder, without its area light if so wished.
fn write_point_light_scene(folder: &Folder) {
    let text = std::fs::read(scenes().join("plate.gltf")).expect("the scene");
    let mut gltf: Value = serde_json::from_slice(&text).expect("JSON");
    gltf["extensions"]["KHR_lights_punctual"] = json!({"lights": [{"type": "point"}]});
    let nodes = gltf["nodes"].as_array_mut().expect("nodes");
    let lamp = nodes.len();
    nodes.push(json!({
        "translation": [0, 3, 0],
        "extensions": {"KHR_lights_punctual": {"light": 0}},
    }));
    gltf["scenes"][0]["nodes"]
        .as_array_mut()
        .expect("nodes")
        .push(json!(lamp));
    folder.write("lamp.gltf", gltf.to_string());
    let buffer = Path::new("plate.bin");
    std::fs::copy(scenes().join(buffer), folder.path("plate.bin")).expect("a copy");
}

#[test]
fn flags_that_the_shot_does_not_read() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    let flags = ["--radius", "0.5", "--sun-angle", "1", "--camera", "0"];
    assert_eq!(
        ignored(&folder, "shot.json", &flags),
        ["--radius", "--sun-angle", "--camera"]
    );
    // The scene brings a camera, and no point light.
    let scene = scenes().join("plate.gltf");
    let scene = scene.to_str().expect("UTF-8");
    assert_eq!(ignored(&folder, scene, &flags), ["--radius", "--sun-angle"]);

    write_point_light_scene(&folder);
    let told = notes(
        &folder,
        &["plan", "lamp.gltf", "--radius", "0.5", "--camera", "0"],
    );
    assert!(told.iter().all(|note| !note.starts_with("--")), "{told:?}");
    let told = notes(&folder, &["plan", "lamp.gltf"]);
    assert!(
        told.iter().any(|note| note.contains("pass --radius")),
        "{told:?}"
    );
    // With lights of its own, a shot has no use for the scene's, nor for advice about them.
    let mut shot = plate();
    shot["scene"] = json!("lamp.gltf");
    folder.write_shot(&shot);
    folder.does(&["plan", "shot.json"]);
    assert_eq!(
        ignored(&folder, "shot.json", &flags),
        ["--radius", "--sun-angle", "--camera"]
    );
}

#[test]
fn stats_have_all_notes() {
    let (folder, mut shot) = (Folder::new(), plate());
    let stats = || -> Value {
        serde_json::from_slice(&std::fs::read(folder.path("s.json")).expect("stats")).expect("JSON")
    };
    let render = [
        "render",
        "shot.json",
        "--map",
        "64",
        "--split",
        "1",
        "--stats",
        "s.json",
    ];
    folder.write_shot(&shot);
    folder.does(&render);
    assert_eq!(stats()["notes"], json!([]));
    shot["weather"] = json!("fine");
    folder.write_shot(&shot);
    let more = [
        "--layers",
        "2",
        "--radius",
        "1",
        "--light",
        "0",
        "--exposure",
        "1",
        "--ambient",
        "0",
    ];
    let told = notes(&folder, &[&render[..], &more].concat());
    assert_eq!(stats()["notes"], json!(told));
    for (note, word) in told.iter().zip([
        "weather", "radius", "layers", "light", "exposure", "ambient",
    ]) {
        assert!(note.contains(word), "{note}: {word}");
    }
    assert_eq!(told.len(), 6);
    let counted = [
        "render",
        "shot.json",
        "--map",
        "64",
        "--split",
        "1",
        "-o",
        "/dev/null",
        "--counters",
    ];
    assert!(notes(&folder, &counted)[1].contains("--counters is ignored"));
}

#[test]
fn sweeps_name_what_none_of_their_techniques_reads() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    let small = "--maps 16 --samples 16 --repeat 1 --size 8x8 --truths truths --techniques hard --packets 2x2 --splits 1 \
                 --reference-maps 4";
    let sweep = ["study", "pareto", "shot.json", "-o", "out"];
    let flags: Vec<&str> = small.split_whitespace().collect();
    assert_eq!(
        notes(&folder, &[&sweep[..], &flags].concat()),
        [
            "--packets is ignored, for none of the techniques reads it.",
            "--reference-maps is ignored, for none of the techniques reads it."
        ]
    );
    let report = [&sweep[..], &["--report-only", "--repeat", "2"]].concat();
    assert_eq!(
        notes(&folder, &report),
        ["--repeat is ignored, for --report-only measures nothing."]
    );
}

/// Zero has no sign, whether nothing was added up or something was rounded.
#[test]
fn zero_is_never_negative() {
    let (folder, mut shot) = (Folder::new(), plate());
    // Nothing is in the light's way: no pass integrates visibility, no pixel is in shadow.
    shot["lights"][0]["center"] = json!([0, -3, 0]);
    shot["lights"].as_array_mut().expect("lights").truncate(1);
    folder.write_shot(&shot);
    let render = [
        "render",
        "shot.json",
        "--map",
        "64",
        "--split",
        "1",
        "--bias=-0.0",
    ];
    let files = ["--visibility", "v.exr", "--stats", "s.json"];
    let run = folder.run(&[&render[..], &files].concat());
    assert_eq!(run.code, Some(0), "{}", run.err);
    let said = run.out;
    let stats = std::fs::read_to_string(folder.path("s.json")).expect("stats");

    let lit = [1.0; 4];
    let nearly = [1.0, 1.0, 1.0, 1.0 - 1e-7];
    for (name, data) in [("lit.exr", lit), ("nearly.exr", nearly)] {
        let plane = halfshade::image::Plane::new(2, 2, data.to_vec()).expect("a plane");
        halfshade::image::write_exr(&folder.path(name), &[("Y", &plane)]).expect("written");
    }
    let compare =
        |more: &[&str]| folder.does(&[&["compare", "nearly.exr", "lit.exr"], more].concat());
    let (table, json) = (compare(&[]), compare(&["--json"]));
    assert!(
        json.contains("\"shadow_pixels\":0") && json.contains("\"bias\":-"),
        "{json}"
    );
    for text in [said, stats, table, json] {
        let words = text.split(|c: char| !(c.is_ascii_digit() || c == '-' || c == '.' || c == 'e'));
        let negative = |word: &&str| word.starts_with('-') && word.parse() == Ok(0.0);
        assert_eq!(words.filter(negative).count(), 0, "{text}");
    }
}

/// A picture that is not what was asked for says so, on standard error and in the stats.
#[test]
fn what_lights_or_sees_nothing_is_told() {
    type Change = fn(&mut Value);
    let shots: [(&str, Change); 3] = [
        ("it shines along (0.000, 1.000, 0.000)", |shot| {
            // u and v swapped.
            let light = &mut shot["lights"][0];
            let u = light["u"].take();
            light["u"] = light["v"].take();
            light["v"] = u;
        }),
        ("The camera sees no surface", |shot| {
            shot["camera"]["target"] = json!([0, 100, 0]);
        }),
        ("away, where depths are rounded", |shot| {
            let light = &mut shot["lights"][0];
            light["center"] = json!([0, 1e5, 0]);
        }),
    ];
    for (expected, change) in shots {
        let (folder, mut shot) = (Folder::new(), plate());
        shot["lights"].as_array_mut().expect("lights").truncate(1);
        change(&mut shot);
        folder.write_shot(&shot);
        let quick = ["--map", "64", "--split", "1", "--stats", "s.json"];
        let run = folder.run(&[&["render", "shot.json"], &quick[..]].concat());
        assert_eq!(run.code, Some(0), "{}", run.err);
        assert!(run.err.contains(expected), "{expected}: {}", run.err);
        let stats = std::fs::read_to_string(folder.path("s.json")).expect("stats");
        assert!(stats.contains(expected), "{expected}: {stats}");
    }
}
