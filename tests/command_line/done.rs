//! What works, and what it leaves.

use super::program::{Folder, plate, scenes};
use halfshade::image::{MAX_SAMPLES, read_exr, read_png};
use serde_json::{Value, json};

/// Cheap settings: a single view with a small map.
const QUICK: [&str; 4] = ["--split", "1", "--map", "64"];

fn quick(args: &[&'static str]) -> Vec<&'static str> {
    [args, &QUICK].concat()
}

fn keys(value: &Value) -> Vec<&str> {
    let keys = value.as_object().expect("a JSON object").keys();
    keys.map(String::as_str).collect()
}

#[test]
fn a_render_writes_picture_visibility_and_stats() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    let args = [
        "render",
        "shot.json",
        "-o",
        "a.png",
        "--visibility",
        "a.exr",
    ];
    let stats = [
        "--stats",
        "a.json",
        "--repeat",
        "2",
        "--counters",
        "--validate",
    ];
    let out = folder.does(&quick(&[&args[..], &stats].concat()));
    assert!(
        out.starts_with("24x16 on ") && out.lines().count() == 1,
        "{out}"
    );
    assert_eq!(folder.names(), ["a.exr", "a.json", "a.png", "shot.json"]);

    let picture = read_png(&folder.path("a.png"), MAX_SAMPLES).unwrap();
    assert_eq!((picture.width, picture.height), (24, 16));
    let channels = read_exr(&folder.path("a.exr"), MAX_SAMPLES).unwrap();
    assert_eq!(channels.len(), 1);
    let (name, plane) = &channels[0];
    assert_eq!((name.as_str(), plane.width, plane.height), ("Y", 24, 16));
    let sane = |value: &f32| value.is_nan() || (0.0..=1.0).contains(value);
    assert!(plane.data.iter().all(sane));
    assert!(plane.data.iter().any(|value| *value < 0.1));
    assert!(plane.data.contains(&1.0));
    check_stats(&serde_json::from_slice(&std::fs::read(folder.path("a.json")).unwrap()).unwrap());
}

fn check_stats(stats: &Value) {
    for key in [
        "device",
        "driver",
        "technique",
        "settings",
        "size",
        "frames",
        "passes",
        "total_gpu_ms",
        "counters",
        "memory_bytes",
        "validation_messages",
    ] {
        assert!(!stats[key].is_null(), "no {key}");
    }
    assert_eq!(stats["size"], json!([24, 16]));
    assert_eq!(stats["frames"], 2);
    assert_eq!(stats["validation_messages"], 0);
    assert_eq!(keys(&stats["total_gpu_ms"]), ["max", "median", "min"]);
    for pass in stats["passes"].as_array().unwrap() {
        assert_eq!(keys(pass), ["count", "gpu_ms", "name"]);
        assert_eq!(keys(&pass["gpu_ms"]), ["max", "median", "min"]);
    }
    let names: Vec<&str> = (stats["passes"].as_array().unwrap().iter())
        .filter_map(|pass| pass["name"].as_str())
        .collect();
    assert!(
        names.iter().any(|name| name.contains("visibility")),
        "{names:?}"
    );
    let mut counters = keys(&stats["counters"]);
    counters.sort_unstable();
    let expected = "coarse_levels coherent_packets edges_extracted lit nodes_visited packets penumbra pixels \
                    reprocessed_packets samples_read umbra";
    assert_eq!(counters.join(" "), expected);
    let memory = stats["memory_bytes"].as_object().unwrap();
    let sum: u64 = memory.values().filter_map(Value::as_u64).sum();
    assert_eq!(sum, 2 * memory["peak"].as_u64().unwrap());
}

#[test]
fn several_lights_have_a_channel_each() {
    let (folder, mut shot) = (Folder::new(), plate());
    // The second has no extent: its shadow is hard.
    let point = json!({"type": "disc", "center": [0, 3, 0], "radius": 0});
    shot["lights"].as_array_mut().unwrap().push(point);
    folder.write_shot(&shot);
    folder.does(&quick(&["render", "shot.json", "--visibility", "all.exr"]));
    let all = read_exr(&folder.path("all.exr"), MAX_SAMPLES).unwrap();
    let names: Vec<&str> = all.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["Y0", "Y1"]);
    let hard = &all[1].1.data;
    assert!(hard.iter().all(|&v| v.is_nan() || v == 0.0 || v == 1.0));
    assert!(hard.contains(&0.0) && hard.contains(&1.0));

    folder.does(&quick(&[
        "render",
        "shot.json",
        "--light",
        "1",
        "--visibility",
        "one.exr",
    ]));
    let one = read_exr(&folder.path("one.exr"), MAX_SAMPLES).unwrap();
    assert_eq!((one.len(), one[0].0.as_str()), (1, "Y"));
    let bits = |data: &[f32]| data.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&one[0].1.data), bits(hard));

    // One light of several against the visibility of that one alone, whichever is the reference.
    for pair in [["all.exr", "one.exr"], ["one.exr", "all.exr"]] {
        let compare =
            |channel| [&["compare"], &pair[..], &["--json", "--channel", channel]].concat();
        let metrics: Value = serde_json::from_str(&folder.does(&compare("Y1"))).unwrap();
        assert_eq!(metrics["max"], json!(0.0));
        let metrics: Value = serde_json::from_str(&folder.does(&compare("Y0"))).unwrap();
        assert!(metrics["max"].as_f64() > Some(0.0));
        folder.refuses(&compare("Y2"), &["has no channel Y2"]);
    }
    folder.refuses(
        &["compare", "one.exr", "one.exr", "--channel", "Y1"],
        &["has no channel Y1"],
    );
}

