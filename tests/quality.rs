//! Levels of quality [Schwarz08 §4, §6]: coarser maps, levels, their smoothing and the visibility that is blended from two of
//! them against scalar twins, in every view of some scenes; and what budgets promise.

mod common;

use std::collections::BTreeMap;
use std::sync::Arc;

use common::{MAP, Point, SIZE, Traces, points, renderer, shot, traces, with_device};
use glam::Vec3;
use halfshade::gpu::Gpu;
use halfshade::image::Plane;
use halfshade::render::Renderer;
use halfshade::shared::{KERNEL_LIT, KERNEL_PENUMBRA, KERNEL_UMBRA, LEAST_BUDGET};
use halfshade::shot::Shot;
use halfshade::technique::{Hierarchy as Density, Leaf, Mapping, Occluders, Settings, Technique};
use halfshade::twin::contour::ShadowMap;
use halfshade::twin::hierarchy::Hierarchy;
use halfshade::twin::kernels::{kernel_of, unpacked};
use halfshade::twin::microrect::{Level, Rect};
use halfshade::twin::quality::{Budget, CoarseMap, Surface, fit_at, receiver_at};
use halfshade::twin::radial::SubLight;
use halfshade::twin::receiver::{Receiver, in_view, project};

/// [visibility] As that of passes.rs.
const TOLERANCE: f64 = 1e-4;
/// [level] Of logarithms and means of eleven.
const LEVEL_TOLERANCE: f32 = 1e-4;
/// [pixel] One in so many is integrated by the twin.
const STEP: usize = 7;

fn budget_of(settings: &Settings) -> Budget {
    Budget {
        texels: settings.budget.expect("a budget") as f32,
        levels: settings.coarse_levels().expect("levels"),
        grows: settings.query_growth,
    }
}

fn map_of(traces: &Traces) -> ShadowMap<'_> {
    ShadowMap {
        size: MAP as i32,
        depths: &traces.map,
    }
}

/// A pixel's receiver, where the view looks at it.
fn receiver(traces: &Traces, point: &Point) -> Option<Receiver> {
    let view = &traces.planned.view;
    let to_point = point.position - Vec3::from(view.center);
    let oblique = traces.planned.oblique;
    in_view(view, point.position, point.normal)
        .then(|| project(view, &traces.fit, oblique, to_point, point.normal))
}

/// The twin's levels of the map, equal to the device's in every bit.
fn check_coarse_map(renderer: &Renderer, traces: &Traces, levels: u32) -> CoarseMap {
    let coarse = CoarseMap::new(&map_of(traces), levels);
    // The sides halve, from half of the map's, a power of two.
    let last = MAP >> levels;
    let count = (MAP * MAP - last * last) / 3;
    let found: Vec<[f32; 2]> = renderer
        .read_buffer("coarse_map", count as usize)
        .expect("coarse_map");
    let wanted = (1..=levels).flat_map(|level| coarse.level(level));
    assert!(found.iter().eq(wanted));
    coarse
}

/// Kernels as the twin has them where queries grow, and the levels that their budgets take, smoothed; returns the device's.
fn check_levels(
    renderer: &Renderer,
    settings: &Settings,
    traces: &Traces,
    points: &[Option<Point>],
) -> Vec<f32> {
    let (budget, map) = (budget_of(settings), map_of(traces));
    let (count, most) = (traces.fit.level_count, traces.planned.view.levels_max);
    let density = settings.hierarchy.density(MAP);
    let hierarchy = Hierarchy::new(map, density, count, most, settings.mssm_bits);
    let (view, oblique) = (&traces.planned.view, traces.planned.oblique);
    let mut levels = vec![0.0; points.len()];
    let mut whole = 0;
    for (i, (point, found)) in points.iter().zip(&traces.kernels).enumerate() {
        let Some(receiver) = point.as_ref().and_then(|point| receiver(traces, point)) else {
            continue;
        };
        let wanted = kernel_of(
            view,
            oblique,
            &receiver,
            &map,
            &hierarchy,
            Some(&budget),
            1.0,
        );
        assert_eq!(*found, wanted, "pixel {i}");
        if found.status == KERNEL_PENUMBRA {
            let cells = (unpacked(found.first), unpacked(found.last));
            levels[i] = budget.quality(cells);
            whole += budget.level(cells);
        }
    }
    let [before, after] = &traces.counters;
    assert_eq!(after.coarse_levels - before.coarse_levels, whole);
    let of_points = points
        .iter()
        .map(|point| point.map(|p| (p.position, p.normal)));
    let surface = Surface {
        size: [SIZE as i32; 2],
        kernels: &traces.kernels,
        points: &of_points.collect::<Vec<_>>(),
        light: Vec3::from(view.center),
    };
    let found: Vec<f32> = renderer
        .read_buffer("quality", points.len())
        .expect("quality");
    for (i, wanted) in surface.smoothed(&levels).iter().enumerate() {
        if traces.kernels[i].status == KERNEL_PENUMBRA {
            let difference = (found[i] - wanted).abs();
            assert!(
                difference < LEVEL_TOLERANCE,
                "pixel {i}: {} for {wanted}",
                found[i]
            );
        }
    }
    found
}

