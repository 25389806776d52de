//! The picture's unshadowed irradiance: the twin against the definition in f64, and the pass against the twin.

#[path = "../support/gpu.rs"]
mod support;

mod picture;
mod polygon;
mod truth;

use std::cell::Cell;
use std::f64::consts::PI;

use glam::{DQuat, DVec3, Vec2, Vec3};
use halfshade::shared::{
    ARCTANGENT, IRRADIANCE_NODES, Light, SPREAD_POINT, SPREAD_SPHERE, SPREAD_SUN,
};
use halfshade::twin::irradiance::irradiance;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use truth::Scene;

/// Of the twin, as its documentation states.
const BOUND: f64 = 1e-3;

fn light(turn: DQuat, half_size: [f64; 2], round: bool) -> Light {
    let array = |vector: DVec3| -> [f32; 3] { (turn * vector).as_vec3().into() };
    Light {
        u: array(DVec3::X),
        v: array(DVec3::Y),
        n: array(DVec3::Z),
        half_size: half_size.map(|half| half as f32),
        round: u32::from(round),
        area: if round { PI as f32 } else { 4.0 },
        ..Light::default()
    }
}

/// A light at the origin and a receiver before it.
#[derive(Debug)]
struct Case {
    light: Light,
    /// Of a polygon.
    corners: Vec<[f32; 2]>,
    position: Vec3,
    normal: Vec3,
}

impl Case {
    fn scene(&self) -> Scene {
        Scene::new(&self.light, &self.corners, self.position, self.normal)
    }

    fn irradiance(&self) -> f64 {
        let (position, normal) = (self.position, self.normal);
        f64::from(irradiance(&self.light, &self.corners, position, normal))
    }
}

/// A normal over whose horizon the light's highest point stands so high, tilted away from the light's centre towards
/// `aside`.
fn tilted(light: &Light, corners: &[[f32; 2]], position: Vec3, aside: DVec3, highest: f64) -> Vec3 {
    let towards = -position.as_dvec3().normalize();
    let perpendicular = aside.reject_from_normalized(towards).normalize();
    let at = |angle: f64| (towards * angle.cos() + perpendicular * angle.sin()).as_vec3();
    let (mut above, mut below) = (0.0, PI);
    for _ in 0..50 {
        let angle = 0.5 * (above + below);
        if Scene::new(light, corners, position, at(angle)).highest_cosine() > highest {
            above = angle;
        } else {
            below = angle;
        }
    }
    at(above)
}

/// Exponents of ten.
fn a_power(range: std::ops::Range<f64>) -> impl Strategy<Value = f64> {
    range.prop_map(|exponent| 10f64.powf(exponent))
}

prop_compose! {
    fn a_direction()(z in -1.0..1.0f64, angle in 0.0..2.0 * PI) -> DVec3 {
        let (sin, cos) = angle.sin_cos();
        DVec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
    }
}

prop_compose! {
    /// Half sizes from 1e-7 to 100 times the distance; receivers close to the light's plane and close to where they see
    /// nothing of it among them, in any unit.
    fn a_case()(
        axis in a_direction(), turn in 0.0..2.0 * PI, round: bool, size in a_power(-7.0..2.0),
        aspect in a_power(-2.0..0.0), swapped: bool,
        cosine in prop_oneof![a_power(-2.99..0.0), 0.0011..1.0], around in 0.0..2.0 * PI,
        highest in prop_oneof![a_power(-2.99..0.0), 0.0011..1.0], aside in a_direction(), unit in a_power(-8.0..8.0),
    ) -> Case {
        let turned = DQuat::from_axis_angle(axis, turn);
        let narrow = if round { size } else { size * aspect };
        let half = if swapped { [narrow, size] } else { [size, narrow] };
        let light = light(turned, half.map(|half| half * unit), round);
        let (sin, cos) = around.sin_cos();
        let sine = (1.0 - cosine * cosine).sqrt();
        let position = (turned * DVec3::new(sine * cos, sine * sin, cosine) * unit).as_vec3();
        let normal = tilted(&light, &[], position, aside, highest);
        Case { light, corners: Vec::new(), position, normal }
    }
}

/// Turns a case's surface; see [`tilted`].
fn tilt(case: &mut Case, aside: DVec3, highest: f64) {
    case.normal = tilted(&case.light, &case.corners, case.position, aside, highest);
}

