//! Soft shadow maps against their twin, and what [Atty06] says of them.

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};
use halfshade::render::Renderer;
use halfshade::shot::Shot;
use halfshade::technique::{Accumulate, Settings, Technique};
use halfshade::twin::receiver::{in_view, project};
use halfshade::twin::soft_shadow_map::{Maps, SoftShadowMap, farthest_of};

use super::support::{
    self, Triangles, camera, load, rectangle, rectangle_light, renderer, shot, with_gpu,
};

const SIDE: usize = 32;
const MAP: usize = 48;

fn usual() -> Settings {
    Settings {
        map: MAP as u32,
        ..Settings::usual(Technique::OccluderDriven)
    }
}

/// One-sided, with bottom patches, and two-sided.
fn kinds() -> [Settings; 3] {
    [
        usual(),
        Settings {
            bottom_patches: true,
            ..usual()
        },
        Settings {
            two_sided: true,
            ..usual()
        },
    ]
}

/// A scene, and the numbers of the triangles that cast where the shot tells them.
fn told(mut shot: Shot, casters: impl Fn(usize) -> bool) -> Shot {
    let count = shot.scene.triangles.len();
    Arc::make_mut(&mut shot.scene).casts = (0..count).map(casters).collect();
    shot
}

fn map_of(renderer: &Renderer, name: &str) -> Vec<f32> {
    renderer.read_image(name, MAP * MAP).expect("a map")
}

/// What a frame's maps and pixels are for the twin, which asks all patches of all texels: extents leave nothing out.
fn check_with_twin(shot: &Shot) {
    let settings = &shot.settings;
    with_gpu(|gpu| {
        let mut renderer = renderer(gpu, shot);
        renderer.render_view(0).expect("a view");
        let view = renderer.plan().views().next().expect("a view").view;
        let fit = renderer.fits().expect("fits")[0];
        let decoded = |name| -> Vec<f32> {
            let stored = map_of(&renderer, name).into_iter();
            stored.map(farthest_of).collect()
        };
        let receivers = match shot.scene.tells_casters() {
            true => map_of(&renderer, "receiver_map"),
            false => decoded("receiver_map"),
        };
        let occluders = map_of(&renderer, "shadow_map");
        let bottoms = match settings.bottom_patches || settings.two_sided {
            true => decoded("bottom_map"),
            false => Vec::new(),
        };
        let made = |occluders: &[f32], bottoms: &[f32]| {
            let maps = Maps {
                occluders,
                bottoms,
                receivers: &receivers,
            };
            SoftShadowMap::new(&view, &fit, maps)
        };
        let mut twins = vec![match settings.bottom_patches {
            true => made(&occluders, &bottoms),
            false => made(&occluders, &[]),
        }];
        if settings.two_sided {
            twins.push(made(&bottoms, &[]));
        }
        for (twin, name) in twins.iter().zip(["soft_shadows", "bottom_shadows"]) {
            let found = map_of(&renderer, name);
            let mut partly = 0;
            // Each patch rounds the sum that it is added to, and the ends of its two intervals on the light by up to 8 units in
            // the last place of its half size; per unit of depth an interval is as long as a texel's way.
            let patches = if name == "soft_shadows" {
                &occluders
            } else {
                &bottoms
            };
            let count = patches.iter().filter(|depth| **depth > 0.0).count();
            let way = [0, 1].map(|i| f64::from(fit.near / (fit.focal[i] * view.half_size[i])));
            let ends = 2.0 * 8.0 * f64::from(f32::EPSILON) * (1.0 / way[0] + 1.0 / way[1]);
            let rounding = count as f64 * f64::from(f32::EPSILON) / 2.0 + ends;
            for (index, (found, wanted)) in found.iter().zip(twin.sums()).enumerate() {
                let off = (f64::from(*found) - wanted).abs();
                assert!(
                    off < 1e-5 + rounding * wanted,
                    "{name} {index}: {found} for {wanted}"
                );
                partly += usize::from(*wanted > 0.01 && *wanted < 0.99);
            }
            assert!(partly > 30, "{name}: {partly} texels of penumbra");
        }
        let sums: Vec<&[f64]> = twins.iter().map(SoftShadowMap::sums).collect();
        let pixels =
            |name| -> Vec<[f32; 4]> { renderer.read_image(name, SIDE * SIDE).expect("pixels") };
        let (positions, normals) = (pixels("position_world"), pixels("normal_world"));
        let occlusion: Vec<f32> = renderer
            .read_buffer("occlusion", SIDE * SIDE)
            .expect("occlusion");
        let mut partly = 0;
        for ((position, normal), found) in positions.iter().zip(&normals).zip(&occlusion) {
            let position_eye = Vec3::from_slice(position);
            let to_point = position_eye - Vec3::from(view.center);
            let normal = Vec3::from_slice(normal);
            if position[3] == 0.0 || !in_view(&view, position_eye, normal) {
                continue;
            }
            let pixel = project(&view, &fit, false, to_point, normal);
            let share = twins[0].hidden_share(&pixel, &receivers, &sums);
            let wanted = f64::from(view.weight) * share;
            assert!(
                (f64::from(*found) - wanted).abs() < 1e-4,
                "{found} for {wanted} at {position:?}"
            );
            partly += usize::from(share > 0.01 && share < 0.99);
        }
        assert!(partly > 30, "{partly} pixels of penumbra");
    });
}

