//! Outputs: none of them is a file that is read or another output, nor is called what it is not.

use std::fs;
use std::os::unix::fs::symlink;
use std::thread;

use super::program::{Folder, plate, scenes};
use halfshade::image::{MAX_SAMPLES, Plane, read_exr, read_png, write_exr, write_png};
use serde_json::{Value, json};

const QUICK: [&str; 6] = ["--split", "1", "--map", "16", "--size", "8x8"];

/// A shot whose scene has a buffer, an image that is read, and one that is not, all in a folder of their own.
fn whole_shot() -> Folder {
    let folder = Folder::new();
    fs::create_dir(folder.path("scene")).expect("a folder");
    let text = fs::read(scenes().join("plate.gltf")).expect("the scene");
    let mut gltf: Value = serde_json::from_slice(&text).expect("JSON");
    gltf["images"] = json!([{"uri": "colour.png"}, {"uri": "bumps%20.png"}]);
    gltf["textures"] = json!([{"source": 0}, {"source": 1}]);
    let materials = gltf["materials"].as_array_mut().expect("materials");
    for material in materials {
        material["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 0});
        material["normalTexture"] = json!({"index": 1});
    }
    folder.write("scene/plate.gltf", gltf.to_string());
    fs::copy(scenes().join("plate.bin"), folder.path("scene/plate.bin")).expect("a copy");
    for name in ["scene/colour.png", "scene/bumps .png"] {
        write_png(&folder.path(name), 2, 2, &[200; 12]).expect("a picture");
    }
    let mut shot = plate();
    shot["scene"] = json!("scene/plate.gltf");
    folder.write_shot(&shot);
    folder
}

/// Files that the shot is read from.
const READ: [&str; 5] = [
    "shot.json",
    "scene/plate.gltf",
    "scene/plate.bin",
    "scene/colour.png",
    "scene/bumps .png",
];

/// Runs a command that must be refused, with code 1 or 2, before it has written anything.
fn refuses(folder: &Folder, args: &[&str], word: &str) {
    let contents = || READ.map(|name| fs::read(folder.path(name)).expect("it is there"));
    let (before, names) = (contents(), folder.names());
    let run = folder.run(args);
    assert!(
        matches!(run.code, Some(1 | 2)),
        "{args:?}: {:?} {}",
        run.code,
        run.out
    );
    assert!(run.err.contains(word), "{args:?}: no {word} in {}", run.err);
    assert!(contents() == before && folder.names() == names, "{args:?}");
}

#[test]
fn what_is_read_is_not_written() {
    let folder = whole_shot();
    for name in READ {
        let spelt = format!("scene/../{name}");
        let (soft, hard) = (
            format!("soft-{}", &name[6..]),
            format!("hard-{}", &name[6..]),
        );
        symlink(folder.path(name), folder.path(&soft)).expect("a link");
        fs::hard_link(folder.path(name), folder.path(&hard)).expect("a link");
        // Without the program's own names for formats, which would be refused first.
        let (again, hidden) = (format!("{soft}-chain"), format!("{hard}-again"));
        symlink(&soft, folder.path(&again)).expect("a link");
        fs::hard_link(folder.path(name), folder.path(&hidden)).expect("a link");
        for output in [name, &spelt, &soft, &hard, &again, &hidden] {
            let says_other = [".json", ".gltf", ".png"]
                .iter()
                .any(|end| output.ends_with(end));
            for (flag, ends) in [
                ("-o", ".png"),
                ("--visibility", ".exr"),
                ("--stats", ".json"),
            ] {
                let word = match says_other && !output.ends_with(ends) {
                    true => "says another format",
                    false => "is read",
                };
                let args = [&["render", "shot.json", flag, output], &QUICK[..]].concat();
                refuses(&folder, &args, word);
            }
            let word = if says_other {
                "says another format"
            } else {
                "is read"
            };
            refuses(&folder, &["reference", "shot.json", "-o", output], word);
        }
    }
    // The scene alone as the shot; its neighbour as the output.
    let args = ["render", "scene/plate.gltf", "--stats", "shot.json"];
    let run = folder.run(&[&args[..], &QUICK].concat());
    assert_eq!(run.code, Some(0), "{}", run.err);
}

#[test]
fn what_is_compared_is_not_written() {
    let folder = Folder::new();
    let plane = Plane::new(2, 2, vec![0.5; 4]).expect("a plane");
    write_exr(&folder.path("a.exr"), &[("Y", &plane)]).expect("written");
    for name in ["a.png", "b.png"] {
        write_png(&folder.path(name), 2, 2, &[7; 12]).expect("written");
    }
    symlink("b.png", folder.path("link.png")).expect("a link");
    fs::hard_link(folder.path("a.exr"), folder.path("hard")).expect("a link");
    for (image, reference, output) in [
        ("a.png", "b.png", "a.png"),
        ("a.png", "b.png", "b.png"),
        ("a.png", "b.png", "./b.png"),
        ("a.png", "b.png", "link.png"),
        ("a.png", "link.png", "b.png"),
        ("a.exr", "a.exr", "hard"),
    ] {
        let args = ["compare", image, reference, "--heatmap", output];
        folder.refuses_usage(&args, &["is read"]);
    }
    folder.refuses_usage(
        &["compare", "a.exr", "a.exr", "--heatmap", "a.exr"],
        &["says another format"],
    );
    assert_eq!(
        read_png(&folder.path("b.png"), MAX_SAMPLES)
            .expect("it is there")
            .rgb8,
        [7; 12]
    );
    folder.does(&["compare", "a.exr", "a.exr", "--heatmap", "new.png"]);
    folder.does(&["compare", "a.exr", "a.exr", "--heatmap", "/dev/null"]);
}

#[test]
fn two_outputs_are_two_files() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    fs::create_dir(folder.path("sub")).expect("a folder");
    folder.write("old", "old");
    fs::hard_link(folder.path("old"), folder.path("hard")).expect("a link");
    symlink("new", folder.path("dangling")).expect("a link");
    symlink("dangling", folder.path("chain")).expect("a link");
    for (a, b) in [
        ("a", "a"),
        ("a", "./a"),
        ("a", "sub/../a"),
        ("old", "hard"),
        ("gone/a", "gone/a"),
        ("new", "dangling"),
        ("chain", "new"),
        ("chain", "dangling"),
    ] {
        for (first, second) in [
            ("-o", "--stats"),
            ("--visibility", "-o"),
            ("--stats", "--visibility"),
        ] {
            let args = ["render", "shot.json", first, a, second, b];
            folder.refuses_usage(&[&args[..], &QUICK].concat(), &["needs a file of its own"]);
        }
    }
    let null = [
        "-o",
        "/dev/null",
        "--visibility",
        "/dev/null",
        "--stats",
        "/dev/../dev/null",
    ];
    folder.does(&[&["render", "shot.json"], &null[..], &QUICK].concat());
}

