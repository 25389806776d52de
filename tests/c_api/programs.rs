//! C programs against the library, each compiled and run; those with a device under the validation layer.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use halfshade::image::{MAX_SAMPLES, read_exr};
use serde_json::json;

use super::build::{Workshop, built, done, root};

/// The engine's vertex shader.
fn compile_shader(workshop: &Workshop) -> PathBuf {
    let source = fs::read_to_string(root().join("examples/shadow.vert")).expect("it is there");
    let compiler = shaderc::Compiler::new().expect("shaderc is there");
    let kind = shaderc::ShaderKind::Vertex;
    let words = compiler
        .compile_into_spirv(&source, kind, "shadow.vert", "main", None)
        .expect("it compiles");
    let path = workshop.path("shadow.spv");
    fs::write(&path, words.as_binary_u8()).expect("written");
    path
}

#[test]
fn an_engine_with_a_device_of_its_own_gets_its_shadows() {
    let workshop = Workshop::new();
    let source = root().join("examples/host_owned.c");
    let shader = compile_shader(&workshop);
    let program = workshop.compile(&source, &[]);
    for mode in ["meshes", "callback", "maps"] {
        done(Command::new(&program).args([mode, "4"]).arg(&shader));
    }
}

/// Under the sanitizers of the C compiler; with `tools/test.sh --slow` under valgrind as well, which also looks into the
/// library.
#[test]
fn memory_is_used_rightly() {
    let workshop = Workshop::new();
    let sanitizers = [
        "-fsanitize=address,undefined",
        "-fno-sanitize-recover",
        "-pthread",
    ];
    let hostile = root().join("tests/c_api/programs/hostile.c");
    done(&mut Command::new(workshop.compile(&hostile, &sanitizers)));
    let engine = workshop.compile(&root().join("examples/host_owned.c"), &sanitizers);
    // The driver keeps what it has compiled.
    done(
        Command::new(engine)
            .args(["meshes", "3"])
            .env("ASAN_OPTIONS", "detect_leaks=0"),
    );
    if std::env::var_os("HALFSHADE_SLOW").is_some() {
        let plain = workshop.compile(&hostile, &["-pthread"]);
        let options = [
            "--error-exitcode=9",
            "--leak-check=full",
            "--errors-for-leak-kinds=definite",
        ];
        done(Command::new("valgrind").args(options).arg(plain));
    }
}

#[test]
fn hostile_arguments_of_engines_end_with_a_code() {
    done(&mut compile(&Workshop::new(), "hostile_vulkan.c"));
}

#[test]
fn the_examples_of_the_readme_run() {
    let workshop = Workshop::new();
    let readme = fs::read_to_string(root().join("README.md")).expect("it is there");
    let blocks: Vec<&str> = readme
        .split("```c\n")
        .skip(1)
        .map(|rest| rest.split("```").next().expect("it ends"))
        .collect();
    assert_eq!(blocks.len(), 2, "one example for each tier");
    let standalone = workshop.path("readme.c");
    fs::write(&standalone, blocks[0]).expect("written");
    let program = workshop.compile(&standalone, &[]);
    let out = done(Command::new(program).current_dir(root()));
    assert!(out.contains("mean visibility 0."), "{out}");
    // The engine's objects are not there, so the second one is compiled only.
    let host = workshop.path("readme_host.c");
    fs::write(&host, blocks[1]).expect("written");
    workshop.compile(&host, &["-c"]);
}

#[test]
fn a_script_can_use_the_library() {
    let out = done(
        Command::new(python_with_numpy())
            .arg(root().join("examples/visibility.py"))
            .arg(root().join("scenes/plate.json"))
            .args(["--size", "32"])
            .env("HALFSHADE_LIBRARY", built("libhalfshade.so")),
    );
    let error: f64 = out
        .split("mean error ")
        .nth(1)
        .and_then(|rest| rest.split_whitespace().next())
        .and_then(|number| number.parse().ok())
        .expect("it says how far off it is");
    // 4x4 sub-lights with 512² maps on the plate: measured 0.0027 on average.
    assert!(error < 0.005, "{out}");
}

/// The first Python that has numpy: that of the user, or the system's.
fn python_with_numpy() -> &'static str {
    ["python3", "/usr/bin/python3"]
        .into_iter()
        .find(|python| {
            let probe = Command::new(python).args(["-c", "import numpy"]).output();
            probe.is_ok_and(|probe| probe.status.success())
        })
        .expect("a Python with numpy: tools/setup.sh installs python3-numpy")
}

fn compile(workshop: &Workshop, program: &str) -> Command {
    let source = root().join("tests/c_api/programs").join(program);
    Command::new(workshop.compile(&source, &["-pthread"]))
}

#[test]
fn the_standalone_tier_does_what_its_header_says() {
    let workshop = Workshop::new();
    let files = [
        root().join("scenes/plate.gltf"),
        workshop.path("absent.gltf"),
    ];
    done(compile(&workshop, "whole_tier.c").args(files));
}

#[test]
fn hostile_arguments_end_with_a_code() {
    let workshop = Workshop::new();
    done(&mut compile(&workshop, "hostile.c"));
    done(compile(&workshop, "hostile.c").arg("device"));
}

#[test]
fn eight_threads_with_contexts_of_their_own_agree() {
    done(&mut compile(&Workshop::new(), "threads.c"));
}

#[test]
fn a_thousand_cycles_keep_no_memory() {
    done(compile(&Workshop::new(), "cycles.c").arg("1000"));
}

#[test]
fn cycles_with_a_device_keep_no_memory() {
    let cycles = if std::env::var_os("HALFSHADE_SLOW").is_some() {
        "1000"
    } else {
        "40"
    };
    done(compile(&Workshop::new(), "cycles.c").args([cycles, "device"]));
}

/// A small shot of the plate that leaves all settings at their defaults, for the program and for C.
fn shot_file(workshop: &Workshop) -> PathBuf {
    let shot = json!({
        "scene": root().join("scenes/plate.gltf"),
        "camera": {"eye": [0, 4.6, 5.4], "target": [0, 0.25, 0], "vfov_deg": 36, "width": 48, "height": 32},
        "lights": [{"type": "disc", "center": [0, 3, 0], "normal": [0, -1, 0], "radius": 0.75}],
    });
    let path = workshop.path("shot.json");
    fs::write(&path, shot.to_string()).expect("written");
    path
}

#[test]
fn the_program_and_c_give_the_same_bits() {
    let workshop = Workshop::new();
    let shot = shot_file(&workshop);
    let (exr, raw) = (workshop.path("v.exr"), workshop.path("v.raw"));
    done(
        Command::new(env!("CARGO_BIN_EXE_halfshade"))
            .args(["render", "--visibility"])
            .args([&exr, &shot])
            .env("XDG_DATA_HOME", workshop.path("data")),
    );
    done(compile(&workshop, "same_shot.c").args([&shot, &raw]));
    let planes = read_exr(&exr, MAX_SAMPLES).expect("the program has written it");
    let expected: Vec<u8> = planes[0]
        .1
        .data
        .iter()
        .flat_map(|value| value.to_ne_bytes())
        .collect();
    assert_eq!(expected.len(), 48 * 32 * 4);
    assert!(
        expected == fs::read(&raw).expect("C has written it"),
        "the images differ"
    );
}
