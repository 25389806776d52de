//! Ray-traced truth against closed forms, judged by statistics: the deviations must look like noise
//! of the size that the image itself states, not merely be small.
#![cfg(feature = "cli")]

mod stage;
mod statistics;

use std::f64::consts::PI;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec3;
use halfshade::reference::{ReferenceOptions, trace};
use halfshade::scene::{LightShape, Material, Scene, Texture, Wrap};
use halfshade::shot::Shot;

use stage::{
    EYE, LIGHT, OCCLUDER, SIZE, floor, floor_points, grey, half_plane, plate, rect, shot, traced,
};
use statistics::assert_agrees;

/// Where the line from the floor at `x` through an occluder's edge at `edge` meets the light's plane.
fn projected(x: f64, edge: f64) -> f64 {
    x + (edge - x) * LIGHT / OCCLUDER
}

/// The length that two intervals share.
fn overlap(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[1].min(b[1]) - a[0].max(b[0])).max(0.0)
}

#[test]
fn half_plane_under_a_rectangle() {
    let (edge, u) = (0.125, 0.7);
    // Far from the world's origin: positions there would not survive f32.
    let origin = DVec3::new(3e6, -5e5, 1e6);
    let image = traced(&shot(half_plane(edge), origin, rect(u, 0.3)), 256);
    assert_agrees(&image, |x, _| {
        overlap([projected(x, edge), f64::MAX], [-u, u]) / (2.0 * u)
    });
}

#[test]
fn square_plate_under_a_rectangle() {
    let (s, u, v) = (0.25, 0.8, 0.4);
    let mut scene = floor();
    plate(&mut scene, grey(), OCCLUDER, [-s; 2], [s; 2]);
    let image = traced(&shot(scene, DVec3::ZERO, rect(u, v)), 256);
    assert_agrees(&image, |x, z| {
        let covered =
            |p: f64, half: f64| overlap([projected(p, -s), projected(p, s)], [-half, half]);
        1.0 - covered(x, u) * covered(z, v) / (4.0 * u * v)
    });
}

#[test]
fn what_does_not_cast_hides_nothing() {
    let shot_of = |casts: [bool; 4]| {
        let mut scene = half_plane(0.125);
        scene.casts = casts.into();
        shot(scene, DVec3::ZERO, rect(0.7, 0.3))
    };
    let all = traced(&shot_of([true; 4]), 64);
    let plate = traced(&shot_of([false, false, true, true]), 64);
    let floor = traced(&shot_of([true, true, false, false]), 64);
    assert_eq!(all.visibility, plate.visibility);
    assert!(floor.visibility.data.iter().all(|&value| value == 1.0));
    assert!(all.visibility.data.contains(&0.0));
}

#[test]
fn half_plane_under_a_disc() {
    let (edge, radius) = (-0.0625, 0.75);
    let disc = LightShape::Disc {
        normal: -DVec3::Y * 3.0,
        radius,
    };
    let image = traced(&shot(half_plane(edge), DVec3::ZERO, disc), 256);
    assert_agrees(&image, |x, _| {
        let t = (projected(x, edge) / radius).clamp(-1.0, 1.0);
        (t.acos() - t * (1.0 - t * t).sqrt()) / PI
    });
}

#[test]
fn the_image_does_not_depend_on_the_number_of_threads() {
    let shot = shot(half_plane(0.0), DVec3::ZERO, rect(0.5, 0.5));
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| traced(&shot, 32))
    };
    let (one, three) = (with(1), with(3));
    assert_eq!(one.visibility, three.visibility);
    assert_eq!(one.standard_error, three.standard_error);
    let other = trace(
        &shot,
        0,
        ReferenceOptions {
            samples: 32,
            seed: 8,
        },
        &|_| {},
        &AtomicBool::new(false),
    );
    assert_ne!(other.unwrap().visibility, one.visibility);
}

#[test]
fn a_masked_texture_lets_light_and_view_through() {
    // Left half transparent, right half opaque, over a plate that spans x from −1 to 1.
    let rgba = [[255, 255, 255, 0], [255; 4]].concat();
    let texture = Texture {
        width: 2,
        height: 1,
        rgba,
        wrap: [Wrap::Clamp; 2],
        linear: false,
    };
    let leaf = Material {
        alpha_cutoff: Some(0.5),
        texture: Some(0),
        ..grey()
    };
    let mut scene = floor();
    scene.textures.push(texture.clone());
    plate(
        &mut scene,
        leaf.clone(),
        OCCLUDER,
        [-1.0, -100.0],
        [1.0, 100.0],
    );
    let u = 0.4;
    let image = traced(&shot(scene, DVec3::ZERO, rect(u, 0.4)), 256);
    assert_agrees(&image, |x, _| {
        1.0 - overlap([projected(x, 0.0), projected(x, 1.0)], [-u, u]) / (2.0 * u)
    });
    // The same between camera and floor: the opaque half hides the floor, showing its own lit side.
    let mut scene = floor();
    scene.textures.push(texture);
    plate(&mut scene, leaf, 0.4, [-4.0, -4.0], [4.0, 4.0]);
    let image = traced(&shot(scene, DVec3::ZERO, rect(0.0, 0.0)), 16);
    for (index, x, _) in floor_points() {
        // The ray to the floor at x crosses the leaf halfway from the camera.
        let behind_leaf = (x + EYE.x) / 2.0 > 0.0;
        let shaded = !behind_leaf && x * (LIGHT - 0.4) / LIGHT > 0.0;
        assert_eq!(
            image.visibility.data[index],
            if shaded { 0.0 } else { 1.0 },
            "{x}"
        );
    }
}

