//! Pixels that are joined from others instead of being integrated: which, against the twin, in every view; what they get; and how far
//! that is from the visibility that they would have had.

mod common;
#[path = "support/gpu.rs"]
mod support;

use std::sync::Arc;

use common::{MAP, SIZE, Traces, points, traces, with_device};
use glam::{DVec2, DVec3};
use halfshade::gpu::Gpu;
use halfshade::shared::{KERNEL_JOINED, KERNEL_PENUMBRA, Kernel, TILE_SIZE};
use halfshade::shot::Shot;
use halfshade::technique::{Evaluate, Settings, Technique};
use halfshade::twin::join;
use support::{Triangles, camera, rectangle_light, shot};

/// [share of the sub-light] Three interpolations between shares, each rounded to 24 bits.
const ROUNDING: f64 = 1e-6;
/// [share of the sub-light] Where pixels walk together, sums are rounded in another order: as passes err from their twins.
const SUMS: f64 = 1e-4;

/// A pixel's tile, and its place in it.
fn tile_and_place(pixel: usize) -> ([u32; 2], [u32; 2]) {
    let at = [pixel as u32 % SIZE, pixel as u32 / SIZE];
    (
        at.map(|i| i / TILE_SIZE * TILE_SIZE),
        at.map(|i| i % TILE_SIZE),
    )
}

/// The pixel at a place of a tile.
fn pixel_at([left, above]: [u32; 2], [column, row]: [u32; 2]) -> usize {
    ((above + row) * SIZE + left + column) as usize
}

/// The twin's kernels where some pixels are joined, from the device's where none is.
fn wanted(full: &[Kernel], grids: &[u32], sparsest: u32) -> Vec<Kernel> {
    let of_pixel = |pixel: usize| {
        let (tile, place) = tile_and_place(pixel);
        let kernel_at = |place| full[pixel_at(tile, place)];
        let found = join::joined_on(place, grids[pixel], sparsest, kernel_at);
        found.map_or(full[pixel], |grid| Kernel {
            status: KERNEL_JOINED,
            first: grid,
            ..Kernel::default()
        })
    };
    (0..full.len()).map(of_pixel).collect()
}

/// What a view hides: of joined pixels as the twin joins what it hides of others, of the others what it hides where none is joined.
fn check_view(full: &Traces, found: &Traces, tolerance: f64) {
    let weight = f64::from(full.planned.view.weight);
    for (pixel, kernel) in found.kernels.iter().enumerate() {
        let (tile, place) = tile_and_place(pixel);
        let hidden = |place| f64::from(found.occlusion[pixel_at(tile, place)]);
        let (wanted, tolerance) = match kernel.status {
            KERNEL_JOINED => (join::joined(place, kernel.first, hidden), ROUNDING),
            _ => (f64::from(full.occlusion[pixel]), tolerance),
        };
        let difference = (f64::from(found.occlusion[pixel]) - wanted).abs();
        assert!(
            difference <= tolerance * weight,
            "pixel {pixel}, {kernel:?}: {difference}"
        );
    }
}

/// Every view of a shot; `tolerance`: [share of the sub-light] of pixels that are integrated.
fn check(gpu: &Arc<Gpu>, scene: &str, settings: &Settings, tolerance: f64) {
    let mut shot = common::shot(scene);
    let set = |evaluate| Settings {
        evaluate,
        map: MAP,
        near_points: 0,
        counters: true,
        ..settings.clone()
    };
    shot.settings = set(Evaluate::Full);
    let mut full = common::renderer(gpu, &shot);
    for evaluate in [Evaluate::Half, Evaluate::Quarter] {
        shot.settings = set(evaluate);
        let mut sparse = common::renderer(gpu, &shot);
        let (mut penumbra, mut joined) = (0, 0);
        for view in 0..shot_views(&full) {
            let all = traces(&mut full, view);
            let found = traces(&mut sparse, view);
            if all.fit.level_count == 0 {
                continue;
            }
            let count = (SIZE * SIZE) as usize;
            let grids: Vec<u32> = sparse.read_buffer("grids", count).expect("grids");
            let points = points(&sparse);
            for (pixel, &found) in grids.iter().enumerate() {
                let (tile, place) = tile_and_place(pixel);
                let point = |place| points[pixel_at(tile, place)].map(|p| (p.position, p.normal));
                assert_eq!(found, join::grids(place, point), "pixel {pixel}");
            }
            assert_eq!(
                found.kernels,
                wanted(&all.kernels, &grids, evaluate.grids())
            );
            check_view(&all, &found, tolerance);
            let of_status = |kernels: &[Kernel], status| {
                kernels
                    .iter()
                    .filter(|kernel| kernel.status == status)
                    .count()
            };
            penumbra += of_status(&all.kernels, KERNEL_PENUMBRA);
            joined += of_status(&found.kernels, KERNEL_JOINED);
        }
        println!("{scene}, {evaluate}: {joined} of {penumbra} joined");
        assert!(4 * joined > penumbra, "{scene}: {joined} of {penumbra}");
    }
}

fn shot_views(renderer: &halfshade::render::Renderer) -> u32 {
    renderer.plan().lights[0].light.view_count
}

/// Pixel by pixel, what is integrated is so to the bit.
fn pixelwise(split: u32) -> Settings {
    Settings {
        packet: (1, 1),
        split,
        ..Settings::default()
    }
}

