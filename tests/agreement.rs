//! Packets of any size, under either mapping and either leaf rule, with and without pruning, compute the
//! same visibility as every cell of every pixel's kernel: only the order of summation differs.

#[path = "support/gpu.rs"]
mod support;

use std::sync::Arc;

use glam::DVec3;
use halfshade::gpu::Gpu;
use halfshade::scene::LightShape;
use halfshade::shot::{Leaf, Mapping, Settings, Shot, Technique};
use support::{largest_difference, load, visibility, with_gpu};

/// [visibility] Rounding of sums of up to some hundred segments, each of the order of 1, in any order.
const ROUNDING: f32 = 1e-5;

const PACKETS: [(u32, u32); 7] = [(1, 1), (2, 2), (3, 3), (4, 2), (4, 4), (8, 4), (8, 8)];

/// Every combination.
fn all(base: &Settings) -> Vec<Settings> {
    let mut list = Vec::new();
    for packet in PACKETS {
        for mapping in [Mapping::Serial, Mapping::Lanes] {
            for leaf in [Leaf::Reprocess, Leaf::PerPixel] {
                for footprint_pruning in [false, true] {
                    // A packet of one pixel has no mapping and no leaf that is of two minds.
                    if packet != (1, 1) || (mapping, leaf) == (Mapping::Serial, Leaf::PerPixel) {
                        list.push(Settings {
                            packet,
                            mapping,
                            leaf,
                            footprint_pruning,
                            ..base.clone()
                        });
                    }
                }
            }
        }
    }
    list
}

/// Every pair of values of two settings at least once.
fn pairwise(base: &Settings) -> Vec<Settings> {
    // Rows of an orthogonal array: each packet with both values of everything, and each combination of two
    // of the other three.
    let mut list = Vec::new();
    for (index, packet) in PACKETS.into_iter().enumerate() {
        for half in [0, 1] {
            let bits = [index + half, index / 2 + half, index / 4 + index + half];
            let [serial, per_pixel, footprint_pruning] = bits.map(|bit| bit % 2 == 1);
            list.push(Settings {
                packet,
                mapping: if serial {
                    Mapping::Serial
                } else {
                    Mapping::Lanes
                },
                leaf: if per_pixel {
                    Leaf::PerPixel
                } else {
                    Leaf::Reprocess
                },
                footprint_pruning,
                ..base.clone()
            });
        }
    }
    list.push(Settings {
        technique: Technique::PixelContour,
        hierarchical: true,
        ..base.clone()
    });
    list
}

fn base(map: u32, split: u32) -> Settings {
    Settings {
        map,
        split,
        ..Settings::default()
    }
}

/// Compares with every cell of every kernel, pixel by pixel.
fn compare(gpu: &Arc<Gpu>, mut shot: Shot, name: &str, list: Vec<Settings>) {
    shot.settings.technique = Technique::PixelContour;
    let expected = visibility(gpu, &shot);
    let penumbra = expected
        .iter()
        .filter(|&&value| value > 0.0 && value < 1.0)
        .count();
    assert!(
        penumbra > 200,
        "{name}: only {penumbra} pixels in the penumbra"
    );
    let mut worst = 0.0f32;
    for settings in list {
        shot.settings = settings;
        let difference = largest_difference(&visibility(gpu, &shot), &expected);
        assert!(
            difference <= ROUNDING,
            "{name}: off by {difference} with {:?}",
            shot.settings
        );
        worst = worst.max(difference);
    }
    println!("{name}: {worst:.1e}");
}

fn compare_scene(name: &str, map: u32, split: u32, list: fn(&Settings) -> Vec<Settings>) {
    let base = base(map, split);
    let shot = load(name, 64, base.clone());
    with_gpu(|gpu| compare(gpu, shot, name, list(&base)));
}

#[test]
fn staircase_with_every_combination() {
    compare_scene("staircase", 128, 1, all);
}

#[test]
fn plate() {
    compare_scene("plate", 128, 2, pairwise);
}

#[test]
fn knot_under_parts_of_a_disc() {
    compare_scene("knot", 128, 2, pairwise);
}

#[test]
fn colonnade() {
    compare_scene("colonnade", 256, 1, pairwise);
}

#[test]
fn tree_with_masked_leaves() {
    compare_scene("tree", 256, 1, pairwise);
}

#[test]
fn grid() {
    compare_scene("grid", 128, 2, pairwise);
}

/// Kernels of nearly the whole map: a light three times as large, close above the bars.
#[test]
fn grid_with_kernels_as_large_as_the_map() {
    let base = base(160, 1);
    let mut shot = load("grid", 48, base.clone());
    shot.lights[0].shape = LightShape::Rect {
        u: DVec3::X * 2.4,
        v: DVec3::Z * 2.4,
    };
    with_gpu(|gpu| compare(gpu, shot, "grid, large light", pairwise(&base)));
}

/// Side faces, whose back-projection is of another kind.
#[test]
fn grid_from_close_above_with_side_faces() {
    // Larger maps have cells of contour beyond the turns that lavapipe allows a loop.
    let base = base(64, 1);
    let mut shot = load("grid", 64, base.clone());
    shot.lights[0].center.y = 1.2;
    with_gpu(|gpu| {
        let plan = halfshade::plan::plan(
            &shot,
            halfshade::plan::Outputs { picture: false },
            &gpu.limits,
            false,
        );
        let views = plan.expect("a plan").views().count();
        assert!(views > 1, "only {views} faces");
        compare(gpu, shot, "grid, side faces", pairwise(&base));
    });
}