#[test]
fn backs_of_single_sided_surfaces_are_not_seen_but_cast_shadows() {
    // The camera is below the plate here: it looks up at its back.
    let look_up = |double_sided| {
        let mut scene = floor();
        plate(
            &mut scene,
            Material {
                double_sided,
                ..grey()
            },
            OCCLUDER,
            [-0.1; 2],
            [0.1; 2],
        );
        let mut shot = shot(scene, DVec3::ZERO, rect(0.1, 0.1));
        shot.camera.eye = DVec3::new(0.0, 0.5, 0.0);
        shot.camera.target = DVec3::new(0.0, 1.0, 0.0);
        traced(&shot, 16)
    };
    let middle = (SIZE.1 / 2 * SIZE.0 + SIZE.0 / 2) as usize;
    let back = look_up(false);
    assert!(back.visibility.data[middle].is_nan() && back.facing.data[middle].is_nan());
    let seen = look_up(true);
    assert_eq!(
        (seen.visibility.data[middle], seen.facing.data[middle]),
        (0.0, 0.0)
    );
    // What is not seen still shades: `square_plate_under_a_rectangle` is single-sided, lit on its front.
    let flipped = |scene: &mut Scene| scene.triangles[2..].iter_mut().for_each(|t| t.swap(0, 1));
    let mut scene = half_plane(0.0);
    flipped(&mut scene);
    let from_back = traced(&shot(scene, DVec3::ZERO, rect(0.4, 0.4)), 64);
    let from_front = traced(&shot(half_plane(0.0), DVec3::ZERO, rect(0.4, 0.4)), 64);
    assert_eq!(from_back.visibility, from_front.visibility);
}

#[test]
fn facing_is_the_share_of_the_light_in_front() {
    let above_floor = shot(floor(), DVec3::ZERO, rect(0.5, 0.5));
    assert!(
        traced(&above_floor, 16)
            .facing
            .data
            .iter()
            .all(|&f| f == 1.0)
    );
    // The light turned round shines away from the floor.
    let mut away = above_floor.clone();
    away.lights[0].shape = LightShape::Disc {
        normal: DVec3::Y,
        radius: 0.5,
    };
    let image = traced(&away, 16);
    assert!(
        image
            .visibility
            .data
            .iter()
            .chain(&image.facing.data)
            .all(|&v| v == 0.0)
    );
    // An upright light, centred in the floor's plane: half of it is below the horizon, and that
    // half does not count as occluded.
    let mut upright = above_floor;
    upright.lights[0].center = DVec3::new(-3.0, 0.0, 0.0);
    upright.lights[0].shape = LightShape::Disc {
        normal: DVec3::X,
        radius: 0.5,
    };
    let image = traced(&upright, 16);
    assert!(image.facing.data.iter().all(|&f| (f - 0.5).abs() < 1e-6));
    assert!(image.visibility.data.iter().all(|&v| v == 1.0));
}

#[test]
fn a_light_without_extent_casts_a_hard_shadow() {
    let image = traced(&shot(half_plane(0.11), DVec3::ZERO, rect(0.0, 0.0)), 16);
    for (index, x, _) in floor_points() {
        let expected = if projected(x, 0.11) < 0.0 { 1.0 } else { 0.0 };
        assert_eq!(image.visibility.data[index], expected, "{x}");
        assert_eq!(image.standard_error.data[index], 0.0);
    }
}

#[test]
fn what_cannot_be_traced_is_an_error() {
    let good = shot(floor(), DVec3::ZERO, rect(0.5, 0.5));
    let go = AtomicBool::new(false);
    let attempt = |shot: &Shot, light, samples| {
        let options = ReferenceOptions { samples, seed: 0 };
        trace(shot, light, options, &|_| {}, &go)
            .map(drop)
            .map_err(|error| error.to_string())
    };
    attempt(&good, 0, 16).unwrap();
    assert!(attempt(&good, 1, 16).unwrap_err().contains("no light 1"));
    assert!(attempt(&good, 0, 15).unwrap_err().contains("15 samples"));
    assert!(attempt(&good, 0, 65537).is_err());
    for spoil in [
        |shot: &mut Shot| shot.width = 0,
        |shot: &mut Shot| shot.camera.target = shot.camera.eye,
        |shot: &mut Shot| shot.camera.up = DVec3::Y,
        |shot: &mut Shot| shot.camera.vfov_deg = 180.0,
        |shot: &mut Shot| shot.camera.ortho_height = Some(0.0),
        |shot: &mut Shot| shot.lights[0].center.x = f64::NAN,
        |shot: &mut Shot| {
            shot.lights[0].shape = LightShape::Disc {
                normal: DVec3::ZERO,
                radius: 1.0,
            };
        },
    ] {
        let mut bad = good.clone();
        spoil(&mut bad);
        assert!(attempt(&bad, 0, 16).is_err());
    }
}

#[test]
fn cancelling_ends_the_work_with_an_error() {
    let shot = shot(half_plane(0.0), DVec3::ZERO, rect(0.5, 0.5));
    let cancel = AtomicBool::new(false);
    let progress = |share: f64| {
        assert!(share > 0.0 && share <= 1.0);
        cancel.store(true, Ordering::Relaxed);
    };
    let error = trace(&shot, 0, ReferenceOptions::default(), &progress, &cancel).unwrap_err();
    assert!(error.to_string().contains("interrupted"));
}