#[test]
fn names_that_say_another_format() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    for (flag, name) in [
        ("-o", "a.jpg"),
        ("-o", "A.JPG"),
        ("-o", "a.exr"),
        ("-o", "a.glb"),
        ("--visibility", "v.png"),
        ("--visibility", "v.tiff"),
        ("--stats", "s.csv"),
        ("--stats", "s.yaml"),
    ] {
        folder.refuses_usage(
            &["render", "shot.json", flag, name],
            &["says another format"],
        );
    }
    folder.refuses_usage(
        &["reference", "shot.json", "-o", "r.png"],
        &["says another format"],
    );
    folder.refuses_usage(
        &["compare", "a.exr", "b.exr", "--heatmap", "h.jpg"],
        &["says another format"],
    );
    let files = ["-o", "A.PNG", "--visibility", "v", "--stats", "s.out"];
    folder.does(&[&["render", "shot.json"], &files[..], &QUICK].concat());
    assert_eq!(folder.names(), ["A.PNG", "s.out", "shot.json", "v"]);
}

#[test]
fn links_are_written_through() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    fs::create_dir(folder.path("sub")).expect("a folder");
    folder.write("sub/old.png", "old");
    for (target, link) in [
        ("sub/old.png", "old.png"),
        ("sub/new.exr", "dangling"),
        ("dangling", "chain.exr"),
        ("gone/s.json", "lost.json"),
        ("round.json", "round.json"),
    ] {
        symlink(target, folder.path(link)).expect("a link");
    }
    let files = ["-o", "old.png", "--visibility", "chain.exr"];
    folder.does(&[&["render", "shot.json"], &files[..], &QUICK].concat());
    assert_eq!(
        read_png(&folder.path("sub/old.png"), MAX_SAMPLES)
            .expect("a picture")
            .width,
        8
    );
    assert_eq!(
        read_exr(&folder.path("sub/new.exr"), MAX_SAMPLES)
            .expect("an image")
            .len(),
        1
    );
    for link in ["old.png", "dangling", "chain.exr"] {
        let kind = fs::symlink_metadata(folder.path(link)).expect("it is there");
        assert!(kind.is_symlink(), "{link}");
    }
    folder.refuses(
        &["render", "shot.json", "--stats", "lost.json"],
        &["does not exist"],
    );
    folder.refuses(
        &["render", "shot.json", "--stats", "round.json"],
        &["round.json"],
    );
    folder.refuses(&["render", "shot.json", "--stats", "sub/s/"], &["folder"]);
}

