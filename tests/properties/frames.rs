//! Frames: what they repeat, keep, record and take.

use super::*;

/// Lists fill in any order; the picture does not tell.
#[test]
fn the_same_shot_has_the_same_bits() {
    let shots: Vec<Shot> = ["staircase", "knot"]
        .map(|name| load(name, 64, settings(128, 2)))
        .to_vec();
    let first = with_gpu(|gpu| {
        shots
            .iter()
            .map(|shot| {
                let image = visibility(gpu, shot);
                assert!(same_bits(&image, &visibility(gpu, shot)), "on one device");
                image
            })
            .collect::<Vec<_>>()
    });
    let second = with_gpu(|gpu| {
        shots
            .iter()
            .map(|shot| visibility(gpu, shot))
            .collect::<Vec<_>>()
    });
    for (first, second) in first.iter().zip(&second) {
        assert!(same_bits(first, second), "on two devices");
    }
}

/// Faces, cut sub-lights, pixels that are joined, lists of packets of a fixed size, and techniques that read the map in other ways. Views fill their
/// dispatches by fives, the last one not wholly.
#[test]
fn how_many_views_are_made_at_once_changes_no_bit() {
    let technique = |technique| Settings {
        split: 3,
        map: 64,
        ..Settings::usual(technique)
    };
    let shots = [
        ("knot", settings(128, 4)),
        ("colonnade", settings(64, 3)),
        (
            "tree",
            Settings {
                hierarchy: Hierarchy::Mssm,
                packet: (4, 4),
                ..settings(64, 3)
            },
        ),
        (
            "hexagon",
            Settings {
                evaluate: Evaluate::Quarter,
                ..settings(64, 3)
            },
        ),
        ("plate", technique(Technique::Micropatch)),
        (
            "knot",
            Settings {
                back_faces: true,
                ..technique(Technique::ShadowWidth)
            },
        ),
        (
            "knot",
            Settings {
                budget: Some(8),
                ..technique(Technique::Bitmask)
            },
        ),
        (
            "colonnade",
            Settings {
                maps: 23,
                ..technique(Technique::ReferenceMaps)
            },
        ),
    ];
    for (name, settings) in shots {
        let mut shot = load(name, 64, settings);
        let mut image = |views_at_once| {
            shot.settings.views_at_once = Some(views_at_once);
            with_gpu(|gpu| {
                let mut renderer = renderer(gpu, &shot);
                let steps = renderer.render().expect("a frame").plan.steps().count();
                (renderer.visibility(0).expect("visibility"), steps)
            })
        };
        let (one, most) = image(1);
        let (several, fewer) = image(5);
        let technique = &shot.settings.technique;
        assert!(
            fewer < most,
            "{name}, {technique}: {most} steps, then {fewer}"
        );
        assert!(same_bits(&one, &several), "{name}, {technique}");
    }
}

/// Where pixels are counted, tiles are listed that have nothing to add.
#[test]
fn counting_changes_no_bit() {
    for (name, split) in [("colonnade", 1), ("knot", 2), ("grid", 1)] {
        let mut shot = load(name, 64, settings(128, split));
        let uncounted = with_gpu(|gpu| visibility(gpu, &shot));
        shot.settings.counters = true;
        let counted = with_gpu(|gpu| visibility(gpu, &shot));
        assert!(same_bits(&uncounted, &counted), "{name}");
    }
}

#[test]
fn a_retained_frame_has_the_same_bits_and_draws_no_map() {
    let shot = load("knot", 64, settings(128, 1));
    with_gpu(|gpu| {
        let mut renderer = renderer(gpu, &shot);
        let frame = renderer.render().expect("a frame");
        assert!(!frame.plan.retained);
        let first = renderer.visibility(0).expect("visibility");
        assert!(renderer.recorded().contains(&"shadow_map"));

        let frame = renderer.render().expect("a frame");
        assert!(frame.plan.retained);
        assert!(same_bits(
            &first,
            &renderer.visibility(0).expect("visibility")
        ));
        let of_map = [
            "clear_fits",
            "receivers",
            "casters",
            "fit",
            "shadow_map",
            "hierarchy",
        ];
        for name in renderer.recorded() {
            assert!(!of_map.contains(name), "{name} ran");
        }

        renderer.invalidate();
        let frame = renderer.render().expect("a frame");
        assert!(!frame.plan.retained);
        assert!(same_bits(
            &first,
            &renderer.visibility(0).expect("visibility")
        ));
    });
}

