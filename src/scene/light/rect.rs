//! A rectangle.

use glam::DVec3;

use super::{Form, Outline, Spread, is_sane, some_frame};

/// The largest |cos| between the half-axes.
const PERPENDICULAR_TOLERANCE: f64 = 1e-4;

pub fn form(u: DVec3, v: DVec3) -> Form {
    let frame = match (u.try_normalize(), u.cross(v).try_normalize()) {
        (Some(u), Some(normal)) => (u, normal.cross(u), normal),
        _ => some_frame(DVec3::NEG_Y),
    };
    Form {
        frame,
        half_size: (u.length(), v.length()),
        outline: Outline::Square,
        spread: match (u, v) {
            (DVec3::ZERO, DVec3::ZERO) => Spread::Point,
            _ => Spread::Plane,
        },
    }
}

pub fn fault(u: DVec3, v: DVec3) -> Option<&'static str> {
    if !is_sane(u) || !is_sane(v) {
        return Some("its u or v is not finite or beyond 1e18");
    }
    let (u_length, v_length) = (u.length(), v.length());
    if (u_length == 0.0) != (v_length == 0.0) {
        return Some("one of u and v is zero, which makes it a line; give both an extent, or none");
    }
    let skewed = u.dot(v).abs() > PERPENDICULAR_TOLERANCE * u_length * v_length;
    skewed.then_some("its u and v are not perpendicular")
}
