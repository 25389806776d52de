//! The ends of the range, and the steps between.

use super::*;

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
            assert_eq!(image.plan.lights[0].lighting, Lighting::Unshadowed);
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
        // Not above the receivers, so that their places relative to the eye have all bits in use as well.
        let (eye, target) = (DVec3::Y, DVec3::new(PLACE.x, 0.0, PLACE.y));
        let vfov = 2.0 * (reach / eye.distance(target)).atan();
        let camera = camera(eye, target, vfov.to_degrees());
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
                    let tangent = (position[world] - center[world]) / LIGHT_HEIGHT;
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
