//! Polygons: the twin against the definition in f64.

use std::cell::Cell;

use super::*;

/// Of E \[0, π\], beside `BOUND` of it, where the light is wide; as the twin's shader states it.
const WIDE: f64 = 1e-6;

/// [half sizes] Corners of a convex polygon in the square from −1 to 1: on an ellipse, at any angles.
fn some_corners() -> impl Strategy<Value = Vec<[f32; 2]>> {
    let angles = proptest::collection::vec(0.02..1.0f64, 3..=16);
    (angles, 0.0..PI, a_power(-2.0..0.0)).prop_map(|(steps, turn, width)| {
        let sum: f64 = steps.iter().sum();
        let mut angle = turn;
        let mut corners = Vec::new();
        for step in &steps {
            angle += step / sum * 2.0 * PI;
            corners.push(Vec2::new(angle.cos() as f32, angle.sin() as f32));
        }
        let (lower, upper) = (corners.iter())
            .fold((Vec2::MAX, Vec2::MIN), |(lower, upper), &corner| {
                (lower.min(corner), upper.max(corner))
            });
        // Sheared, so that sides are steep.
        let shear = |at: Vec2| Vec2::new(at.x, at.y * width as f32 + at.x * (1.0 - width as f32));
        let flat = |corner: &Vec2| shear(2.0 * (*corner - lower) / (upper - lower) - 1.0).into();
        corners.iter().map(flat).collect()
    })
}

prop_compose! {
    fn a_polygon()(mut case in a_case(), corners in some_corners(), aside in a_direction(),
        highest in prop_oneof![a_power(-2.99..0.0), 0.0011..1.0]) -> Case {
        case.light.round = 0;
        case.light.corner_count = corners.len() as u32;
        let sides = corners.iter().zip(corners.iter().cycle().skip(1));
        let doubled: f32 = sides.map(|(p, q)| Vec2::from(*p).perp_dot(Vec2::from(*q))).sum();
        case.light.area = 0.5 * doubled;
        case.normal = tilted(&case.light, &corners, case.position, aside, highest);
        Case { corners, ..case }
    }
}

/// The largest errors of the twin, each within the bound: as a share where the light is small, and what wide ones have beside the share.
fn largest_errors(cases: u32, strategy: impl Strategy<Value = Case>) -> [f64; 2] {
    let largest = Cell::new([0.0f64; 2]);
    let result = runner(cases).run(&strategy, |case| {
        let scene = case.scene();
        let wanted = scene.irradiance();
        let found = case.irradiance();
        let half = Vec2::from(case.light.half_size);
        let wide = half.x + half.y >= 0.25 * case.position.length();
        // Of the mean over the area, what is 1 of E.
        let unit = 1.0 / scene.area();
        let (error, allowed) = ((found - wanted).abs(), if wide { WIDE * unit } else { 0.0 });
        prop_assert!(
            error <= BOUND * wanted + allowed,
            "{found} where {wanted} is right, wide: {wide}: off by {} and {} of π",
            error / wanted,
            (error - BOUND * wanted) / unit
        );
        let [mut small_error, mut wide_error] = largest.get();
        match wide {
            true => wide_error = wide_error.max((error - BOUND * wanted) / unit),
            false => small_error = small_error.max(error / wanted),
        }
        largest.set([small_error, wide_error]);
        Ok(())
    });
    result.expect("within the bound");
    largest.get()
}

#[test]
fn any_polygon_from_any_receiver() {
    let [small, wide] = largest_errors(10000, a_polygon());
    println!(
        "largest relative error of small ones {small:.1e}, of wide ones beside {BOUND} of E {wide:.1e}"
    );
}

/// A rectangle of four corners is a rectangle: both are within their bounds of the truth.
#[test]
fn four_corners_are_a_rectangle() {
    let result = runner(2000).run(&a_case(), |mut case| {
        case.light.round = 0;
        case.light.area = 4.0;
        case.normal = tilted(
            &case.light,
            &[],
            case.position,
            DVec3::new(0.3, 0.5, 0.8),
            0.2,
        );
        let rectangle = case.irradiance();
        case.corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].into();
        case.light.corner_count = 4;
        let (polygon, unit) = (case.irradiance(), 1.0 / case.scene().area());
        prop_assert!(
            (polygon - rectangle).abs() <= 2.0 * BOUND * rectangle + WIDE * unit,
            "{polygon} for {rectangle}"
        );
        Ok(())
    });
    result.expect("a rectangle");
}

/// Nothing of any place or size is not a number, below zero or above a whole hemisphere of light.
#[test]
fn no_polygon_is_too_extreme() {
    let cases = (
        a_polygon(),
        [a_place(), a_place(), a_place()],
        [a_size(), a_size()],
        a_direction(),
        0..4usize,
    );
    let result = runner(20000).run(&cases, |(mut case, place, half, direction, axis)| {
        (case.light.u, case.light.v, case.light.n) =
            (Vec3::X.into(), Vec3::Y.into(), Vec3::Z.into());
        (case.light.half_size, case.position) = (half, place.into());
        case.normal = [DVec3::X, DVec3::Y, DVec3::Z, direction][axis].as_vec3();
        let found = case.irradiance();
        prop_assert!((0.0..f64::INFINITY).contains(&found), "{found}");
        let all = f64::from(case.light.area) * f64::from(half[0]) * f64::from(half[1]) * found;
        prop_assert!(all <= PI * (1.0 + BOUND), "{found}");
        Ok(())
    });
    result.expect("finite");
}
