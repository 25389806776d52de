//! The sibling techniques: what all of them promise, and the artefacts that each is known for. An artefact that is
//! missing would mean that a technique was improved silently, and that comparing with it is worth nothing.

#[path = "support/gpu.rs"]
mod support;

#[path = "techniques/artefacts.rs"]
mod artefacts;
#[path = "techniques/goldens.rs"]
mod goldens;
#[path = "techniques/scattered.rs"]
mod scattered;

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};
use halfshade::shared::{Fit, View};
use halfshade::shot::Shot;
use halfshade::technique::{Hierarchy, Neighbours, Occluders, Pattern, Settings, Technique};
use halfshade::twin::receiver::{in_view, project};
use halfshade::twin::shadow_width::ShadowWidths;
use support::{
    Triangles, camera, disc_light, load, rectangle, rectangle_light, renderer, shot, with_gpu,
};

/// Every sibling with every choice that has a code of its own, small enough for tests.
fn siblings() -> Vec<(&'static str, Settings)> {
    let usual = |technique| Settings {
        map: 64,
        maps: 16,
        ..Settings::usual(technique)
    };
    vec![
        ("packet-contour", usual(Technique::PacketContour)),
        (
            "packet-contour within a budget",
            Settings {
                budget: Some(5),
                ..usual(Technique::PacketContour)
            },
        ),
        ("pixel-contour", usual(Technique::PixelContour)),
        (
            "pixel-contour hierarchical",
            Settings {
                hierarchical: true,
                ..usual(Technique::PixelContour)
            },
        ),
        ("micropatch", usual(Technique::Micropatch)),
        (
            "micropatch with gaps",
            Settings {
                gap_filling: false,
                ..usual(Technique::Micropatch)
            },
        ),
        (
            "microrects",
            Settings {
                budget: Some(5),
                occluders: Occluders::Microrects,
                ..usual(Technique::Micropatch)
            },
        ),
        (
            "micropatch within a budget",
            Settings {
                budget: Some(5),
                ..usual(Technique::Micropatch)
            },
        ),
        (
            "micropatch-hierarchical",
            usual(Technique::MicropatchHierarchical),
        ),
        (
            "bitmask 8 regular",
            Settings {
                light_samples: 8,
                pattern: Pattern::Regular,
                ..usual(Technique::Bitmask)
            },
        ),
        (
            "bitmask 16 jittered, 2 layers",
            Settings {
                layers: 2,
                ..usual(Technique::Bitmask)
            },
        ),
        (
            "bitmask of microrects",
            Settings {
                budget: Some(5),
                occluders: Occluders::Microrects,
                ..usual(Technique::Bitmask)
            },
        ),
        (
            "bitmask within a budget",
            Settings {
                budget: Some(5),
                budget_falloff: 0.5,
                ..usual(Technique::Bitmask)
            },
        ),
        ("depth-peeling", usual(Technique::DepthPeeling)),
        (
            "depth-peeling contours",
            Settings {
                layers: 2,
                occluders: Occluders::Contours,
                ..usual(Technique::DepthPeeling)
            },
        ),
        ("pcss", usual(Technique::Pcss)),
        ("shadow-width", usual(Technique::ShadowWidth)),
        (
            "shadow-width 3 neighbours",
            Settings {
                neighbours: Neighbours::Three,
                ..usual(Technique::ShadowWidth)
            },
        ),
        (
            "shadow-width back faces",
            Settings {
                back_faces: true,
                ..usual(Technique::ShadowWidth)
            },
        ),
        ("occluder-driven", usual(Technique::OccluderDriven)),
        (
            "occluder-driven two-sided",
            Settings {
                two_sided: true,
                ..usual(Technique::OccluderDriven)
            },
        ),
        (
            "occluder-driven with bottoms",
            Settings {
                bottom_patches: true,
                ..usual(Technique::OccluderDriven)
            },
        ),
        ("hard", usual(Technique::Hard)),
        (
            "hard 3x3",
            Settings {
                percentage_closer: true,
                ..usual(Technique::Hard)
            },
        ),
        ("reference-maps", usual(Technique::ReferenceMaps)),
    ]
}

/// t_p and the biased depth of a pixel, as `project` in `receiver.glsl` has them for a receiver that the map's axis meets
/// at a right angle.
fn place(view: &View, fit: &Fit, position: Vec3) -> (Vec3, f32) {
    let axis = |axis: [f32; 3]| (position - Vec3::from(view.center)).dot(Vec3::from(axis));
    let p = Vec3::new(axis(view.right), axis(view.up), axis(view.forward));
    let t = [0, 1].map(|i| fit.focal[i] * p[i] / p.z + fit.center[i]);
    (Vec3::new(t[0], t[1], 0.0), fit.near / p.z)
}