#[test]
fn pipes_and_standard_output_are_written_to() {
    let folder = Folder::new();
    folder.write_shot(&plate());
    let render = [&["render", "shot.json"], &QUICK[..]].concat();
    let text = folder.does(&[&render[..], &["--stats", "/dev/stdout"]].concat());
    let end = text.rfind("}\n").expect("JSON before the summary") + 1;
    let stats: Value = serde_json::from_str(&text[..end]).expect("JSON");
    assert_eq!(stats["size"], json!([8, 8]));

    let fifo = folder.path("fifo");
    let made = std::process::Command::new("mkfifo").arg(&fifo).status();
    assert!(made.expect("mkfifo, of coreutils").success());
    let reader = fifo.clone();
    let reader = thread::spawn(move || fs::read(reader).expect("it is written"));
    folder.does(&[&render[..], &["-o", "fifo"]].concat());
    let bytes = reader.join().expect("it was read");
    assert!(bytes.starts_with(b"\x89PNG"));
    assert!(!fs::symlink_metadata(&fifo).expect("it is there").is_file());
}

#[test]
fn studies_do_not_write_over_what_they_read() {
    let folder = whole_shot();
    fs::create_dir_all(folder.path("out/runs")).expect("a folder");
    for sub in ["pictures", "errors", "sheets"] {
        fs::create_dir(folder.path("out").join(sub)).expect("a folder");
    }
    let flags = "--techniques hard --maps 16 --samples 16 --repeat 1 --size 8x8 --truths truths";
    let flags: Vec<&str> = flags.split_whitespace().collect();
    let pareto = [&["study", "pareto", "shot.json", "-o", "out"], &flags[..]].concat();
    for (link, to) in [
        ("out/results.json", "shot.json"),
        ("out/pictures/a.png", "scene/colour.png"),
        ("out/pareto.svg", "scene/plate.bin"),
    ] {
        symlink(folder.path(to), folder.path(link)).expect("a link");
        refuses(&folder, &pareto, "is read");
        fs::remove_file(folder.path(link)).expect("it is there");
    }
    let figure = [
        "study",
        "figure",
        "equal-texels",
        "shot.json",
        "--quick",
        "-o",
        "figures",
    ];
    fs::create_dir(folder.path("figures")).expect("a folder");
    let link = folder.path("figures/equal-texels.svg");
    symlink(folder.path("scene/plate.gltf"), &link).expect("a link");
    refuses(&folder, &figure, "is read");

    let stored = folder.path("data/halfshade");
    fs::create_dir_all(&stored).expect("a folder");
    let devices: Value = serde_json::from_str(&folder.does(&["devices", "--json"])).expect("JSON");
    for device in devices.as_array().expect("a list") {
        let uuid = device["uuid"].as_str().expect("a name");
        let link = stored.join(format!("calibration-{uuid}.json"));
        symlink(folder.path("shot.json"), link).expect("a link");
    }
    let shot = fs::read(folder.path("shot.json")).expect("the shot");
    let calibrate = |more: &[&str]| {
        let mut program = folder.program();
        program.env("XDG_DATA_HOME", folder.path("data"));
        let output = program
            .args(["calibrate", "shot.json", "--quick"])
            .args(more)
            .output();
        output.expect("the program starts")
    };
    let refused = calibrate(&[]);
    let text = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(
        (refused.status.code(), text.contains("is read")),
        (Some(1), true),
        "{text}"
    );
    assert_eq!(fs::read(folder.path("shot.json")).expect("the shot"), shot);
}
