//! Generated scenes.

use super::*;

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