#[test]
fn the_pixels_of_one_view() {
    with_device(|gpu| check(gpu, "knot", &pixelwise(1), 0.0));
}

#[test]
fn the_pixels_of_several_views() {
    with_device(|gpu| check(gpu, "colonnade", &pixelwise(2), 0.0));
}

#[test]
fn the_pixels_of_packets() {
    with_device(|gpu| {
        for packet in [Settings::LOCAL, (4, 4)] {
            let settings = Settings {
                packet,
                split: 1,
                ..Settings::default()
            };
            check(gpu, "knot", &settings, SUMS);
        }
    });
}

#[test]
fn the_pixels_of_the_rivals() {
    with_device(|gpu| {
        for technique in [
            Technique::PixelContour,
            Technique::Micropatch,
            Technique::MicropatchHierarchical,
            Technique::Bitmask,
            Technique::DepthPeeling,
        ] {
            check(gpu, "plate", &Settings::usual(technique), 0.0);
        }
    });
}

/// [scene units] Half a side of the square light, how high it is, and how high the edge of what hides it.
const HALF: f64 = 0.75;
const LIGHT_HEIGHT: f64 = 4.0;
const EDGE_HEIGHT: f64 = 2.0;
/// [scene units] How high the eye is, and how much of the floor it sees along a side.
const EYE_HEIGHT: f64 = 1.9;
const SEEN: f64 = 3.3;

/// A floor in the penumbra of a straight edge, and on the right of `step` another `height` above it: seen from above, and lit from
/// the left.
fn floors(step: f64, height: f64, evaluate: Evaluate) -> Shot {
    let wide = [-6.0, 6.0];
    let scene = Triangles::new()
        .plate(EDGE_HEIGHT, &support::rectangle([-2.0, 8.0], wide))
        .floor([-4.0, 4.0], wide)
        .plate(height, &support::rectangle([step, 4.0], wide));
    let light = rectangle_light(DVec3::new(-4.0, LIGHT_HEIGHT, 0.0), DVec2::splat(HALF));
    let vfov = 2.0 * (SEEN / (2.0 * EYE_HEIGHT)).atan().to_degrees();
    let eye = camera(DVec3::Y * EYE_HEIGHT, DVec3::ZERO, vfov);
    let settings = Settings {
        split: 1,
        near_points: 0,
        counters: true,
        evaluate,
        ..Settings::default()
    };
    shot(scene.build(), eye, light, SIZE, settings)
}

/// Visibility, and how many pixels are integrated.
fn rendered(gpu: &Arc<Gpu>, shot: &Shot) -> (Vec<f32>, u32) {
    let mut renderer = common::renderer(gpu, shot);
    renderer.render().expect("a frame");
    let penumbra = renderer.counters().expect("counters").penumbra;
    (renderer.visibility(0).expect("visibility"), penumbra)
}

/// Largest error, and the share of pixels that are integrated, against a frame in which all are.
fn measured(gpu: &Arc<Gpu>, step: f64, height: f64, evaluate: Evaluate) -> (f64, f64) {
    let (full, all) = rendered(gpu, &floors(step, height, Evaluate::Full));
    let (found, some) = rendered(gpu, &floors(step, height, evaluate));
    let errors = full
        .iter()
        .zip(&found)
        .map(|(a, b)| f64::from((a - b).abs()));
    (errors.fold(0.0, f64::max), f64::from(some) / f64::from(all))
}

/// [visibility] The penumbra of a straight edge is linear but for its ends, where a line between pixels `gap` apart is off by a
/// quarter of what it changes by on the way.
fn bound(gap: f64, height: f64) -> f64 {
    let drop = (EDGE_HEIGHT - height) / (LIGHT_HEIGHT - EDGE_HEIGHT);
    let width = 2.0 * HALF * drop / (SEEN / f64::from(SIZE));
    0.25 * gap / width + SUMS
}

/// The largest gaps between rows of the two grids, in pixels, and the share of pixels on each. What is not amid penumbra is
/// integrated as well: a fifth at most.
const GRIDS: [(Evaluate, f64, f64); 2] = [
    (Evaluate::Half, 3.0, 1.0 / 4.0),
    (Evaluate::Quarter, 7.0, 1.0 / 16.0),
];

#[test]
fn a_wide_penumbra_on_flat_ground_hardly_changes() {
    with_device(|gpu| {
        for (evaluate, gap, share) in GRIDS {
            let (error, integrated) = measured(gpu, 4.0, 0.0, evaluate);
            println!("{evaluate}: off by {error:.4}, {integrated:.3} integrated");
            assert!(error <= bound(gap, 0.0), "{evaluate}: {error}");
            assert!(integrated <= share + 0.2, "{evaluate}: {integrated}");
        }
    });
}

/// From one floor to the other visibility jumps by a tenth, in the middle of tiles. Were pixels joined across the step, the nearest ones
/// would be off by most of that.
#[test]
fn nothing_is_joined_across_a_step() {
    with_device(|gpu| {
        for (evaluate, gap, _) in GRIDS {
            let (error, integrated) = measured(gpu, 0.1, 0.15, evaluate);
            println!("{evaluate}: off by {error:.4}, {integrated:.3} integrated");
            assert!(error <= bound(gap, 0.15), "{evaluate}: {error}");
        }
    });
}