/// A square plate over a floor.
fn plate_under(light: halfshade::scene::AreaLight, settings: Settings) -> Shot {
    let scene = Triangles::new()
        .floor([-2.0, 2.0], [-2.0, 2.0])
        .plate(1.0, &rectangle([-0.5, 0.4], [-0.45, 0.6]))
        .build();
    let eye = DVec3::new(-3.0, 2.5, 0.4);
    shot(scene, camera(eye, DVec3::ZERO, 42.0), light, 64, settings)
}

/// As a light shrinks, all techniques become the hard shadow: wherever the samples round a pixel's projection agree
/// about it, its visibility is exactly theirs.
#[test]
fn tiny_lights_cast_hard_shadows() {
    let center = DVec3::new(0.1, 3.0, -0.05);
    let lights = [
        rectangle_light(center, DVec2::splat(1e-4)),
        disc_light(center, 1e-4),
    ];
    with_gpu(|gpu| {
        for light in lights {
            for (name, settings) in siblings() {
                let settings = Settings {
                    split: 1,
                    ..settings
                };
                let reference = plate_under(
                    light.clone(),
                    Settings {
                        technique: Technique::Hard,
                        percentage_closer: false,
                        ..settings.clone()
                    },
                );
                let mut hard = renderer(gpu, &reference);
                hard.render().expect("a frame");
                let side = settings.map as usize;
                let map: Vec<f32> = hard.read_image("shadow_map", side * side).expect("a map");
                let view = hard.plan().views().next().expect("a view").view;
                let fit = hard.fits().expect("fits")[0];
                let positions = support::positions(&hard, &reference);
                let visibility = support::visibility(gpu, &plate_under(light.clone(), settings));
                let mut decided = 0;
                for (&value, position) in visibility.iter().zip(&positions) {
                    let [x, y, z, surface] = *position;
                    if surface == 0.0 || y > 1e-3 {
                        continue;
                    }
                    let relative = DVec3::new(x, y, z) - reference.origin();
                    let (t, d) = place(&view, &fit, relative.as_vec3());
                    let (column, row) = (t.x.floor() as i32, t.y.floor() as i32);
                    let occludes = |i: i32, j: i32| {
                        let inside = (0..side as i32).contains(&i) && (0..side as i32).contains(&j);
                        // The plate and the floor are far apart: no bias matters.
                        inside && map[j as usize * side + i as usize] > 1.05 * d
                    };
                    let near = (-1..=2).flat_map(|j| (-1..=2).map(move |i| (column + i, row + j)));
                    let covered = near.filter(|&(i, j)| occludes(i, j)).count();
                    if covered == 0 || covered == 16 {
                        let expected = if covered == 0 { 1.0 } else { 0.0 };
                        // The areas of patches that fill the light add up to it but for their rounding.
                        assert!(
                            (value - expected).abs() < 1e-5,
                            "{name}: {value} at {position:?}"
                        );
                        decided += 1;
                    }
                }
                assert!(decided > 1000, "{name}: only {decided} pixels");
            }
        }
    });
}

/// Every technique is a function of the shot, bit for bit, and within its range on every scene.
#[test]
fn the_same_shot_has_the_same_image() {
    with_gpu(|gpu| {
        for (name, settings) in siblings() {
            let shot = load("staircase", 32, settings);
            let (first, second) = (
                support::visibility(gpu, &shot),
                support::visibility(gpu, &shot),
            );
            assert!(support::same_bits(&first, &second), "{name}");
        }
    });
}

/// A pyramid finds the same patches as a scan of all texels; only the order of their sum differs, some thousand terms
/// in f32. Of the same hierarchy, which decides which pixels are in the umbra; others add patches up, with gaps between them.
#[test]
fn hierarchical_micropatches_are_micropatches() {
    with_gpu(|gpu| {
        for scene in ["staircase", "knot", "colonnade"] {
            for gap_filling in [true, false] {
                let image = |technique| {
                    let settings = Settings {
                        gap_filling,
                        map: 128,
                        hierarchy: Hierarchy::Hsm,
                        ..Settings::usual(technique)
                    };
                    support::visibility(gpu, &load(scene, 32, settings))
                };
                let (flat, tree) = (
                    image(Technique::Micropatch),
                    image(Technique::MicropatchHierarchical),
                );
                let difference = support::largest_difference(&flat, &tree);
                assert!(difference < 1e-4, "{scene}: {difference}");
            }
        }
    });
}

