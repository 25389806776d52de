//! What else is in a scene, and where its planes happen to run, changes nothing of what is seen.

use std::sync::atomic::AtomicBool;

use halfshade::compare::compare;
use halfshade::image::Plane;
use halfshade::reference::{ReferenceImage, ReferenceOptions, trace};
use halfshade::scene::Shape;

use super::*;

const SIDE: u32 = 64;

pub fn traced(shot: &Shot, samples: u32) -> ReferenceImage {
    let options = ReferenceOptions { samples, seed: 0 };
    trace(shot, 0, options, &|_| {}, &AtomicBool::new(false)).expect("rays")
}

pub fn image(gpu: &Arc<Gpu>, shot: &Shot) -> Plane {
    let (width, height) = (shot.width as usize, shot.height as usize);
    Plane::new(width, height, visibility(gpu, shot)).expect("an image")
}

/// [visibility] Mean absolute error over pixels that see the whole light from their front.
pub fn error(gpu: &Arc<Gpu>, shot: &Shot, truth: &ReferenceImage) -> f64 {
    let metrics = compare(&image(gpu, shot), &truth.visibility, Some(&truth.facing));
    metrics.expect("pixels to compare").mae
}

/// A box on the ground under a square light, and more.
fn shot_with(more: &[Shape], scale: f64) -> Shot {
    let cuboid = Shape::cuboid(DVec3::new(-0.5, 0.0, -0.5), DVec3::new(0.2, 0.8, 0.2));
    let mut parts = vec![(Shape::square(4.0), Vec3::ONE), (cuboid, Vec3::ONE)];
    parts.extend(more.iter().map(|shape| (shape.clone(), Vec3::ONE)));
    for point in parts.iter_mut().flat_map(|(shape, _)| &mut shape.positions) {
        *point *= scale;
    }
    let eye = camera(
        DVec3::new(3.2, 3.0, 4.2) * scale,
        DVec3::Y * 0.4 * scale,
        40.0,
    );
    let light = rectangle_light(DVec3::Y * 3.0 * scale, DVec2::splat(0.5 * scale));
    let scene = Arc::new(Scene::of_shapes(&parts));
    shot(scene, eye, light, SIDE, settings(128, 2))
}

fn far_box(away: f64) -> Shape {
    let size = DVec3::new(100.0, 50.0, 100.0);
    Shape::cuboid(DVec3::X * away, DVec3::X * away + size)
}

/// A ball around everything.
fn dome(radius: f64) -> Shape {
    let mut ball = Shape::ball(radius, 16);
    ball.positions
        .iter_mut()
        .for_each(|point| point.y -= radius);
    ball
}

/// Of an object a long way off, of a dome around everything that is seen from inside, and of a wall on the horizon.
#[test]
fn what_is_far_away_changes_nothing_near() {
    with_gpu(|gpu| {
        let alone = shot_with(&[], 1.0);
        let truth = traced(&alone, 256);
        let expected = error(gpu, &alone, &truth);
        for away in [1e4, 1e6, 1e7] {
            let wall = Shape::cuboid(
                DVec3::new(-0.5, -0.1, -1.2) * away,
                DVec3::new(0.5, 0.1, -1.1) * away,
            );
            for (name, far) in [
                ("a box", far_box(away)),
                ("a dome", dome(away)),
                ("a wall", wall),
            ] {
                let found = error(gpu, &shot_with(&[far], 1.0), &truth);
                assert!(
                    (found - expected).abs() <= 0.1 * expected,
                    "{name} {away:e} away: {found}, without it {expected}"
                );
            }
        }
    });
}

/// A thing of a centimetre on a ground of kilometres: positions are as exact as what is looked at asks for.
#[test]
fn the_size_of_the_ground_changes_nothing_on_it() {
    with_gpu(|gpu| {
        let small = shot_with(&[], 0.01);
        let truth = traced(&small, 256);
        let expected = error(gpu, &small, &truth);
        let mut wide = small.clone();
        for point in &mut Arc::make_mut(&mut wide.scene).positions[..4] {
            *point *= 1e5;
        }
        let found = compare(&image(gpu, &wide), &truth.visibility, Some(&truth.facing));
        let found = found.expect("pixels to compare");
        assert!(
            found.mae <= 1.1 * expected,
            "{} on the wide ground, else {expected}",
            found.mae
        );
    });
}

/// Nothing nearer than a camera's near plane is seen, by device and rays alike.
#[test]
fn a_near_plane_hides_what_is_before_it() {
    with_gpu(|gpu| {
        let mut cut = shot_with(&[], 1.0);
        cut.camera.near = Some(5.8);
        let (found, truth) = (image(gpu, &cut), traced(&cut, 16).visibility);
        let whole = image(gpu, &shot_with(&[], 1.0));
        let surfaces = |plane: &Plane| plane.data.iter().filter(|value| !value.is_nan()).count();
        assert!(surfaces(&found) + 300 < surfaces(&whole));
        let apart = found.data.iter().zip(&truth.data);
        let apart = apart.filter(|(a, b)| a.is_nan() != b.is_nan()).count();
        // [pixel] On the cut, where rounding decides.
        assert!(apart <= 2, "{apart} pixels");
    });
}