/// What is hidden is what the twin integrates in the two levels round each pixel's; returns how many were blended.
fn check_blends(
    traces: &Traces,
    coarse: &CoarseMap,
    settings: &Settings,
    points: &[Option<Point>],
    quality: &[f32],
) -> usize {
    let budget = budget_of(settings);
    let (view, cut) = (&traces.planned.view, traces.planned.cut());
    let seen: BTreeMap<u32, _> = (1..=budget.levels)
        .map(|level| (level, coarse.seen(level)))
        .collect();
    let mut blended = 0;
    for i in (0..points.len()).step_by(STEP) {
        let kernel = traces.kernels[i];
        let share = |level: u32, receiver: &Receiver| {
            let cells = (unpacked(kernel.first), unpacked(kernel.last));
            if level == 0 {
                let light = SubLight::new(view, &traces.fit, cut, map_of(traces));
                return light.hidden_share(receiver, cells.0, cells.1);
            }
            let (size, depths) = &seen[&level];
            let map = ShadowMap {
                size: *size,
                depths,
            };
            let light = SubLight::new(view, &fit_at(&traces.fit, level, budget.levels), cut, map);
            let receiver = receiver_at(view, receiver, level, budget.levels);
            let (first, last) = budget.coarse_cells(cells, level);
            light.hidden_share(&receiver, first, last)
        };
        let wanted = match (
            kernel.status,
            points[i].as_ref().and_then(|p| receiver(traces, p)),
        ) {
            (KERNEL_PENUMBRA, Some(receiver)) => {
                let (finer, coarser) = (quality[i].floor(), f64::from(quality[i].fract()));
                blended += usize::from(coarser > 0.0);
                let of = |level: f32, part: f64| match part > 0.0 {
                    true => part * share(level as u32, &receiver),
                    false => 0.0,
                };
                of(finer, 1.0 - coarser) + of(finer + 1.0, coarser)
            }
            (KERNEL_UMBRA, _) => 1.0,
            _ => 0.0,
        };
        let found = f64::from(traces.occlusion[i] / view.weight);
        assert!(
            (found - wanted).abs() < TOLERANCE,
            "pixel {i}: {found} of the light hidden, by the twin {wanted}; level {}, {kernel:?}",
            quality[i]
        );
    }
    blended
}

/// Every view's passes; returns how many pixels were blended.
fn check(gpu: &Arc<Gpu>, shot: &Shot) -> usize {
    let mut renderer = renderer(gpu, shot);
    let settings = &shot.settings;
    let mut blended = 0;
    for view in 0..renderer.plan().lights[0].light.view_count {
        let traces = traces(&mut renderer, view);
        if traces.fit.level_count == 0 {
            continue;
        }
        let points = points(&renderer);
        let levels = settings.coarse_levels().expect("a budget");
        let coarse = check_coarse_map(&renderer, &traces, levels);
        let quality = check_levels(&renderer, settings, &traces, &points);
        blended += check_blends(&traces, &coarse, settings, &points, &quality);
    }
    blended
}

#[test]
fn blended_contours_are_those_of_their_twins() {
    with_device(|gpu| {
        for (scene, split, packet, budget) in [
            ("knot", 1, (4, 4), 12),
            ("staircase", 2, (1, 1), 4),
            ("colonnade", 1, (4, 2), 5),
            ("grid", 1, Settings::LOCAL, 7),
        ] {
            let mut shot = shot(scene);
            (shot.settings.split, shot.settings.packet) = (split, packet);
            shot.settings.budget = Some(budget);
            let blended = check(gpu, &shot);
            assert!(blended > 100, "{scene}: {blended} pixels");
        }
    });
}

fn visibility(gpu: &Arc<Gpu>, shot: &Shot) -> Vec<f32> {
    let mut renderer = renderer(gpu, shot);
    renderer.render().expect("a frame");
    renderer.visibility(0).expect("visibility")
}

