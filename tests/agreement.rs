//! Packets of any size, under either mapping and either leaf rule, with and without pruning, compute the
//! same visibility as every cell of every pixel's kernel: only the order of summation differs.

#[path = "support/gpu.rs"]
mod support;

use std::sync::Arc;

use glam::DVec3;
use halfshade::gpu::Gpu;
use halfshade::plan::{Outputs, plan};
use halfshade::scene::LightShape;
use halfshade::shot::Shot;
use halfshade::technique::{Hierarchy, Leaf, Mapping, Settings, Technique};
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

/// Every packet size once, with one of the eight combinations of the rest; which, `turn` says. All turns
/// together have every combination.
fn turned(base: &Settings, turn: usize) -> Vec<Settings> {
    let mut list = Vec::new();
    for (index, packet) in PACKETS.into_iter().enumerate() {
        let [lanes, reprocess, footprint_pruning] =
            [1, 2, 4].map(|bit| (3 * index + turn) & bit != 0);
        list.push(Settings {
            packet,
            mapping: if lanes {
                Mapping::Lanes
            } else {
                Mapping::Serial
            },
            leaf: if reprocess {
                Leaf::Reprocess
            } else {
                Leaf::PerPixel
            },
            footprint_pruning,
            ..base.clone()
        });
    }
    list.push(Settings {
        technique: Technique::PixelContour,
        hierarchical: true,
        ..base.clone()
    });
    list.push(Settings {
        mssm_bits: 16,
        ..base.clone()
    });
    list.extend(Hierarchy::ALL.iter().map(|&hierarchy| Settings {
        hierarchy,
        ..base.clone()
    }));
    list
}

fn base(map: u32, split: u32) -> Settings {
    Settings {
        map,
        split,
        near_points: 0,
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

fn compare_scene(name: &str, map: u32, split: u32, list: impl Fn(&Settings) -> Vec<Settings>) {
    let base = base(map, split);
    let shot = load(name, 64, base.clone());
    with_gpu(|gpu| compare(gpu, shot, name, list(&base)));
}

/// Every combination of this mapping, on the scene whose packets see most edges of most depths.
fn compare_all(mapping: Mapping) {
    let mut list = all(&base(128, 1));
    list.retain(|settings| settings.mapping == mapping);
    compare_scene("staircase", 128, 1, |_| list.clone());
}

#[test]
fn staircase_with_every_serial_combination() {
    compare_all(Mapping::Serial);
}

#[test]
fn staircase_with_every_combination_of_lanes() {
    compare_all(Mapping::Lanes);
}

#[test]
fn plate() {
    compare_scene("plate", 128, 2, |base| turned(base, 0));
}

#[test]
fn knot_under_parts_of_a_disc() {
    compare_scene("knot", 128, 2, |base| turned(base, 1));
}

#[test]
fn knot_under_a_disc() {
    compare_scene("knot", 128, 1, |base| turned(base, 2));
}

#[test]
fn colonnade() {
    compare_scene("colonnade", 256, 1, |base| turned(base, 3));
}

#[test]
fn tree_with_masked_leaves() {
    compare_scene("tree", 256, 1, |base| turned(base, 4));
}

#[test]
fn grid() {
    compare_scene("grid", 128, 2, |base| turned(base, 5));
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
    with_gpu(|gpu| compare(gpu, shot, "grid, large light", turned(&base, 6)));
}

/// Side faces, whose back-projection is of another kind.
#[test]
fn grid_from_close_above_with_side_faces() {
    // A larger map has kernels over all of which no driver lets a loop run.
    let base = base(64, 1);
    let mut shot = load("grid", 64, base.clone());
    shot.lights[0].center.y = 1.2;
    with_gpu(|gpu| {
        let outputs = Outputs { picture: false };
        let plan = plan(&shot, outputs, &gpu.limits).expect("a plan");
        let faces = plan.views().count();
        assert!(faces > 1, "only {faces} faces");
        compare(gpu, shot, "grid, side faces", turned(&base, 7));
    });
}