/// The same cases in every run.
fn runner(cases: u32) -> TestRunner {
    let config = Config {
        cases,
        max_shrink_iters: 100,
        failure_persistence: None,
        ..Config::default()
    };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

/// The largest relative error of the twin over so many cases, each within the bound.
fn largest_error(cases: u32, strategy: impl Strategy<Value = Case>) -> f64 {
    let largest = Cell::new(0.0f64);
    let result = runner(cases).run(&strategy, |case| {
        let scene = case.scene();
        let wanted = scene.irradiance();
        let error = (case.irradiance() - wanted).abs() / wanted;
        prop_assert!(
            error <= BOUND,
            "{} where {wanted} is right: off by {error}",
            case.irradiance()
        );
        largest.set(largest.get().max(error));
        Ok(())
    });
    result.expect("within the bound");
    largest.get()
}

#[test]
fn any_light_from_any_receiver() {
    let largest = largest_error(10000, a_case());
    println!("largest relative error {largest:.1e}");
}

/// Receivers close to the light's plane, around its border, and planes that pass close to the foot.
#[test]
fn receivers_beside_the_border() {
    let beside = (a_case(), a_power(-2.99..-0.5), 0.9..1.1f64, a_direction());
    let beside = beside.prop_map(|(mut case, slope, outward, aside)| {
        let [u, v, n] = [case.light.u, case.light.v, case.light.n].map(Vec3::from);
        let offset = Vec2::from_angle(case.position.x / case.position.length() * 4.0)
            * Vec2::from(case.light.half_size)
            * outward as f32;
        case.position = u * offset.x + v * offset.y + n * (offset.length() * slope as f32);
        tilt(&mut case, aside, 0.3);
        case
    });
    let largest = largest_error(10000, beside);
    println!("largest relative error {largest:.1e}");
}

/// Smaller and smaller lights end where cos · cos / r² is all that is left, and a light without extent is there.
#[test]
fn the_limit_is_a_point() {
    let cases = (a_case(), a_power(-30.0..-3.0));
    let result = runner(500).run(&cases, |(mut case, size)| {
        let distance = case.position.length();
        case.light.half_size = [0.0; 2];
        tilt(&mut case, DVec3::new(0.3, 0.5, 0.8), 0.4);
        let point = case.irradiance();
        let to_light = -case.position.as_dvec3();
        let square = to_light.length_squared();
        let cosines = to_light.dot(case.normal.as_dvec3())
            * -to_light.dot(Vec3::from(case.light.n).as_dvec3());
        let wanted = cosines / (square * square);
        prop_assert!((point / wanted - 1.0).abs() < 1e-3, "{point} for {wanted}");
        case.light.half_size = [size as f32 * distance; 2];
        let small = case.irradiance();
        // Rounding, and what is of second order in the size, more of it where the cosine at the light is small.
        let allowed = 1e-5
            + 10.0 * size * size * square.sqrt()
                / -to_light.dot(Vec3::from(case.light.n).as_dvec3());
        prop_assert!(
            (small / point - 1.0).abs() < allowed,
            "{small} for {size}, {point} in the limit"
        );
        Ok(())
    });
    result.expect("one limit");
}

/// Above the horizon, irradiance is a cosine times that of a surface which faces the light.
#[test]
fn suns_and_spheres_shine_by_the_cosine() {
    let result = runner(200).run(&a_case(), |case| {
        let towards = -case.position.as_dvec3().normalize();
        let aside = DVec3::new(0.3, 0.5, 0.8).reject_from_normalized(towards);
        for (angle, radius) in [(0.0, 0.3), (0.6, 0.01), (1.0, 0.5), (0.9, 1e-6)] {
            let normal = towards * f64::cos(angle) + aside.normalize() * f64::sin(angle);
            let distance = case.position.as_dvec3().length();
            let sphere = Light {
                half_size: [(radius * distance) as f32; 2],
                spread: SPREAD_SPHERE,
                ..light(DQuat::IDENTITY, [0.0; 2], true)
            };
            let sun = Light {
                n: (-towards).as_vec3().into(),
                half_size: [radius as f32; 2],
                spread: SPREAD_SUN,
                ..light(DQuat::from_rotation_arc(DVec3::Z, -towards), [0.0; 2], true)
            };
            for (light, facing) in [
                (sphere, distance.powi(-2)),
                (sun, 1.0 / (1.0 + radius * radius)),
            ] {
                let found = f64::from(irradiance(&light, &[], case.position, normal.as_vec3()));
                let wanted = facing * angle.cos();
                prop_assert!(
                    (found - wanted).abs() <= BOUND * wanted,
                    "{found} for {wanted}: {angle}, {light:?}"
                );
            }
        }
        Ok(())
    });
    result.expect("a cosine");
}

/// A point without direction shines to all sides alike.
#[test]
fn a_point_without_direction_has_no_cosine_of_its_own() {
    let result = runner(200).run(&a_case(), |mut case| {
        case.light.half_size = [0.0; 2];
        case.light.spread = SPREAD_POINT;
        tilt(&mut case, DVec3::new(0.3, 0.5, 0.8), 0.4);
        for position in [case.position, -case.position] {
            let to_light = -position.as_dvec3();
            let wanted = to_light.dot(case.normal.as_dvec3()).max(0.0) / to_light.length().powi(3);
            let found = f64::from(irradiance(&case.light, &[], position, case.normal));
            prop_assert!(
                (found - wanted).abs() <= 1e-6 * wanted,
                "{found} for {wanted}"
            );
        }
        Ok(())
    });
    result.expect("the inverse square");
}

/// A coordinate, ordinary or extreme.
fn a_place() -> impl Strategy<Value = f32> {
    prop_oneof![
        Just(0.0),
        Just(1e-30),
        Just(1e-7),
        Just(1.0),
        Just(1e18),
        -1.0..1.0f32
    ]
}

/// A light's half size, ordinary or extreme.
fn a_size() -> impl Strategy<Value = f32> {
    prop_oneof![
        Just(0.0),
        Just(1e-40),
        Just(1e-18),
        Just(1e-5),
        Just(1.0),
        Just(1e18f32)
    ]
}

/// Nothing of any place or size is not a number, below zero or above a whole hemisphere of light.
#[test]
fn no_case_is_too_extreme() {
    let places = (a_place(), a_place(), a_place());
    let cases = (
        places,
        a_direction(),
        0..4u32,
        a_size(),
        a_size(),
        any::<bool>(),
    );
    let result = runner(20000).run(
        &cases,
        |((x, y, z), direction, axis, width, height, round)| {
            let mut light = light(DQuat::IDENTITY, [1.0; 2], round);
            light.half_size = [width, if round { width } else { height }];
            let along = [DVec3::X, DVec3::Y, DVec3::Z, direction];
            let normal = along[axis as usize].as_vec3();
            let found = irradiance(&light, &[], Vec3::new(x, y, z), normal);
            prop_assert!((0.0..f32::INFINITY).contains(&found), "{found}");
            let area = f64::from(light.half_size[0])
                * f64::from(light.half_size[1])
                * if round { PI } else { 4.0 };
            prop_assert!(f64::from(found) * area <= PI * (1.0 + BOUND), "{found}");
            Ok(())
        },
    );
    result.expect("finite");
}

/// What the definition in f64 is worth: closed forms of a disc on its axis, straight ahead and cut in halves by the
/// horizon, and of a rectangle.
#[test]
fn the_definition_has_the_closed_forms() {
    let at = |half: [f64; 2], round, normal: Vec3| {
        let light = light(DQuat::IDENTITY, half, round);
        Scene::new(&light, &[], Vec3::Z, normal)
    };
    for size in [1e-7, 1e-3, 0.5, 3.0, 100.0] {
        let size = f64::from(size as f32);
        let agrees = |scene: Scene, irradiance: f64| {
            let found = scene.irradiance() * scene.area();
            assert!(
                (found / irradiance - 1.0).abs() < 1e-6,
                "{found} for {irradiance}, size {size}"
            );
        };
        let square = 1.0 + size * size;
        agrees(at([size; 2], true, Vec3::NEG_Z), PI * size * size / square);
        // The two terms cancel for small discs.
        if size > 0.1 {
            agrees(at([size; 2], true, Vec3::X), size.atan() - size / square);
        }
        let quarter = size / square.sqrt() * (size / square.sqrt()).atan();
        agrees(at([size; 2], false, Vec3::NEG_Z), 4.0 * quarter);
    }
}

/// Legendre's polynomial of degree 16 and its derivative.
fn legendre(t: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, t);
    for degree in 2..=16 {
        let n = f64::from(degree);
        (before, value) = (
            value,
            ((2.0 * n - 1.0) * t * value - (n - 1.0) * before) / n,
        );
    }
    (value, 16.0 * (before - t * value) / (1.0 - t * t))
}

#[test]
fn the_nodes_are_those_of_gauss_and_legendre() {
    let kappa = 0.475 * PI;
    for [node, weight] in IRRADIANCE_NODES.map(|pair| pair.map(f64::from)) {
        let guess = (node * kappa.sin()).asin() / kappa;
        let (value, slope) = legendre(guess);
        let t = guess - value / slope;
        let slope = legendre(t).1;
        let plain = 2.0 / ((1.0 - t * t) * slope * slope);
        assert!(
            (node - (kappa * t).sin() / kappa.sin()).abs() < 1e-7,
            "{node}"
        );
        assert!(
            (weight - plain * kappa * (kappa * t).cos() / kappa.sin()).abs() < 1e-7,
            "{weight}"
        );
    }
    for s in (1..=100).map(|i| f64::from(i) / 100.0) {
        let wanted = (s - s.atan()) / s.powi(3);
        let terms = ARCTANGENT.iter().rev();
        let found = terms.fold(0.0, |sum, &coefficient| {
            sum * s * s + f64::from(coefficient)
        });
        assert!((found - wanted).abs() < 4.4e-6, "{found} for {wanted}");
    }
}