fn difference(a: &[f32], b: &[f32]) -> f32 {
    let pairs = a.iter().zip(b).filter(|(a, b)| !a.is_nan() || !b.is_nan());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// The techniques that read a budget, with all ways to the same image.
fn limited() -> Vec<Settings> {
    let usual = |technique| Settings {
        map: 128,
        near_points: 0,
        ..Settings::usual(technique)
    };
    let local = usual(Technique::PacketContour);
    let packets = |packet, mapping, leaf| Settings {
        packet,
        mapping,
        leaf,
        ..local.clone()
    };
    let walked = Settings {
        hierarchical: true,
        ..usual(Technique::PixelContour)
    };
    vec![
        packets((1, 1), Mapping::Serial, Leaf::PerPixel),
        packets((4, 4), Mapping::Serial, Leaf::PerPixel),
        packets((4, 4), Mapping::Lanes, Leaf::Reprocess),
        packets((4, 2), Mapping::Cooperative, Leaf::PerPixel),
        local.clone(),
        walked,
        usual(Technique::PixelContour),
        usual(Technique::Micropatch),
        usual(Technique::Bitmask),
    ]
}

fn with_settings(scene: &str, settings: &Settings, budget: Option<u32>) -> Shot {
    let mut shot = shot(scene);
    shot.settings = Settings {
        budget,
        ..settings.clone()
    };
    shot
}

#[test]
fn a_budget_that_is_large_enough_changes_no_bit() {
    with_device(|gpu| {
        for settings in limited() {
            let image = |budget| visibility(gpu, &with_settings("staircase", &settings, budget));
            let same = image(None)
                .iter()
                .map(|v| v.to_bits())
                .eq(image(Some(4096)).iter().map(|v| v.to_bits()));
            assert!(same, "{}", settings.label());
        }
    });
}

/// However a contour is found at a level, it is the same.
#[test]
fn packets_pixels_walks_and_scans_have_the_same_image_at_all_levels() {
    with_device(|gpu| {
        for budget in [5, 13] {
            let contours = limited().into_iter().filter(|s| {
                matches!(
                    s.technique,
                    Technique::PacketContour | Technique::PixelContour
                )
            });
            let images: Vec<(String, Vec<f32>)> = contours
                .map(|settings| {
                    let settings = Settings {
                        split: 1,
                        ..settings
                    };
                    let image = visibility(gpu, &with_settings("knot", &settings, Some(budget)));
                    (settings.label(), image)
                })
                .collect();
            for (label, image) in &images[1..] {
                let difference = difference(&images[0].1, image);
                assert!(difference < 1e-5, "{label} within {budget}: {difference}");
            }
        }
    });
}

/// [Schwarz08, table 2] The smaller the budget, the fewer occluders, and the more pixels that need some.
#[test]
fn smaller_budgets_read_less() {
    with_device(|gpu| {
        for technique in [
            Technique::Micropatch,
            Technique::Bitmask,
            Technique::PixelContour,
        ] {
            let counted = [None, Some(16), Some(8), Some(4)].map(|budget| {
                let settings = Settings {
                    map: MAP,
                    counters: true,
                    ..Settings::usual(technique)
                };
                let mut renderer = renderer(gpu, &with_settings("knot", &settings, budget));
                renderer.render().expect("a frame");
                let counters = renderer.counters().expect("counters");
                (counters.samples_read[0], counters.penumbra)
            });
            for pair in counted.windows(2).skip(1) {
                assert!(pair[1].0 < pair[0].0, "{technique}: {counted:?}");
                assert!(pair[1].1 >= pair[0].1, "{technique}: {counted:?}");
            }
            assert!(counted[3].0 < counted[0].0 / 3, "{technique}: {counted:?}");
        }
    });
}

/// [Schwarz08, fig. 7] Without the growth of queries, pixels count as lit that coarse occluders hide a part of the light from: a
/// border of full light beside shadow. With it they are integrated.
#[test]
fn over_precision_ends_shadows_too_early() {
    with_device(|gpu| {
        let mut shot = shot("knot");
        shot.settings.split = 1;
        shot.settings.budget = Some(4);
        shot.settings.hierarchy = Density::Mssm;
        let grown = visibility(gpu, &shot);
        let mut of_grown = renderer(gpu, &shot);
        let kernels = traces(&mut of_grown, 0).kernels;
        shot.settings.query_growth = false;
        let mut of_tight = renderer(gpu, &shot);
        let tight = traces(&mut of_tight, 0).kernels;
        let (mut cut, mut gained) = (0, 0);
        for (i, (grown_kernel, kernel)) in kernels.iter().zip(&tight).enumerate() {
            let is_cut = kernel.status == KERNEL_LIT && grown_kernel.status == KERNEL_PENUMBRA;
            cut += usize::from(is_cut && grown[i] < 0.9);
            gained +=
                usize::from(kernel.status == KERNEL_PENUMBRA && grown_kernel.status == KERNEL_LIT);
        }
        assert!(cut > 40, "{cut} pixels are lit too early");
        assert_eq!(gained, 0);
    });
}

/// The device's microrects are the twin's, in every level and bit.
#[test]
fn microrects_are_those_of_their_twin() {
    with_device(|gpu| {
        for scene in ["knot", "colonnade"] {
            let settings = Settings {
                map: MAP,
                counters: true,
                occluders: Occluders::Microrects,
                ..Settings::usual(Technique::Bitmask)
            };
            let mut renderer = renderer(gpu, &with_settings(scene, &settings, Some(4)));
            let traces = traces(&mut renderer, 0);
            let levels = renderer.plan().lights[0].sets[0].recipe.coarse_levels;
            let last = MAP >> levels;
            let found: Vec<[u32; 3]> = renderer
                .read_buffer("microrects", ((MAP * MAP - last * last) / 3) as usize)
                .expect("microrects");
            let mut found = found.iter();
            let mut level = Level::of_map(&map_of(&traces));
            for number in 1..=levels {
                level = level.coarser();
                for (i, wanted) in level.rects.iter().enumerate() {
                    let &[depth, first, last] = found.next().expect("a microrect");
                    let reference =
                        [i as i32 % level.side, i as i32 / level.side].map(|i| i << number);
                    let texel = |packed: u32| {
                        let offset = [packed as u16 as i16, (packed >> 16) as u16 as i16];
                        [0, 1].map(|axis| reference[axis] + i32::from(offset[axis]))
                    };
                    let rect = (depth != 0).then(|| Rect {
                        depth: f32::from_bits(depth),
                        first: texel(first),
                        last: texel(last),
                    });
                    assert_eq!(rect, *wanted, "{scene}, level {number}, {i}");
                }
            }
        }
    });
}

/// [Schwarz08, fig. 12] Coarse micropatches leave gaps where depths differ, through which light leaks into umbrae; coarse
/// microrects follow surfaces.
#[test]
fn microrects_leak_less_than_micropatches() {
    with_device(|gpu| {
        let image = |occluders, budget| {
            let settings = Settings {
                map: MAP,
                occluders,
                ..Settings::usual(Technique::Bitmask)
            };
            visibility(gpu, &with_settings("knot", &settings, budget))
        };
        let fine = image(Occluders::Microquads, None);
        let leaks = |occluders| {
            let coarse = image(occluders, Some(8));
            let umbra = fine.iter().zip(&coarse).filter(|(fine, _)| **fine < 0.1);
            let leaks = umbra.map(|(fine, coarse)| f64::from((coarse - fine).max(0.0)));
            leaks.sum::<f64>()
        };
        let [patches, rects] = [Occluders::Micropatches, Occluders::Microrects].map(leaks);
        println!("light leaked: {patches:.2} through micropatches, {rects:.2} through microrects");
        assert!(rects < 0.8 * patches, "{rects} {patches}");
    });
}

/// The budgets of pixels: a number, less of it towards the border, under textures, and where an image says so.
#[test]
fn budgets_fall_where_quality_matters_less() {
    with_device(|gpu| {
        let budgets = |change: &dyn Fn(&mut Shot)| -> Vec<f32> {
            let mut shot = shot("plate");
            shot.settings.budget = Some(20);
            change(&mut shot);
            let mut renderer = renderer(gpu, &shot);
            renderer.render().expect("a frame");
            renderer
                .read_buffer("budgets", (SIZE * SIZE) as usize)
                .expect("budgets")
        };
        let at = |x: u32, y: u32| (y * SIZE + x) as usize;
        let middle = at(SIZE / 2, SIZE / 2);

        let falling = budgets(&|shot| shot.settings.budget_falloff = 0.5);
        assert!((falling[middle] - 20.0).abs() < 0.1);
        for border in [at(0, SIZE / 2), at(SIZE / 2, SIZE - 1), at(SIZE - 1, 0)] {
            assert!((falling[border] - 10.0).abs() < 0.1, "{}", falling[border]);
        }
        // Surfaces of one colour hide nothing; where they meet the background there is contrast.
        let masked = budgets(&|shot| shot.settings.budget_masking = 0.5);
        let whole = masked.iter().filter(|&&budget| budget == 20.0).count();
        assert!(whole > masked.len() / 2 && masked.iter().all(|b| (10.0..=20.0).contains(b)));

        let halves = Plane::new(2, 1, vec![1.0, 0.0]).expect("an image");
        let mapped = budgets(&|shot| shot.budget_map = Some(Arc::new(halves.clone())));
        assert_eq!(mapped[at(0, 5)], 20.0);
        assert_eq!(mapped[at(SIZE - 1, 5)], LEAST_BUDGET as f32);
        assert!((mapped[middle] - 10.0).abs() < 0.2);
    });
}
