//! Ray-traced truth against closed forms, judged by statistics: the deviations must look like noise
//! of the size that the image itself states, not merely be small.
#![cfg(feature = "cli")]

use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::{DVec3, Vec2, Vec3, Vec4};
use halfshade::cpu::reference::{ReferenceImage, ReferenceOptions, trace};
use halfshade::scene::{AreaLight, Camera, LightShape, Material, Scene, Texture, Wrap};
use halfshade::shot::{Leaf, Mapping, Settings, Shot, Technique};

/// [scene units] Heights above the floor: of the occluder and of the light.
const OCCLUDER: f64 = 1.0;
const LIGHT: f64 = 2.0;
/// [scene units] Where the camera looks straight down from, below the occluder.
const EYE: DVec3 = DVec3::new(0.1, 0.8, 0.05);
const SIZE: (u32, u32) = (56, 40);
const VFOV_DEG: f64 = 90.0;

/// A rectangle parallel to the floor: two triangles seen from above, `low` and `high` its corners.
fn plate(scene: &mut Scene, material: Material, height: f64, low: [f64; 2], high: [f64; 2]) {
    let first = scene.positions.len() as u32;
    for (x, z, uv) in [
        (low[0], low[1], Vec2::ZERO),
        (high[0], low[1], Vec2::X),
        (low[0], high[1], Vec2::Y),
        (high[0], high[1], Vec2::ONE),
    ] {
        scene
            .positions
            .push(Vec3::new(x as f32, height as f32, z as f32));
        scene.texcoords.push(uv);
    }
    let masked = material.alpha_cutoff.is_some();
    for triangle in [[0, 2, 1], [1, 2, 3]] {
        scene.triangles.push(triangle.map(|i: u32| first + i));
        scene.triangle_materials.push(scene.materials.len() as u32);
        scene.opaque_count += usize::from(!masked);
    }
    scene.materials.push(material);
}

fn grey() -> Material {
    Material {
        name: String::new(),
        base_color: Vec4::ONE,
        texture: None,
        alpha_cutoff: None,
        double_sided: false,
    }
}

fn floor() -> Scene {
    let mut scene = Scene::default();
    plate(&mut scene, grey(), 0.0, [-10.0; 2], [10.0; 2]);
    scene
}

/// Parallel to the floor, shining down.
fn rect(u: f64, v: f64) -> LightShape {
    LightShape::Rect {
        u: DVec3::X * u,
        v: DVec3::Z * v,
    }
}

/// The scene moved to `origin` with a light above its middle and the camera under the occluder.
fn shot(mut scene: Scene, origin: DVec3, shape: LightShape) -> Shot {
    scene.origin = origin;
    let light = AreaLight {
        name: String::new(),
        center: origin + DVec3::Y * LIGHT,
        shape,
        color: Vec3::ONE,
        intensity: None,
    };
    let camera = Camera {
        name: String::new(),
        eye: origin + EYE,
        target: origin + EYE - DVec3::Y,
        up: -DVec3::Z,
        vfov_deg: VFOV_DEG,
        aspect: None,
    };
    let settings = Settings {
        technique: Technique::PacketContour,
        packet: (4, 4),
        leaf: Leaf::PerPixel,
        mapping: Mapping::Serial,
        split: 1,
        map: 512,
        footprint_pruning: true,
        hierarchical: true,
        bias: 1.5,
        counters: false,
    };
    let (width, height) = SIZE;
    let (scene, lights, notes) = (Arc::new(scene), vec![light], vec![]);
    Shot {
        scene,
        camera,
        width,
        height,
        lights,
        settings,
        notes,
    }
}

fn traced(shot: &Shot, samples: u32) -> ReferenceImage {
    let options = ReferenceOptions { samples, seed: 7 };
    trace(shot, 0, options, &|_| {}, &AtomicBool::new(false)).unwrap()
}

/// Every pixel's index and the floor point (x, z) in its centre.
fn floor_points() -> impl Iterator<Item = (usize, f64, f64)> {
    let (width, height) = (SIZE.0 as usize, SIZE.1 as usize);
    let reach = EYE.y * (VFOV_DEG.to_radians() / 2.0).tan();
    (0..width * height).map(move |index| {
        let along = |i: usize, n: usize| (i as f64 + 0.5) / n as f64 * 2.0 - 1.0;
        let aspect = width as f64 / height as f64;
        let x = EYE.x + along(index % width, width) * reach * aspect;
        (index, x, EYE.z + along(index / width, height) * reach)
    })
}

/// How the traced image deviates from a closed form, in standard deviations.
struct Deviation {
    /// Of the sum of all errors: is the image biased?
    bias: f64,
    /// Of the sum of (error² − stated variance): is the stated standard error right?
    spread: f64,
    penumbra: usize,
}

fn deviation(image: &ReferenceImage, truth: impl Fn(f64, f64) -> f64) -> Deviation {
    let (mut sum, mut variance, mut excess, mut excess_squares, mut penumbra) =
        (0.0, 0.0, 0.0, 0.0, 0);
    for (index, x, z) in floor_points() {
        let expected = truth(x, z);
        let value = f64::from(image.visibility.data[index]);
        let stated = f64::from(image.standard_error.data[index]).powi(2);
        let error = value - expected;
        // Umbra and light need no statistics (within rounding of the closed form at their borders).
        if !(1e-6..=1.0 - 1e-6).contains(&expected) {
            assert!(
                error.abs() < 1e-6 && stated == 0.0,
                "{value} is not {expected} at ({x}, {z})"
            );
            continue;
        }
        penumbra += 1;
        sum += error;
        variance += stated;
        excess += error * error - stated;
        excess_squares += (error * error - stated).powi(2);
    }
    Deviation {
        bias: sum / variance.sqrt(),
        spread: excess / excess_squares.sqrt(),
        penumbra,
    }
}

#[track_caller]
fn assert_agrees(image: &ReferenceImage, truth: impl Fn(f64, f64) -> f64) {
    let found = deviation(image, &truth);
    assert!(
        found.penumbra > 400,
        "only {} pixels are in penumbra",
        found.penumbra
    );
    assert!(
        found.bias.abs() < 4.0,
        "biased by {:.1} standard deviations",
        found.bias
    );
    assert!(
        found.spread.abs() < 4.0,
        "the stated error is off by {:.1} standard deviations",
        found.spread
    );
    // The test has teeth: it would notice a light that is wrong by half a per cent.
    let wrong = |x: f64, z: f64| match truth(x, z) {
        v if (1e-6..=1.0 - 1e-6).contains(&v) => (v + 0.005).min(1.0 - 2e-6),
        v => v,
    };
    assert!(deviation(image, wrong).bias.abs() > 10.0);
}

/// Where the line from the floor at `x` through an occluder's edge at `edge` meets the light's plane.
fn projected(x: f64, edge: f64) -> f64 {
    x + (edge - x) * LIGHT / OCCLUDER
}

/// The length that two intervals share.
fn overlap(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[1].min(b[1]) - a[0].max(b[0])).max(0.0)
}

/// An occluder that covers all x below `edge`, as far as any ray of these tests can tell.
fn half_plane(edge: f64) -> Scene {
    let mut scene = floor();
    plate(
        &mut scene,
        grey(),
        OCCLUDER,
        [-100.0, -100.0],
        [edge, 100.0],
    );
    scene
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