/// Maps and pixels are those of the scalar twin; sums of shares in f32 are within what each addition rounds.
#[test]
fn soft_shadow_maps_are_those_of_their_twin() {
    for settings in kinds() {
        check_with_twin(&load("knot", SIDE as u32, settings.clone()));
        // A floor that receives, and what stands over it casts.
        check_with_twin(&told(frustum(settings), |triangle| triangle >= 2));
    }
}

/// A floor, and over it a closed frustum that widens downwards so little that the middle of a light of 1 × 1 at a height of 4
/// sees its top alone, but the light's borders see its sides.
fn frustum(settings: Settings) -> Shot {
    let (top, bottom) = (2.6, 1.2);
    let at = |x: f64, y: f64, z: f64| {
        let half = if y == top { 0.25 } else { 0.48 };
        DVec3::new(half * x, y, half * z)
    };
    let ring =
        |y: f64| [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)].map(|(x, z)| at(x, y, z));
    let (upper, lower) = (ring(top), ring(bottom));
    let mut triangles = Triangles::new()
        .floor([-3.0, 3.0], [-3.0, 3.0])
        .polygon(&upper);
    triangles = triangles.polygon(&[lower[3], lower[2], lower[1], lower[0]]);
    for side in 0..4 {
        let next = (side + 1) % 4;
        triangles = triangles.polygon(&[lower[side], lower[next], upper[next], upper[side]]);
    }
    let camera = camera(DVec3::new(-3.6, 1.9, 0.3), DVec3::new(0.0, 0.6, 0.0), 45.0);
    let light = rectangle_light(DVec3::new(0.0, 4.0, 0.0), DVec2::splat(0.5));
    shot(triangles.build(), camera, light, SIDE as u32, settings)
}

/// The visibilities of pixels on the floor, or of the others.
fn pixels_of(shot: &Shot, on_floor: bool) -> Vec<f32> {
    with_gpu(|gpu| {
        let image = support::render(gpu, shot);
        let pixels = image.visibility.into_iter().zip(image.positions);
        let wanted = |&(value, [_, y, _, _]): &(f32, [f64; 4])| {
            !value.is_nan() && (y.abs() < 1e-4) == on_floor
        };
        pixels.filter(wanted).map(|(value, _)| value).collect()
    })
}

/// The mean of many hard shadows.
fn true_floor(shot: &Shot) -> Vec<f32> {
    let mut truth = shot.clone();
    truth.settings = Settings {
        maps: 256,
        map: 256,
        ..Settings::usual(Technique::ReferenceMaps)
    };
    pixels_of(&truth, true)
}

fn mean_error(values: &[f32], truth: &[f32]) -> f32 {
    let errors = values
        .iter()
        .zip(truth)
        .map(|(value, truth)| (value - truth).abs());
    errors.sum::<f32>() / values.len() as f32
}

/// [§3.5, fig. 11] What the light's centre does not see hides nothing; patches at its bottom do, and best as a map of
/// their own, for each patch's bottom is counted beside the others.
#[test]
fn bottoms_hide_what_the_centre_does_not_see() {
    let told = |settings| told(frustum(settings), |triangle| triangle >= 2);
    let truth = true_floor(&told(usual()));
    let error = |settings| {
        let fine = Settings {
            map: 128,
            ..settings
        };
        mean_error(&pixels_of(&told(fine), true), &truth)
    };
    let [one, bottoms, two] = kinds().map(error);
    assert!(two < 0.8 * one, "{two} with two sides, {one} with one");
    assert!(bottoms < one, "{bottoms} with bottoms, {one} without");
}

