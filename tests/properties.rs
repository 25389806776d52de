//! What must hold for any scene: the ends of the range are exact, small moves have small effects, and
//! neither the frame of reference, nor the device's order of work, nor an earlier frame shows.

#[path = "support/closed_form.rs"]
mod closed_form;
#[path = "support/gpu.rs"]
mod support;

use std::sync::Arc;

use closed_form::{Occluder, rectangle_visibility};
use glam::{DQuat, DVec2, DVec3, Vec3};
use halfshade::gpu::Gpu;
use halfshade::plan::{Outcome, Outputs, Plan, plan};
use halfshade::scene::{AreaLight, LightShape, Scene};
use halfshade::shot::{Settings, Shot, Technique};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use support::{
    Image, SCENES, Triangles, camera, disc_light, load, positions, rectangle, rectangle_light,
    render, renderer, same_bits, shot, visibility, with_gpu,
};

const LIGHT: DVec3 = DVec3::new(0.1, 3.0, -0.05);
const HALF: DVec2 = DVec2::new(0.5, 0.4);

fn settings(map: u32, split: u32) -> Settings {
    Settings {
        map,
        split,
        ..Settings::default()
    }
}

/// [scene units] The largest texel of any view at a height below a light that shines down.
fn texel(image: &Image, light: DVec3, height: f64) -> f64 {
    let focal = image.fits.iter().flat_map(|fit| fit.focal);
    let least = focal
        .filter(|&focal| focal > 0.0)
        .fold(f32::INFINITY, f32::min);
    (light.y - height) / f64::from(least)
}

fn planned(gpu: &Gpu, shot: &Shot) -> Plan {
    plan(shot, Outputs { picture: false }, &gpu.limits, false).expect("a plan")
}

/// Both ends of the range come out exactly, however many views add up: whatever the contour, segments that
/// miss the light add 0 and not a little, and the weights of all views add up in one order.
#[test]
fn lit_is_exactly_one_and_blocked_exactly_zero() {
    let plate = Occluder::square(1.5, DVec2::new(0.1, -0.05), 1.1, 15.0);
    let scene = Triangles::new()
        .floor([-4.0, 4.0], [-4.0, 4.0])
        .plate(plate.height, &plate.corners())
        .build();
    let camera = camera(DVec3::new(-5.0, 1.4, 0.4), DVec3::new(0.0, 0.0, 0.1), 46.0);
    let rectangle = rectangle_light(LIGHT, HALF);
    let disc = disc_light(LIGHT, HALF.x);
    let cases = [
        (&rectangle, 1),
        (&rectangle, 3),
        (&rectangle, 4),
        (&disc, 1),
        (&disc, 4),
    ];
    with_gpu(|gpu| {
        for (light, split) in cases {
            let shot = shot(
                scene.clone(),
                camera.clone(),
                light.clone(),
                96,
                settings(128, split),
            );
            let image = render(gpu, &shot);
            // Two texels off the penumbra's borders, and for the disc off those of the square round it.
            let half = if light == &disc {
                DVec2::splat(HALF.x)
            } else {
                HALF
            };
            let shift = 2.0 * texel(&image, LIGHT, plate.height);
            let (mut lit, mut blocked) = (0, 0);
            for (&value, position) in image.visibility.iter().zip(&image.positions) {
                let [x, y, z, surface] = position.map(f64::from);
                if surface == 0.0 || y > 1e-3 {
                    continue;
                }
                let point = DVec3::new(x, y, z);
                if rectangle_visibility(point, LIGHT, half, &plate.grown(shift)) >= 1.0 {
                    assert_eq!(value, 1.0, "split {split} at {point}");
                    lit += 1;
                }
                if rectangle_visibility(point, LIGHT, half, &plate.grown(-shift)) <= 1e-12 {
                    assert_eq!(value, 0.0, "split {split} at {point}");
                    blocked += 1;
                }
            }
            assert!(lit > 300 && blocked > 300, "{lit} lit, {blocked} blocked");
        }
    });
}