/// Widths and what they do to light are those of the scalar twin, which reads the device's map, in every view. The way to a texel
/// is found by the same operations; drivers may contract the products of bilinear weights, so visibility is within 1e-5.
#[test]
fn shadow_widths_are_those_of_their_twin() {
    with_gpu(|gpu| {
        for neighbours in [Neighbours::Three, Neighbours::Six, Neighbours::Flood] {
            let settings = Settings {
                neighbours,
                start: 16,
                map: 64,
                ..Settings::usual(Technique::ShadowWidth)
            };
            let shot = load("plate", 32, settings.clone());
            check_widths(gpu, &shot, &settings);
        }
    });
}

fn check_widths(gpu: &Arc<halfshade::gpu::Gpu>, shot: &Shot, settings: &Settings) {
    let mut renderer = renderer(gpu, shot);
    renderer.render_view(0).expect("a view");
    let (planned, fit) = (
        renderer.plan().views().next().expect("a view").clone(),
        renderer.fits().expect("fits")[0],
    );
    let spreads = renderer
        .plan()
        .steps()
        .filter(|step| step.pass.name == "width_spread")
        .count() as u32;
    let texels = (settings.map * settings.map) as usize;
    let map: Vec<f32> = renderer.read_image("shadow_map", texels).expect("a map");
    let both: Vec<[f32; 2]> = renderer
        .read_buffer("shadow_widths", 2 * texels)
        .expect("widths");
    let found = both[(spreads as usize & 1) * texels..].iter().take(texels);
    let twin = ShadowWidths::new(&planned.view, &fit, settings, &map, spreads);
    assert!(twin.widths().iter().filter(|width| **width > 0.0).count() > 100);
    for (index, (found, wanted)) in found.zip(twin.widths()).enumerate() {
        assert!(
            (found[0] - wanted).abs() <= 1e-6 * wanted,
            "texel {index}: {} for {wanted}",
            found[0]
        );
    }
    let (positions, normals) = (
        renderer
            .read_image::<[f32; 4]>("position_world", 32 * 32)
            .expect("positions"),
        renderer
            .read_image::<[f32; 4]>("normal_world", 32 * 32)
            .expect("normals"),
    );
    let occlusion: Vec<f32> = renderer
        .read_buffer("occlusion", 32 * 32)
        .expect("occlusion");
    let mut partly = 0;
    for ((position, normal), found) in positions.iter().zip(&normals).zip(&occlusion) {
        let position_eye = Vec3::from_slice(position);
        let to_point = position_eye - Vec3::from(planned.view.center);
        let normal = Vec3::from_slice(normal);
        if position[3] == 0.0 || !in_view(&planned.view, position_eye, normal) {
            continue;
        }
        let receiver = project(&planned.view, &fit, false, to_point, normal);
        let nearest = (receiver.t + 0.5).floor().as_ivec2();
        let inside = nearest.min_element() >= 0 && nearest.max_element() < settings.map as i32;
        let index = nearest.y * settings.map as i32 + nearest.x;
        let depth = if inside { map[index as usize] } else { 0.0 };
        let wanted = planned.view.weight * twin.hidden_share(settings, &receiver, depth);
        assert!(
            (found - wanted).abs() < 1e-5,
            "{found} for {wanted} at {position:?}"
        );
        partly += usize::from(wanted > 0.0 && wanted < planned.view.weight);
    }
    assert!(partly > 30, "{partly} pixels of penumbra");
}

/// What does not cast is no occluder, and what is no occluder anyway need not be told.
#[test]
fn only_casters_cast() {
    let light = rectangle_light(DVec3::new(0.1, 3.0, -0.05), DVec2::splat(0.4));
    with_gpu(|gpu| {
        for (name, settings) in siblings() {
            let with = |casts: &[bool]| {
                let mut shot = plate_under(light.clone(), settings.clone());
                Arc::make_mut(&mut shot.scene).casts = casts.into();
                support::visibility(gpu, &shot)
            };
            let (all, plate) = (with(&[]), with(&[false, false, true, true]));
            let floor = with(&[true, true, false, false]);
            // Where receivers have a map of their own, the one without casters is biased.
            let difference = support::largest_difference(&all, &plate);
            assert!(difference < 1e-4, "{name}: {difference}");
            assert!(all.iter().any(|value| *value < 0.5), "{name}");
            let shadowed = floor.iter().find(|value| **value < 1.0);
            assert_eq!(shadowed, None, "{name}");
        }
    });
}
