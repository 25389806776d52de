//! A small golden of every technique on every scene: means of visibility over 4×4 blocks of a 32×32 image.
//! `UPDATE_GOLDENS=1 cargo test --test techniques` rewrites them.

use std::fmt::Write;
use std::path::PathBuf;

use halfshade::gpu::Gpu;

use super::support::{self, SCENES, load, raster_grid, with_gpu};

/// [pixel]
const SIDE: usize = 32;
/// [block] In each direction.
const BLOCKS: usize = 4;
/// [visibility] Drivers may rasterize a texel on an edge differently, which in a hard shadow moves a block's 64 pixels
/// by a few. A grid of 1/16 pixel moves an edge of the picture past a row of pixels' centres in one block of sixteen:
/// 8 of 64 more (measured 0.10 on the colonnade, 0.15 on the bars of the grid).
fn tolerance(gpu: &Gpu) -> f32 {
    const FEW: f32 = 0.05;
    let coarse = raster_grid(gpu) > 1.0 / 64.0;
    if coarse { FEW + 0.125 } else { FEW }
}

fn path(scene: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/techniques/{scene}.txt"))
}

/// Means over the blocks, row by row; pixels without a surface count as lit.
fn block_means(visibility: &[f32]) -> Vec<f32> {
    let block = SIDE / BLOCKS;
    let mut sums = [0.0; BLOCKS * BLOCKS];
    for (index, value) in visibility.iter().enumerate() {
        let (x, y) = (index % SIDE / block, index / SIDE / block);
        sums[y * BLOCKS + x] += if value.is_nan() { 1.0 } else { *value };
    }
    sums.iter()
        .map(|sum| sum / (block * block) as f32)
        .collect()
}

fn check(scene: &str) {
    let mut lines = String::new();
    let golden = std::fs::read_to_string(path(scene)).unwrap_or_default();
    let update = std::env::var_os("UPDATE_GOLDENS").is_some();
    with_gpu(|gpu| {
        let tolerance = tolerance(gpu);
        for (name, settings) in super::siblings() {
            let visibility = support::visibility(gpu, &load(scene, SIDE as u32, settings));
            for value in visibility.iter().filter(|value| !value.is_nan()) {
                assert!((0.0..=1.0).contains(value), "{scene}, {name}: {value}");
            }
            let means = block_means(&visibility);
            let text: Vec<String> = means.iter().map(|mean| format!("{mean:.3}")).collect();
            writeln!(lines, "{name}: {}", text.join(" ")).expect("a string");
            if update {
                continue;
            }
            let line = golden
                .lines()
                .find_map(|line| line.strip_prefix(&format!("{name}: ")));
            let line = line.unwrap_or_else(|| panic!("{scene}: no golden of {name}"));
            let expected = line
                .split(' ')
                .map(|mean| mean.parse::<f32>().expect("a number"));
            for (block, (mean, expected)) in means.iter().zip(expected).enumerate() {
                assert!(
                    (mean - expected).abs() <= tolerance,
                    "{scene}, {name}, block {block}: {mean}, not {expected}"
                );
            }
        }
    });
    if update {
        std::fs::write(path(scene), lines).expect("the golden can be written");
    }
}

#[test]
fn every_technique_on_every_scene() {
    for scene in SCENES {
        check(scene);
    }
}