#[test]
fn without_occluders_all_is_lit() {
    let scene = Triangles::new().floor([-2.0, 2.0], [-2.0, 2.0]).build();
    let camera = camera(DVec3::new(-3.0, 1.4, 0.4), DVec3::ZERO, 40.0);
    with_gpu(|gpu| {
        for split in [1, 4] {
            let light = rectangle_light(LIGHT, HALF);
            let shot = shot(
                scene.clone(),
                camera.clone(),
                light,
                64,
                settings(128, split),
            );
            let image = render(gpu, &shot);
            assert_eq!(image.plan.lights[0].outcome, Outcome::Unshadowed);
            for (value, position) in image.visibility.iter().zip(&image.positions) {
                assert!(if position[3] > 0.0 {
                    *value == 1.0
                } else {
                    value.is_nan()
                });
            }
        }
    });
}

/// Receivers one ulp apart, swept over every kind of contour segment, its vertices, texel centres and cell
/// centres, so that the light's centre passes over them (traps 1 and 2 of the algorithm's description): a wrong
/// answer there is wrong by the whole light.
mod ulps {
    use super::*;

    const HEIGHT: f64 = 1.5;
    const LIGHT_HEIGHT: f64 = 3.0;
    /// Where the receivers are: any place with all bits in use.
    const PLACE: DVec2 = DVec2::new(0.7654321, 0.5432109);
    /// [ulp] Half the side of the receivers' square.
    const REACH: f64 = 8.0;
    const SIDE: u32 = 16;
    const MAP: u32 = 64;
    /// [visibility] Rounding of the sum of some hundred segments, each of the order of 1.
    const ROUNDING: f32 = 1e-5;

    /// Squares that show all 14 kinds of cell; some touch in a corner, which makes the saddles.
    fn occluders() -> Triangles {
        let square = |x: [f64; 2], z: [f64; 2]| rectangle(x, z);
        let turned = |degrees: f64, at: DVec2, half: f64| {
            Occluder::square(HEIGHT, at, half, degrees).corners()
        };
        Triangles::new()
            .plate(HEIGHT, &square([0.0, 0.04], [0.0, 0.04]))
            .plate(HEIGHT, &square([-0.04, 0.0], [-0.04, 0.0]))
            .plate(HEIGHT, &square([0.05, 0.09], [-0.04, 0.0]))
            .plate(HEIGHT, &square([0.01, 0.05], [-0.08, -0.04]))
            .plate(HEIGHT, &square([0.05, 0.09], [-0.12, -0.08]))
            .plate(HEIGHT, &turned(45.0, DVec2::new(-0.05, 0.06), 0.03))
            .plate(HEIGHT, &turned(20.0, DVec2::new(0.07, 0.075), 0.02))
            .plate(HEIGHT, &turned(70.0, DVec2::new(-0.07, -0.075), 0.015))
    }

    /// The light whose centre a receiver sees in the direction of a point of the occluders' plane.
    fn light_behind(point: DVec2, half: f64, round: bool) -> AreaLight {
        let at = PLACE + (point - PLACE) * (LIGHT_HEIGHT / HEIGHT);
        let center = DVec3::new(at.x, LIGHT_HEIGHT, at.y);
        if round {
            disc_light(center, half)
        } else {
            rectangle_light(center, DVec2::splat(half))
        }
    }

    /// The receivers alone are seen; the occluders are behind the camera.
    fn shot_of(occluders: Triangles, lights: Vec<AreaLight>, settings: Settings) -> Shot {
        let reach = REACH * f64::from(f32::EPSILON) / 2.0;
        let floor = rectangle(
            [PLACE.x - reach, PLACE.x + reach],
            [PLACE.y - reach, PLACE.y + reach],
        );
        let scene = occluders.plate(0.0, &floor).build();
        let eye = DVec3::new(PLACE.x, 1.0, PLACE.y);
        let camera = camera(eye, eye - DVec3::Y, 2.0 * reach.atan().to_degrees());
        let mut shot = shot(scene, camera, lights[0].clone(), SIDE, settings);
        shot.lights = lights;
        shot
    }

