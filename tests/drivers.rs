//! The same shots on other drivers and with other widths of subgroups: how far apart the images are.

#[path = "command_line/program.rs"]
#[allow(dead_code)] // The command line's own tests use the rest.
mod program;

use halfshade::image::{MAX_SAMPLES, read_exr};
use program::{Folder, scenes};

/// [pixel] Width and height of the images.
const SIDE: usize = 32;
/// [visibility] Drivers place vertices on grids of their own, of 1/16 texel or finer, which moves a contour by
/// a texel here and there; a map of 64 texels has some ten of them across the light, so that a pixel may be off by
/// a tenth, and hardly any is.
const MOST: f32 = 0.1;
const MEAN: f32 = 0.002;

/// The visibility of a scene of the repository, 32×32 pixels, in an environment of its own.
fn visibility(folder: &Folder, scene: &str, environment: &[(&str, Option<&str>)]) -> Vec<f32> {
    let file = folder.path("v.exr");
    let mut program = folder.program();
    program
        .arg("render")
        .arg(scenes().join(format!("{scene}.json")));
    program.args([
        "--size",
        &format!("{SIDE}x{SIDE}"),
        "--map",
        "64",
        "--split",
        "1",
        "--visibility",
    ]);
    program.arg(&file);
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

/// [visibility] Local packets are those of a subgroup, and sum in another order with another width: some hundred areas in
/// f32, each with a rounding error of a few 1e-7 of the light.
const SUMS: f32 = 1e-5;

/// Subgroups share work and sum in an order of their own. (Other drivers do not heed the variable, and give the same image
/// twice.)
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
    let (four, eight) = (image("128"), image("256"));
    for (four, eight) in four.into_iter().zip(eight) {
        let alike = four.to_bits() == eight.to_bits() || (four - eight).abs() <= SUMS;
        assert!(alike, "{four} with 4 lanes, {eight} with 8");
    }
}

/// How far a value is from what the other image has in the pixel and the eight round it. Where a grid of 1/16 pixel
/// (SwiftShader; lavapipe's is 1/256) moves a silhouette past a pixel's centre, it sees what its neighbour saw.
fn apart(value: f32, other: &[f32], pixel: usize) -> f32 {
    let (x, y) = ((pixel % SIDE) as isize, (pixel / SIDE) as isize);
    let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
    let inside = around.filter(|&(x, y)| x.min(y) >= 0 && x.max(y) < SIDE as isize);
    let values = inside.map(|(x, y)| other[y as usize * SIDE + x as usize]);
    // A pixel without a surface, whose value is no number, bounds nothing.
    let (least, most) = values.fold(
        (f32::INFINITY, f32::NEG_INFINITY),
        |(least, most), value| (least.min(value), most.max(value)),
    );
    (least - value).max(value - most).max(0.0)
}

/// A scene's visibility on the driver of this run, such as `tools/test.sh --driver` has chosen, and on the system's own,
/// and the pixels that have a surface on both.
fn on_both(scene: &str) -> (Vec<f32>, Vec<f32>, Vec<usize>) {
    let here = visibility(&Folder::new(), scene, &[]);
    let own = visibility(&Folder::new(), scene, &[("VK_DRIVER_FILES", None)]);
    let surfaces = |image: &[f32]| image.iter().filter(|value| !value.is_nan()).count();
    let shared: Vec<usize> = (0..own.len())
        .filter(|&pixel| !here[pixel].is_nan() && !own[pixel].is_nan())
        .collect();
    // At silhouettes a pixel may see a surface on the one driver alone.
    let elsewhere = surfaces(&here).max(surfaces(&own)) - shared.len();
    assert!(
        elsewhere <= 10,
        "{scene}: {elsewhere} pixels see a surface on one driver alone"
    );
    (here, own, shared)
}

fn mean(values: &[f32]) -> f32 {
    values.iter().sum::<f32>() / values.len() as f32
}

#[test]
fn drivers_agree_pixel_by_pixel() {
    let (here, own, shared) = on_both("plate");
    let apart: Vec<f32> = shared
        .iter()
        .map(|&pixel| (here[pixel] - own[pixel]).abs())
        .collect();
    let most = apart.iter().copied().fold(0.0, f32::max);
    let mean = mean(&apart);
    println!("plate: {most:.1e} at most, {mean:.1e} on the mean");
    assert!(
        most <= MOST && mean <= MEAN,
        "plate: {most} at most, {mean} on the mean"
    );
}

/// Scenes with folds and leaves that are smaller than a pixel, where one in a hundred may be off by more than the others.
#[test]
fn drivers_agree_but_at_silhouettes() {
    for scene in ["knot", "tree"] {
        let (here, own, shared) = on_both(scene);
        let (near, far): (Vec<f32>, Vec<f32>) = shared
            .iter()
            .map(|&pixel| apart(here[pixel], &own, pixel))
            .partition(|&apart| apart <= MOST);
        let (far, mean) = (far.len(), mean(&near));
        println!("{scene}: {mean:.1e} on the mean, {far} by more than {MOST}");
        assert!(
            far * 100 <= shared.len() && mean <= MEAN,
            "{scene}: {far} by more than {MOST}, {mean} on the mean of the others"
        );
    }
}
