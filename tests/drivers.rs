//! The same shots on other drivers and with other widths of subgroups: how far apart the images are.

#[path = "command_line/program.rs"]
#[allow(dead_code)] // The command line's own tests use the rest.
mod program;

use std::process::Command;

use halfshade::image::{MAX_SAMPLES, read_exr};
use program::{Folder, scenes};

/// [visibility] Drivers place vertices on their grids of 1/256 texel each in their own way, which moves a contour by
/// a texel here and there; a map of 64 texels has some ten of them across the light, so that a pixel may be off by
/// a tenth, and hardly any is.
const MOST: f32 = 0.1;
const MEAN: f32 = 0.002;

/// The visibility of a scene of the repository, 32×32 pixels, in an environment of its own.
fn visibility(folder: &Folder, scene: &str, environment: &[(&str, Option<&str>)]) -> Vec<f32> {
    let file = folder.path("v.exr");
    let mut program = Command::new(env!("CARGO_BIN_EXE_halfshade"));
    program
        .arg("render")
        .arg(scenes().join(format!("{scene}.json")));
    program.args([
        "--size",
        "32x32",
        "--map",
        "64",
        "--split",
        "1",
        "--visibility",
    ]);
    program.arg(&file).env("XDG_DATA_HOME", "/nonexistent");
    for (name, value) in environment {
        match value {
            Some(value) => program.env(name, value),
            None => program.env_remove(name),
        };
    }
    let output = program.output().expect("the program starts");
    assert!(
        output.status.success(),
        "{environment:?}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    let mut channels = read_exr(&file, MAX_SAMPLES).expect("it was written");
    channels.remove(0).1.data
}

/// Subgroups only share work: under lavapipe not a bit depends on how many lanes there are. (Other drivers do not heed
/// the variable, and give the same image twice.)
#[test]
fn the_width_of_subgroups_does_not_matter() {
    let image = |width: &str| {
        // Caches of shaders and of pipelines do not tell widths apart.
        let cache = format!("{}/width-{width}", env!("CARGO_TARGET_TMPDIR"));
        let environment = [
            ("LP_NATIVE_VECTOR_WIDTH", Some(width)),
            ("MESA_SHADER_CACHE_DIR", Some(&*cache)),
            ("XDG_CACHE_HOME", Some(&*cache)),
        ];
        visibility(&Folder::new(), "plate", &environment)
    };
    let bits = |image: Vec<f32>| image.into_iter().map(f32::to_bits).collect::<Vec<_>>();
    assert!(
        bits(image("128")) == bits(image("256")),
        "4 and 8 lanes differ"
    );
}

/// The driver of this run, such as `tools/test.sh --driver` has chosen, against the system's own.
#[test]
fn drivers_agree() {
    for scene in ["plate", "tree"] {
        let here = visibility(&Folder::new(), scene, &[]);
        let own = visibility(&Folder::new(), scene, &[("VK_DRIVER_FILES", None)]);
        let surfaces = |image: &[f32]| image.iter().filter(|value| !value.is_nan()).count();
        let shared = here
            .iter()
            .zip(&own)
            .filter(|(a, b)| !a.is_nan() && !b.is_nan());
        let apart: Vec<f32> = shared.map(|(a, b)| (a - b).abs()).collect();
        // At silhouettes a pixel may see a surface on the one driver alone.
        let elsewhere = surfaces(&here).max(surfaces(&own)) - apart.len();
        let most = apart.iter().copied().fold(0.0, f32::max);
        let mean = apart.iter().sum::<f32>() / apart.len() as f32;
        println!(
            "{scene}: {most:.1e} at most, {mean:.1e} on the mean, {elsewhere} pixels elsewhere"
        );
        assert!(
            elsewhere <= 10,
            "{scene}: {elsewhere} pixels see a surface on one driver alone"
        );
        assert!(
            most <= MOST && mean <= MEAN,
            "{scene}: {most} at most, {mean} on the mean"
        );
    }
}