    /// The points of the map where something could turn over.
    fn critical_points(map: &[f32]) -> Vec<DVec2> {
        let sample = |x: usize, y: usize| usize::from(map[y * MAP as usize + x] > 0.0);
        let mut seen = [0; 16];
        let mut points = Vec::new();
        for y in 0..MAP as usize - 1 {
            for x in 0..MAP as usize - 1 {
                let mask = sample(x, y)
                    | sample(x + 1, y) << 1
                    | sample(x + 1, y + 1) << 2
                    | sample(x, y + 1) << 3;
                seen[mask] += 1;
                if mask == 0 || mask == 15 || seen[mask] > 1 {
                    continue;
                }
                // Edge midpoints, their means (on segments of every kind), corner and centre.
                let spots = [
                    (0.5, 0.0),
                    (1.0, 0.5),
                    (0.5, 1.0),
                    (0.0, 0.5),
                    (0.25, 0.25),
                    (0.75, 0.25),
                    (0.75, 0.75),
                    (0.25, 0.75),
                    (0.0, 0.0),
                    (0.5, 0.5),
                    (0.5, 0.25),
                    (0.25, 0.5),
                ];
                points.extend(spots.map(|(u, v)| DVec2::new(x as f64 + u, y as f64 + v)));
            }
        }
        let missing: Vec<_> = (1..15).filter(|&mask| seen[mask] == 0).collect();
        assert!(missing.is_empty(), "no cells of the kinds {missing:?}");
        points
    }

    /// The largest jump over all lights. At each, the light's centre passes over the point of the map.
    fn largest_jump(gpu: &Arc<Gpu>, half: f64, round: bool, settings: Settings) -> f32 {
        let center = light_behind(DVec2::ZERO, half, round);
        let origin = DVec2::new(center.center.x, center.center.z);
        let mut first = renderer(gpu, &shot_of(occluders(), vec![center], settings.clone()));
        first.render().expect("a frame");
        let fit = first.fits().expect("fits")[0];
        let map: Vec<f32> = first
            .read_image("shadow_map", (MAP * MAP) as usize)
            .expect("a map");
        let on_map = |v: [f32; 2]| DVec2::new(v[0].into(), v[1].into());
        let points = critical_points(&map);
        let on_plane = |t: DVec2| origin + (t - on_map(fit.center)) / on_map(fit.focal) * HEIGHT;
        let lights = points
            .iter()
            .map(|&t| light_behind(on_plane(t), half, round))
            .collect();
        drop(first);
        let shot = shot_of(occluders(), lights, settings);
        let mut renderer = renderer(gpu, &shot);
        renderer.render().expect("a frame");
        let fits = renderer.fits().expect("fits");
        let positions = positions(&renderer, &shot);
        let mut worst = 0.0f32;
        for (index, (light, &target)) in shot.lights.iter().zip(&points).enumerate() {
            let values = renderer.visibility(index).expect("visibility");
            let ends = |values: &mut dyn Iterator<Item = f64>| {
                values.fold(
                    (f64::INFINITY, f64::NEG_INFINITY),
                    |(lower, upper), value| (lower.min(value), upper.max(value)),
                )
            };
            let fit = &fits[index];
            let center = light.center.as_vec3().as_dvec3();
            let mut range = DVec2::ZERO;
            for (axis, focal) in fit.focal.into_iter().enumerate() {
                let world = 2 * axis;
                let (lower, upper) = ends(&mut positions.iter().map(|position| {
                    let tangent = (f64::from(position[world]) - center[world]) / LIGHT_HEIGHT;
                    f64::from(focal) * tangent + f64::from(fit.center[axis])
                }));
                assert!(
                    lower < target[axis] && target[axis] < upper,
                    "{target} is not swept: {lower} to {upper}"
                );
                range[axis] = upper - lower;
            }
            // A texel of the occluders is 1 / focal · z_o · z_p / (z_p − z_o) of the light's plane; the light
            // is no wider than 2 √2 half sizes, and at least π half sizes² large, whichever it is.
            let texel = HEIGHT * LIGHT_HEIGHT
                / (LIGHT_HEIGHT - HEIGHT)
                / f64::from(fit.focal[0].min(fit.focal[1]));
            let edges = 2.0; // across the light at once, in all
            let warranted =
                edges * 2.0 * 2f64.sqrt() / std::f64::consts::PI * range.length() * texel / half;
            let (lower, upper) = ends(&mut values.iter().map(|&value| f64::from(value)));
            assert!(
                lower.is_finite() && upper.is_finite(),
                "every pixel sees a receiver"
            );
            let jump = (upper - lower) as f32;
            assert!(
                jump <= warranted as f32 + ROUNDING,
                "visibility {lower} to {upper} about {target}, light {index}"
            );
            worst = worst.max(jump);
        }
        worst
    }