/// [As read here] Bottom patches overlap the patches of other texels, so that shadows of what is thick are too dark; two sides are
/// not.
#[test]
fn bottom_patches_are_too_dark_under_what_is_thick() {
    let knot = |settings| {
        let shot = load("knot", SIDE as u32, settings);
        // The ground comes first.
        told(shot, |triangle| triangle >= 2)
    };
    let truth = true_floor(&knot(usual()));
    let darker = |settings| {
        let floor = pixels_of(&knot(settings), true);
        let darker = truth.iter().zip(&floor).map(|(truth, value)| truth - value);
        darker.sum::<f32>() / truth.len() as f32
    };
    let [one, bottoms, two] = kinds().map(darker);
    assert!(bottoms > 0.02, "{bottoms} darker");
    assert!(one < 0.0 && two.abs() < 0.01, "{one} and {two} darker");
}

/// [§3.1, §7] Occluders receive no shadow, not even on the side that another one hides.
#[test]
fn occluders_receive_no_shadow() {
    // A plate over the frustum, which hides all of its top from all of the light.
    let covered = |settings| {
        let mut covered = frustum(settings);
        let plate = Triangles::new()
            .plate(3.2, &rectangle([-1.2, 1.2], [-1.2, 1.2]))
            .build();
        let scene = Arc::make_mut(&mut covered.scene);
        let first = scene.positions.len() as u32;
        scene.positions.extend(&plate.positions);
        let triangles = plate
            .triangles
            .iter()
            .map(|triangle| triangle.map(|i| first + i));
        scene.triangles.extend(triangles);
        scene.triangle_materials.extend([0, 0]);
        scene.opaque_count += 2;
        covered.camera = camera(DVec3::new(-2.5, 3.0, 0.3), DVec3::new(0.0, 2.4, 0.0), 20.0);
        covered
    };
    let lowest = |shot: &Shot| pixels_of(shot, false).into_iter().fold(1.0, f32::min);
    for shot in [
        covered(usual()),
        told(covered(usual()), |triangle| triangle >= 2),
    ] {
        let values = pixels_of(&shot, false);
        // Those that face the light at all.
        let lit = values.iter().filter(|value| **value == 1.0).count();
        assert!(lit > 100, "{lit} of {} pixels", values.len());
        assert!(values.iter().all(|value| *value == 1.0 || *value == 0.0));
    }
    let contours = Settings::usual(Technique::Hard);
    assert_eq!(lowest(&covered(contours)), 0.0);
}

/// A plate that rises steeply along x: neighbouring patches are at different depths.
fn slope(settings: Settings) -> Shot {
    let corner = |(x, z): (f64, f64)| DVec3::new(x, 1.7 + x, z);
    let corners = [(-1.2, -1.5), (-1.2, 1.5), (1.2, 1.5), (1.2, -1.5)].map(corner);
    let triangles = Triangles::new()
        .floor([-3.0, 3.0], [-3.0, 3.0])
        .polygon(&corners);
    let camera = camera(DVec3::new(-2.6, 0.35, 0.0), DVec3::ZERO, 16.0);
    let light = rectangle_light(DVec3::new(0.0, 4.0, 0.0), DVec2::splat(0.5));
    let shot = shot(triangles.build(), camera, light, SIDE as u32, settings);
    told(shot, |triangle| triangle >= 2)
}

/// [§5.1.2] Patches of different depths overlap or leave gaps: where the whole light is hidden their shares do not add up to
/// one, but to what equation 3 allows; a finer map halves the depths between them, but not their sum.
#[test]
fn shares_overlap_within_equation_3() {
    with_gpu(|gpu| {
        let shot = slope(usual());
        let mut renderer = renderer(gpu, &shot);
        renderer.render_view(0).expect("a view");
        let fit = renderer.fits().expect("fits")[0];
        let (occluders, receivers) = (
            map_of(&renderer, "shadow_map"),
            map_of(&renderer, "receiver_map"),
        );
        let sums = map_of(&renderer, "soft_shadows");
        let depth = |d: f32| f64::from(fit.near) / f64::from(d);
        let depths: Vec<f64> = occluders
            .iter()
            .filter(|d| **d > 0.0)
            .map(|&d| depth(d))
            .collect();
        let nearest = depths.iter().copied().fold(f64::INFINITY, f64::min);
        let farthest = depths.iter().copied().fold(0.0, f64::max);
        // The pairs that meet on a line across the light, by the sum of the steps between them, over the light's width.
        let receiver = depth(*receivers.iter().find(|d| **d > 0.0).expect("a receiver"));
        let bound = 0.5 * receiver * (farthest - nearest) / (nearest * (receiver - farthest));
        let most = f64::from(sums.iter().copied().fold(0.0, f32::max));
        assert!(most > 1.02, "nothing overlaps: {most}");
        assert!(most < 1.0 + bound, "{most} is beyond {bound}");
    });
    // Where they leave gaps, light comes through: with the other slope, or on the other side of the light's middle.
    let truth = true_floor(&slope(usual()));
    let found = pixels_of(&slope(usual()), true);
    let leaks = found.iter().zip(&truth).map(|(found, truth)| found - truth);
    assert!(leaks.fold(0.0, f32::max) > 0.02);
}