/// A wall far to the side shadows a floor that the light sees at more than 60° off its axis.
#[test]
fn receivers_beside_the_front_face_are_shadowed() {
    let wall =
        [(0.2, -0.7), (0.6, -0.7), (0.6, 0.7), (0.2, 0.7)].map(|(y, z)| DVec3::new(4.0, y, z));
    let scene = Triangles::new()
        .floor([-1.0, 9.0], [-3.0, 3.0])
        .polygon(&wall)
        .build();
    let camera = camera(DVec3::new(4.0, 4.0, 4.0), DVec3::new(5.2, 0.0, 0.0), 50.0);
    let center = DVec3::new(0.0, 1.0, 0.0);
    let lights = [
        rectangle_light(center, DVec2::new(0.2, 0.3)),
        disc_light(center, 0.25),
    ];
    with_gpu(|gpu| {
        for (light, split) in lights.iter().flat_map(|light| [(light, 1), (light, 3)]) {
            let shot = shot(
                scene.clone(),
                camera.clone(),
                light.clone(),
                64,
                settings(256, split),
            );
            let faces: Vec<u32> = planned(gpu, &shot).views().map(|v| v.view.face).collect();
            assert!(faces.iter().any(|&face| face != 0), "no side faces");
            let image = visibility(gpu, &shot);
            let truth = traced(&shot, 256);
            let mut errors = Vec::new();
            let (mut beside, mut dark, mut elsewhere) = (0, 0, 0u32);
            for (index, (&value, &truth)) in image.iter().zip(&truth).enumerate() {
                if value.is_nan() != truth.is_nan() {
                    elsewhere += 1;
                    continue;
                }
                if truth < 1.0 {
                    errors.push((value - truth).abs());
                    beside += 1;
                }
                if truth == 0.0 {
                    dark += 1;
                    assert!(value < 0.25, "pixel {index} is lit: {value}");
                }
            }
            // Of some 200 pixels on the borders of floor and wall, the share whose centres are so near to the edge that
            // the rasteriser's grid decides: none on lavapipe.
            assert!(
                f64::from(elsewhere) <= 200.0 * raster_grid(gpu),
                "{elsewhere} pixels see a surface that rays do not, or none"
            );
            let mean = errors.iter().sum::<f32>() / errors.len() as f32;
            println!(
                "split {split}: mean error {mean:.1e} over {beside} pixels, {dark} of them dark"
            );
            assert!(
                beside > 200 && dark > 20,
                "{beside} shadow pixels, {dark} dark"
            );
            // One flat occluder, so a single view sees all of its contour: what is left is the map's texel
            // and the tracing's noise, about 1 / 256 each.
            assert!(mean < 0.015, "split {split}: mean error {mean}");
        }
    });
}

fn traced(shot: &Shot, samples: u32) -> Vec<f32> {
    use halfshade::reference::{ReferenceOptions, trace};
    let options = ReferenceOptions { samples, seed: 1 };
    let image = trace(shot, 0, options, &|_| (), &Default::default());
    image.expect("a reference").visibility.data
}