    #[test]
    fn no_jumps_about_any_kind_of_contour() {
        with_gpu(|gpu| {
            for (round, packet, technique) in [
                (false, (4, 4), Technique::PacketContour),
                (false, (1, 1), Technique::PacketContour),
                (false, (4, 4), Technique::PixelContour),
                (true, (4, 4), Technique::PacketContour),
            ] {
                let settings = Settings {
                    packet,
                    technique,
                    ..settings(MAP, 1)
                };
                let jump = largest_jump(gpu, 1.0, round, settings);
                println!("round {round}, packet {packet:?}, {technique:?}: {jump:.1e}");
            }
        });
    }

    /// Edges longer than the light: the map is fitted to the part between light and receivers, which puts
    /// an edge along an axis exactly on contour vertices, and a corner on one.
    #[test]
    fn no_jumps_about_long_edges() {
        let cases: [(f64, Vec<DVec2>); 4] = [
            (0.0, rectangle([0.0, 3.0], [-3.0, 3.0]).to_vec()),
            (0.0, rectangle([-3.0, 3.0], [-3.0, 0.0]).to_vec()),
            (0.0, rectangle([0.0, 3.0], [0.0, 3.0]).to_vec()),
            (
                1.0,
                [(-3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)]
                    .map(|(x, z)| DVec2::new(x, z))
                    .to_vec(),
            ),
        ];
        with_gpu(|gpu| {
            for (diagonal, corners) in cases {
                // The edge itself, and a little to each side.
                let offsets = [-3e-8, -1e-8, 0.0, 1e-8, 3e-8];
                let lights =
                    offsets.map(|at| light_behind(DVec2::new(at, -at * diagonal), 0.4, false));
                let plate = Triangles::new().plate(HEIGHT, &corners);
                let shot = shot_of(plate, lights.to_vec(), settings(MAP, 1));
                let mut renderer = renderer(gpu, &shot);
                renderer.render().expect("a frame");
                for (index, fit) in renderer.fits().expect("fits").iter().enumerate() {
                    let values = renderer.visibility(index).expect("visibility");
                    let lower = values.iter().copied().fold(f32::INFINITY, f32::min);
                    let upper = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
                    let width = 2.0 * REACH as f32 * f32::EPSILON;
                    // The receivers' square, projected onto the light, as a share of its width; a corner
                    // has two edges, each as long as the light at most.
                    let warranted = 2.0 * 2f32.sqrt() * width / 0.8;
                    assert!(
                        upper - lower <= warranted + ROUNDING,
                        "{lower} to {upper}, {fit:?}"
                    );
                    println!("long edge: {:.1e}", upper - lower);
                    // The contour is within 1.5 texels of the edge, a texel of the fitted map being worth:
                    let texel = HEIGHT as f32 * 2.0 / fit.focal[0].min(fit.focal[1]) / 0.8;
                    let expected = if corners[2] == DVec2::splat(3.0) && corners[0] == DVec2::ZERO {
                        0.75
                    } else {
                        0.5
                    };
                    assert!(
                        (lower - expected).abs() <= 1.5 * texel * 2f32.sqrt(),
                        "{lower}, not {expected}"
                    );
                }
            }
        });
    }
}

/// Moves, turns and scales everything.
struct Similarity {
    scale: f64,
    rotation: DQuat,
    translation: DVec3,
}

impl Similarity {
    fn point(&self, p: DVec3) -> DVec3 {
        self.translation + self.vector(p)
    }

    fn vector(&self, v: DVec3) -> DVec3 {
        self.rotation * v * self.scale
    }

    fn back(&self, p: DVec3) -> DVec3 {
        self.rotation.inverse() * (p - self.translation) / self.scale
    }
}