/// [§5.1.3, fig. 14] Many small shares add up to less in 16 bits: an occluder near to the light, and a fine map. The plan says so,
/// and is silent where equation 4 holds.
#[test]
fn sixteen_bits_lose_small_shares() {
    let near = |map, accumulate| {
        let triangles = Triangles::new()
            .floor([-3.0, 3.0], [-3.0, 3.0])
            .plate(3.0, &rectangle([-0.9, 0.9], [-0.9, 0.9]));
        let camera = camera(DVec3::new(-2.6, 1.35, 0.0), DVec3::ZERO, 40.0);
        let light = rectangle_light(DVec3::new(0.0, 4.0, 0.0), DVec2::splat(0.5));
        let settings = Settings {
            map,
            accumulate,
            ..usual()
        };
        let shot = shot(triangles.build(), camera, light, 16, settings);
        told(shot, |triangle| triangle >= 2)
    };
    let darkest = |map, accumulate| {
        let floor = pixels_of(&near(map, accumulate), true);
        floor.into_iter().fold(1.0, f32::min)
    };
    let coarse = darkest(32, Accumulate::Fp16);
    assert!(coarse < 0.05, "{coarse} on a coarse map");
    let (half, full) = (
        darkest(256, Accumulate::Fp16),
        darkest(256, Accumulate::Fp32),
    );
    assert!(full < 1e-3 && half > 0.2, "{half} in 16 bits, {full} in 32");
    let noted = |map, accumulate| {
        with_gpu(|gpu| {
            let renderer = renderer(gpu, &near(map, accumulate));
            let notes = &renderer.plan().notes;
            notes.iter().any(|note| note.contains("--accumulate fp32"))
        })
    };
    assert!(noted(256, Accumulate::Fp16));
    assert!(!noted(256, Accumulate::Fp32) && !noted(32, Accumulate::Fp16));
}

/// A disc is a square of its area: as dark where it is hidden in full, and where half of it is.
#[test]
fn discs_are_squares_of_their_area() {
    let under = |light| {
        let triangles = Triangles::new()
            .floor([-3.0, 3.0], [-3.0, 3.0])
            .plate(1.5, &rectangle([-0.7, 0.3], [-0.8, 0.5]));
        let camera = camera(DVec3::new(-2.6, 1.35, 0.0), DVec3::ZERO, 40.0);
        told(
            shot(triangles.build(), camera, light, SIDE as u32, usual()),
            |triangle| triangle >= 2,
        )
    };
    let center = DVec3::new(0.0, 4.0, 0.0);
    let half = 0.25 * std::f64::consts::PI.sqrt();
    let disc = pixels_of(&under(support::disc_light(center, 0.5)), true);
    let square = pixels_of(&under(rectangle_light(center, DVec2::splat(half))), true);
    let off = disc
        .iter()
        .zip(&square)
        .map(|(disc, square)| (disc - square).abs());
    let off = off.fold(0.0, f32::max);
    assert!(off < 0.02, "{off}");
}

/// Patches are counted, and the texels that they are scattered over.
#[test]
fn patches_and_their_texels_are_counted() {
    with_gpu(|gpu| {
        let settings = Settings {
            counters: true,
            ..usual()
        };
        let shot = load("plate", SIDE as u32, settings);
        let mut renderer = renderer(gpu, &shot);
        renderer.render().expect("a frame");
        let counters = renderer.counters().expect("counters");
        let occluders = map_of(&renderer, "shadow_map");
        let patches = occluders.iter().filter(|depth| **depth > 0.0).count();
        assert_eq!(counters.edges_extracted, [patches as u32, 0]);
        let sums = map_of(&renderer, "soft_shadows");
        let touched = sums.iter().filter(|sum| **sum > 0.0).count();
        assert!(counters.samples_read[0] as usize > patches.max(touched));
    });
}

/// A frame that keeps its map keeps the soft shadow map as well.
#[test]
fn kept_maps_give_the_same_bits() {
    with_gpu(|gpu| {
        let two_sided = kinds()[2].clone();
        let mut renderer = renderer(gpu, &load("knot", SIDE as u32, two_sided));
        let mut render = || {
            let frame = renderer.render().expect("a frame");
            let scattered = renderer.recorded().contains(&"scatter_visibility");
            assert_ne!(frame.plan.retained, scattered);
            renderer.visibility(0).expect("visibility")
        };
        let (first, second) = (render(), render());
        assert!(support::same_bits(&first, &second));
    });
}