#[test]
fn a_plan_names_passes_memory_and_omissions() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    let text = folder.does(&["plan", "shot.json"]);
    for word in [
        "packet_visibility",
        "memory",
        "left out",
        "casts shadows",
        "shade",
    ] {
        assert!(text.contains(word), "no {word} in:\n{text}");
    }
    let text = folder.does(&["plan", "shot.json", "--visibility-only"]);
    assert!(text.contains("only visibility is asked for"), "{text}");
}

#[test]
fn devices_are_listed() {
    let folder = Folder::new();
    let text = folder.does(&["devices"]);
    assert!(text.contains("can run the engine"), "{text}");
    let list: Value = serde_json::from_str(&folder.does(&["devices", "--json"])).unwrap();
    let list = list.as_array().unwrap();
    assert_eq!(list.len(), text.lines().count());
    let expected = [
        "driver",
        "kind",
        "missing",
        "name",
        "subgroup_size",
        "subpixel_bits",
        "uuid",
        "vulkan",
    ];
    assert_eq!(keys(&list[0]), expected);
}

#[test]
fn a_reference_can_be_compared_with_itself() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    let out = folder.does(&["reference", "shot.json", "-o", "r.exr", "--samples", "16"]);
    assert!(
        out.starts_with("r.exr: 24×16 pixels, 16 rays each"),
        "{out}"
    );
    let mut names: Vec<_> = (read_exr(&folder.path("r.exr"), MAX_SAMPLES)
        .unwrap()
        .into_iter())
    .map(|(name, _)| name)
    .collect();
    names.sort();
    assert_eq!(names, ["Y", "facing", "stderr"]);
    let table = folder.does(&[
        "compare",
        "r.exr",
        "r.exr",
        "--facing",
        "--heatmap",
        "h.png",
    ]);
    assert!(table.contains("mean absolute error (MAE)"), "{table}");
    assert_eq!(
        read_png(&folder.path("h.png"), MAX_SAMPLES).unwrap().width,
        24
    );
    let json = folder.does(&["compare", "r.exr", "r.exr", "--json"]);
    let metrics: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(
        (&metrics["mae"], &metrics["rmse"]),
        (&json!(0.0), &json!(0.0))
    );
    let pictures = folder.does(&["compare", "h.png", "h.png", "--json"]);
    let metrics: Value = serde_json::from_str(&pictures).unwrap();
    assert_eq!(metrics["flip"], json!(0.0));
}

#[test]
fn a_gltf_brings_its_own_camera_and_light() {
    let scene = scenes().join("plate.gltf");
    let text = Folder::new().does(&["plan", scene.to_str().unwrap()]);
    assert!(text.contains("casts shadows"), "{text}");
}

#[test]
fn help_names_every_flag() {
    let shot = "--technique --packet --leaf --mapping --split --map --bias --no-footprint-pruning \
                --hierarchical --counters --size --radius --sun-angle --scene --camera --device --validate \
                --max-memory --allow-outside-paths --max-triangles --max-texels --max-expansion";
    let render =
        "--output --visibility --light --stats --repeat --max-seconds --exposure --ambient";
    let folder = Folder::new();
    for (command, flags) in [
        ("render", format!("{shot} {render}")),
        ("plan", format!("{shot} --visibility-only")),
        (
            "reference",
            "--output --samples --seed --size --light".into(),
        ),
        ("compare", "--heatmap --json --facing --channel".into()),
        ("devices", "--json".into()),
    ] {
        let help = folder.does(&[command, "--help"]);
        for flag in flags.split_whitespace() {
            let listed = |line: &str| line.contains(&format!("{flag} ")) || line.ends_with(flag);
            assert!(help.lines().any(listed), "{command} --help lacks {flag}");
        }
        assert!(folder.does(&["--help"]).contains(command));
    }
    let version = format!("halfshade {}\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(folder.does(&["--version"]), version);
}