/// Rounding of coordinates moves what the map samples by some 1e-7 of the scene's size, 1e-4 texels. Now and
/// then that tips a vertex over to the rasteriser's next position, 1/256 texel away, and with it one sample in
/// 256 along an edge; each moves the contour by a texel there, out of some tens of texels that the light sees.
/// So: on the mean 1/256 of a texel's worth of penumbra, and all but one pixel in a thousand within a 16th.
#[test]
fn the_frame_of_reference_does_not_matter() {
    let plates = [
        Occluder::square(1.5, DVec2::new(0.4, -0.3), 0.35, 15.0),
        Occluder::square(0.8, DVec2::new(-0.6, 0.4), 0.3, 40.0),
        Occluder::square(0.4, DVec2::new(0.5, 0.8), 0.25, 70.0),
    ];
    let base = plates.iter().fold(
        Triangles::new().floor([-2.0, 2.0], [-2.0, 2.0]),
        |scene, plate| scene.plate(plate.height, &plate.corners()),
    );
    let build = |how: &Similarity| {
        let moved = Triangles(
            base.0
                .iter()
                .map(|t| t.map(|corner| how.point(corner)))
                .collect(),
        );
        let (eye, target) = (DVec3::new(-2.5, 3.2, 2.0), DVec3::new(0.0, 0.2, 0.1));
        let mut view = camera(how.point(eye), how.point(target), 44.0);
        view.up = how.rotation * DVec3::Y;
        let mut light = rectangle_light(how.point(LIGHT), HALF);
        light.shape = LightShape::Rect {
            u: how.vector(DVec3::X * HALF.x),
            v: how.vector(DVec3::Z * HALF.y),
        };
        let origin = how.point(DVec3::new(0.0, 0.75, 0.0));
        shot(moved.build_at(origin), view, light, 96, settings(256, 1))
    };
    let turn = DQuat::from_axis_angle(DVec3::new(0.3, 0.8, -0.5).normalize(), 1.234);
    let (no_turn, here) = (DQuat::IDENTITY, DVec3::ZERO);
    let far = DVec3::new(4000.0, -3000.0, 2000.0);
    let cases = [
        (1e-3, no_turn, here),
        (1e3, no_turn, here),
        (1.0, no_turn, far),
        (1.0, turn, here),
        (37.0, turn, far),
    ];
    with_gpu(|gpu| {
        let identity = Similarity {
            scale: 1.0,
            rotation: no_turn,
            translation: here,
        };
        let shot = build(&identity);
        let expected = render(gpu, &shot);
        let place = |image: &Image, pixel: usize, how: &Similarity, origin: DVec3| {
            let [x, y, z, surface] = image.positions[pixel];
            (surface > 0.0).then(|| how.back(origin + Vec3::new(x, y, z).as_dvec3()))
        };
        for (scale, rotation, translation) in cases {
            let how = Similarity {
                scale,
                rotation,
                translation,
            };
            let moved = build(&how);
            let image = render(gpu, &moved);
            let mut shares = Vec::new();
            let mut elsewhere = 0;
            for pixel in 0..image.visibility.len() {
                let before = place(&expected, pixel, &identity, shot.scene.origin);
                let after = place(&image, pixel, &how, moved.scene.origin);
                let (Some(before), Some(after)) = (before, after) else {
                    elsewhere += usize::from(before.is_some() != after.is_some());
                    continue;
                };
                // At silhouettes a pixel may see another surface.
                if before.distance(after) > 1e-3 {
                    elsewhere += 1;
                    continue;
                }
                let worth: f64 = plates
                    .iter()
                    .filter(|plate| plate.height > before.y + 1e-3)
                    .map(|plate| {
                        let half = 0.5 * texel(&expected, LIGHT, plate.height);
                        let seen = |by| rectangle_visibility(before, LIGHT, HALF, &plate.grown(by));
                        // The penumbra's border is less than a texel off.
                        let border = seen(-4.0 * half) - seen(4.0 * half);
                        (seen(-half) - seen(half)).max(0.25 * border)
                    })
                    .sum();
                let difference =
                    f64::from((image.visibility[pixel] - expected.visibility[pixel]).abs());
                if worth > 0.0 {
                    shares.push(difference / worth.max(1e-4));
                } else {
                    assert!(
                        difference <= 1e-5,
                        "off by {difference} at {before}, outside all penumbrae"
                    );
                }
            }
            shares.sort_by(f64::total_cmp);
            assert!(
                shares.len() > 500,
                "only {} pixels in the penumbra",
                shares.len()
            );
            let mean = shares.iter().sum::<f64>() / shares.len() as f64;
            let most = shares[shares.len() * 999 / 1000];
            println!(
                "scale {scale}: mean {mean:.1e}, 99.9 % {most:.1e} texels, {elsewhere} pixels see another place"
            );
            assert!(
                elsewhere * 100 <= image.visibility.len(),
                "{elsewhere} pixels see another place"
            );
            assert!(
                mean <= 1.0 / 256.0,
                "scale {scale}: {mean} texels on the mean"
            );
            assert!(most <= 1.0 / 16.0, "scale {scale}: {most} texels");
        }
    });
}

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