/// A light without extent asks for a hard shadow, whatever the technique.
#[test]
fn a_light_without_extent_casts_a_hard_shadow() {
    let plate = Occluder::square(1.5, DVec2::new(0.1, -0.05), 0.45, 15.0);
    let scene = Triangles::new()
        .floor([-2.0, 2.0], [-2.0, 2.0])
        .plate(plate.height, &plate.corners())
        .build();
    let camera = camera(DVec3::new(-3.0, 1.4, 0.4), DVec3::ZERO, 40.0);
    with_gpu(|gpu| {
        for light in [disc_light(LIGHT, 0.0), rectangle_light(LIGHT, DVec2::ZERO)] {
            let shot = shot(scene.clone(), camera.clone(), light, 64, settings(256, 4));
            let image = render(gpu, &shot);
            for soft in [
                "hierarchy",
                "kernels",
                "classify",
                "packet_visibility",
                "pixel_visibility",
            ] {
                let planned = image.plan.steps().any(|step| step.pass.name == soft);
                assert!(!planned, "{soft} is planned");
            }
            let (mut lit, mut hidden) = (0, 0);
            let shift = 1.5 * texel(&image, LIGHT, plate.height);
            for (&value, position) in image.visibility.iter().zip(&image.positions) {
                let [x, y, z, surface] = position.map(f64::from);
                if surface == 0.0 || y > 1e-3 {
                    continue;
                }
                // A light of next to no size tells which side of the edge a point is on.
                let point = DVec3::new(x, y, z);
                let seen =
                    |by| rectangle_visibility(point, LIGHT, DVec2::splat(1e-9), &plate.grown(by));
                if seen(shift) > 0.5 {
                    assert_eq!(value, 1.0, "at {point}");
                    lit += 1;
                } else if seen(-shift) < 0.5 {
                    assert_eq!(value, 0.0, "at {point}");
                    hidden += 1;
                } else {
                    assert!(value == 0.0 || value == 1.0, "{value} at {point}");
                }
            }
            assert!(lit > 300 && hidden > 100, "{lit} lit, {hidden} hidden");
        }
    });
}

#[test]
fn memory_does_not_depend_on_the_split_where_views_are_alone() {
    let per_view = [
        "views",
        "fits",
        "hierarchy_groups",
        "lists",
        "rounds",
        "sectors",
    ];
    with_gpu(|gpu| {
        for name in SCENES {
            let bytes = [1, 2, 4, 8, 16].map(|split| {
                let settings = Settings {
                    views_at_once: Some(1),
                    ..settings(256, split)
                };
                let plan = planned(gpu, &load(name, 64, settings));
                let small = plan.memory().filter(|(name, _)| per_view.contains(name));
                plan.memory_bytes() - small.map(|(_, bytes)| bytes).sum::<u64>()
            });
            assert!(bytes.iter().all(|&b| b == bytes[0]), "{name}: {bytes:?}");
        }
    });
}

/// What n views hide, here 256 parts seen in two directions each, adds up in f32, one view after the other. Each sum
/// rounds by a share of 2^-24 at most, so that n - 1 of them are within (n - 1) · 2^-24 of the sum in f64.
#[test]
fn many_views_add_up() {
    let mut shot = load("plate", 24, settings(32, 16));
    shot.settings.packet = (1, 1);
    with_gpu(|gpu| {
        let mut renderer = renderer(gpu, &shot);
        renderer.render().expect("a frame");
        let image = renderer.visibility(0).expect("visibility");
        let views = renderer.plan().views().count() as u32;
        assert!(views >= 256, "{views} views");
        let mut hidden = vec![0.0f64; image.len()];
        for view in 0..views {
            renderer.render_view(view).expect("a view");
            let found: Vec<f32> = renderer
                .read_buffer("occlusion", image.len())
                .expect("what the view hides");
            for (sum, found) in hidden.iter_mut().zip(found) {
                *sum += f64::from(found);
            }
        }
        let weights = f64::from(renderer.plan().lights[0].light.weight_sum);
        let mut largest = 0.0f64;
        let mut partly = 0;
        for (value, hidden) in image.iter().zip(hidden) {
            if hidden > 0.0 {
                partly += usize::from(*value > 0.0 && *value < 1.0);
                largest = largest.max((f64::from(*value) - (1.0 - hidden / weights)).abs());
            }
        }
        println!("largest deviation {largest:.1e} of {partly} pixels in penumbrae");
        assert!(partly > 50, "{partly} pixels in penumbrae");
        // The bound, and the rounding of the quotient and of the difference.
        assert!(
            largest <= f64::from(views + 1) / f64::from(1 << 24),
            "{largest}"
        );
    });
}