/// The sides of a box below a light of its width run through the light's edges: no part of the light is in front of them.
/// So it is when everything is turned, and none of the numbers is round.
#[test]
fn planes_through_the_lights_edges_are_dark() {
    let turns = [
        DQuat::IDENTITY,
        DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.7),
    ];
    let techniques = [Technique::PacketContour, Technique::ReferenceMaps];
    with_gpu(|gpu| {
        for (turn, technique) in turns.iter().flat_map(|turn| techniques.map(|t| (*turn, t))) {
            let corner = DVec3::new(0.5, 1.0, 0.5);
            let mut cuboid = Shape::cuboid(DVec3::new(-corner.x, 0.0, -corner.z), corner);
            for point in &mut cuboid.positions {
                *point = turn * *point;
            }
            let mut light = rectangle_light(turn * (DVec3::Y * 3.0), DVec2::splat(0.5));
            light.shape = LightShape::Rect {
                u: turn * (DVec3::X * 0.5),
                v: turn * (DVec3::Z * 0.5),
            };
            let mut view = camera(
                turn * DVec3::new(3.2, 1.4, 4.2),
                turn * (DVec3::Y * 0.4),
                30.0,
            );
            view.up = turn * DVec3::Y;
            let settings = Settings {
                maps: 16,
                ..Settings {
                    technique,
                    ..settings(64, 2)
                }
            };
            let scene = Arc::new(Scene::of_shapes(&[(cuboid, Vec3::ONE)]));
            let shot = shot(scene, view, light, SIDE, settings);
            let truth = traced(&shot, 16);
            let found = image(gpu, &shot);
            let pixels = found.data.iter().zip(&truth.facing.data);
            let sides: Vec<f32> = pixels
                .filter(|(value, facing)| !value.is_nan() && **facing < 0.5)
                .map(|(value, _)| *value)
                .collect();
            assert!(sides.len() > 500, "{} pixels", sides.len());
            assert!(sides.iter().all(|&value| value == 0.0), "{technique}");
            let lit = truth.visibility.data.iter().zip(&truth.facing.data);
            let lit = lit.filter(|(value, facing)| **facing < 0.5 && **value > 0.0);
            assert_eq!(lit.count(), 0, "rays");
        }
    });
}

/// A point without direction between a floor and a ceiling with a plate before each.
#[test]
fn a_point_without_direction_casts_shadows_to_all_sides() {
    let scene = Triangles::new()
        .floor([-4.0, 4.0], [-4.0, 4.0])
        .plate(4.0, &rectangle([-4.0, 4.0], [-4.0, 4.0]))
        .plate(1.0, &rectangle([-0.5, 0.4], [-0.5, 0.6]))
        .plate(3.0, &rectangle([-0.3, 0.7], [-0.5, 0.5]))
        .build();
    let eye = camera(DVec3::new(5.0, 2.1, 6.0), DVec3::Y * 2.0, 60.0);
    let mut light = disc_light(DVec3::new(0.1, 2.0, 0.05), 0.0);
    light.shape = LightShape::Disc {
        normal: DVec3::ZERO,
        radius: 0.0,
    };
    let shot = shot(scene, eye, light, SIDE, Settings::default());
    let truth = traced(&shot, 16).visibility;
    let counts = |wanted: f32| truth.data.iter().filter(|&&v| v == wanted).count();
    assert!(counts(0.0) > 50 && counts(1.0) > 500);
    with_gpu(|gpu| {
        let found = image(gpu, &shot);
        let apart = found.data.iter().zip(&truth.data);
        let apart = apart.filter(|(a, b)| (*a - *b).abs() > 0.5).count();
        // [pixel] A texel along the shadows' edges.
        assert!(apart <= 15, "{apart} pixels");
    });
}

/// Parallel rays see what a pinhole sees from very far away, and what rays see that are traced.
#[test]
fn parallel_rays() {
    let mut shot = shot_with(&[], 1.0);
    // A hair beside the corners and edges of the box, which rays would meet exactly.
    shot.camera.ortho_height = Some(4.7);
    let mut far = shot.clone();
    let (away, distance) = (1e4, shot.camera.eye.distance(shot.camera.target));
    let back = (shot.camera.eye - shot.camera.target) / distance;
    far.camera.eye = shot.camera.target + back * away;
    far.camera.ortho_height = None;
    far.camera.vfov_deg = 2.0 * (0.5 * 4.7 / away).atan().to_degrees();
    with_gpu(|gpu| {
        let (parallel, pinhole) = (visibility(gpu, &shot), visibility(gpu, &far));
        let pairs = parallel.iter().zip(&pinhole);
        let apart = |(a, b): &(&f32, &f32)| a.is_nan() != b.is_nan() || (**a - **b).abs() > 0.02;
        let differ = pairs.filter(apart).count();
        // Edges of the box and of the ground run between pixels.
        assert!(differ <= 40, "{differ} pixels differ");
        let seen = parallel.iter().filter(|value| !value.is_nan()).count();
        assert!(seen > 2000, "{seen} pixels see something");
        let truth = traced(&shot, 256);
        let error = error(gpu, &shot, &truth);
        assert!(error < 0.01, "{error}");
    });
}