#[test]
fn a_retained_frame_has_the_same_bits_and_draws_no_map() {
    let shot = load("knot", 64, settings(128, 1));
    with_gpu(|gpu| {
        let mut renderer = renderer(gpu, &shot);
        let frame = renderer.render().expect("a frame");
        assert!(!frame.plan.is_retained());
        let first = renderer.visibility(0).expect("visibility");
        assert!(renderer.recorded().iter().any(|name| name == "shadow_map"));

        let frame = renderer.render().expect("a frame");
        assert!(frame.plan.is_retained());
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
            "mssm",
        ];
        for name in renderer.recorded() {
            assert!(!of_map.contains(&name.as_str()), "{name} ran");
        }

        renderer.invalidate();
        let frame = renderer.render().expect("a frame");
        assert!(!frame.plan.is_retained());
        assert!(same_bits(
            &first,
            &renderer.visibility(0).expect("visibility")
        ));
    });
}

#[test]
fn what_is_recorded_is_what_was_planned() {
    with_gpu(|gpu| {
        for (name, technique) in SCENES.iter().flat_map(|name| {
            [
                Technique::PacketContour,
                Technique::PixelContour,
                Technique::Hard,
            ]
            .map(|t| (name, t))
        }) {
            let settings = Settings {
                technique,
                ..settings(64, 1 + u32::from(*name == "knot"))
            };
            let shot = load(name, 16, settings);
            let mut renderer = renderer(gpu, &shot);
            for _ in 0..2 {
                let frame = renderer.render().expect("a frame");
                let mut recorded: Vec<(&str, u32)> = Vec::new();
                for pass in renderer.recorded() {
                    match recorded.iter_mut().find(|(known, _)| known == pass) {
                        Some((_, count)) => *count += 1,
                        None => recorded.push((pass, 1)),
                    }
                }
                assert_eq!(recorded, frame.plan.passes, "{name}, {technique:?}");
            }
        }
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
            let (mut beside, mut dark) = (0, 0);
            for (index, (&value, &truth)) in image.iter().zip(&truth).enumerate() {
                assert_eq!(value.is_nan(), truth.is_nan(), "pixel {index}");
                if truth < 1.0 {
                    errors.push((value - truth).abs());
                    beside += 1;
                }
                if truth == 0.0 {
                    dark += 1;
                    assert!(value < 0.25, "pixel {index} is lit: {value}");
                }
            }
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
    use halfshade::cpu::reference::{ReferenceOptions, trace};
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
                "mssm",
                "kernels",
                "classify",
                "packet_visibility",
                "pixel_visibility",
            ] {
                let planned = image.plan.passes.iter().any(|(name, _)| *name == soft);
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
fn memory_does_not_depend_on_the_split() {
    let per_view = ["views", "fits", "lists", "sectors"];
    with_gpu(|gpu| {
        for name in SCENES {
            let bytes = [1, 2, 4, 8, 16].map(|split| {
                let plan = planned(gpu, &load(name, 64, settings(256, split)));
                let small = plan
                    .resources
                    .iter()
                    .filter(|(name, _)| per_view.contains(name));
                plan.memory_bytes() - small.map(|(_, bytes)| bytes).sum::<u64>()
            });
            assert!(bytes.iter().all(|&b| b == bytes[0]), "{name}: {bytes:?}");
        }
    });
}

/// The same cases in every run.
fn runner(cases: u32) -> TestRunner {
    let config = Config {
        cases,
        max_shrink_iters: 8,
        failure_persistence: None,
        ..Config::default()
    };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

prop_compose! {
    fn a_point()(x in -2.0..2.0, y in 0.0..2.5, z in -2.0..2.0) -> DVec3 {
        DVec3::new(x, y, z)
    }
}

prop_compose! {
    fn a_light()(
        center in a_point(), axis in a_point(), turn in 0.0..6.3, half in (0.01..1.5, 0.01..1.5), round: bool,
    ) -> AreaLight {
        let turned = DQuat::from_axis_angle((axis - DVec3::Y * 1.2).normalize_or(DVec3::X), turn);
        let shape = if round {
            LightShape::Disc { normal: turned * DVec3::Z, radius: half.0 }
        } else {
            LightShape::Rect { u: turned * DVec3::X * half.0, v: turned * DVec3::Y * half.1 }
        };
        support::light(center + DVec3::Y * 0.5, shape)
    }
}

/// Triangles anywhere, through each other and through the light, seen by a camera among them.
#[test]
fn any_soup_has_visibilities_between_zero_and_one() {
    let soups = (
        vec([a_point(), a_point(), a_point()], 1..40),
        a_light(),
        a_point(),
        1..3u32,
    );
    with_gpu(|gpu| {
        let result = runner(16).run(&soups, |(triangles, light, eye, split)| {
            let scene: Arc<Scene> = Triangles(triangles).floor([-3.0, 3.0], [-3.0, 3.0]).build();
            let camera = camera(eye + DVec3::new(0.1, 2.0, 3.0), DVec3::ZERO, 60.0);
            let image = render(gpu, &shot(scene, camera, light, 32, settings(64, split)));
            for (&value, position) in image.visibility.iter().zip(&image.positions) {
                let surface = position[3] > 0.0;
                let sane = if surface {
                    (0.0..=1.0).contains(&value)
                } else {
                    value.is_nan()
                };
                prop_assert!(sane, "visibility {} at {:?}", value, position);
            }
            Ok(())
        });
        result.expect("visibilities between 0 and 1");
    });
}

/// Plates beside each other hide areas that add up, so one more can only darken; but it may widen the fitted
/// map, and each edge may then be off by 1.5 of its texels, before and after.
#[test]
fn one_more_plate_never_brightens() {
    const HEIGHT: f64 = 1.4;
    let plate = |cell: u32, half: f64, degrees: f64| {
        let at = DVec2::new(f64::from(cell % 4), f64::from(cell / 4)) - 1.5;
        Occluder::square(HEIGHT, at * 0.5, half, degrees)
    };
    let plates = vec((0.05..0.17f64, 0.0..90.0f64), 16);
    let chosen = (plates, 1..=0x7fffu32, 0..16u32, 1..3u32);
    with_gpu(|gpu| {
        let result = runner(16).run(&chosen, |(plates, chosen, added, split)| {
            let image_of = |chosen: u32| {
                let list: Vec<Occluder> = (0..16)
                    .filter(|cell| chosen >> cell & 1 == 1)
                    .map(|cell| plate(cell, plates[cell as usize].0, plates[cell as usize].1))
                    .collect();
                let scene = list.iter().fold(
                    Triangles::new().floor([-2.0, 2.0], [-2.0, 2.0]),
                    |scene, plate| scene.plate(HEIGHT, &plate.corners()),
                );
                let camera = camera(DVec3::new(-3.0, 1.3, 0.4), DVec3::ZERO, 44.0);
                let light = rectangle_light(LIGHT, HALF);
                (
                    list,
                    render(
                        gpu,
                        &shot(scene.build(), camera, light, 48, settings(128, split)),
                    ),
                )
            };
            let (_, before) = image_of(chosen & !(1 << added));
            let (list, after) = image_of(chosen | 1 << added);
            let shift = 1.5 * texel(&after, LIGHT, HEIGHT);
            for (pixel, position) in after.positions.iter().enumerate() {
                let [x, y, z, surface] = position.map(f64::from);
                if surface == 0.0 || before.positions[pixel] != *position || y > 1e-3 {
                    continue;
                }
                let point = DVec3::new(x, y, z);
                let seen = |plate: &Occluder, by: f64| {
                    rectangle_visibility(point, LIGHT, HALF, &plate.grown(by))
                };
                let worth: f64 = list
                    .iter()
                    .map(|plate| seen(plate, -shift) - seen(plate, shift))
                    .sum();
                let brighter = f64::from(after.visibility[pixel] - before.visibility[pixel]);
                prop_assert!(
                    brighter <= worth + 1e-5,
                    "brighter by {brighter} at {point}, where {worth} is allowed"
                );
            }
            Ok(())
        });
        result.expect("no brightening");
    });
}
