//! A disc, or a point.

use glam::DVec3;

use super::{Form, Outline, Spread, is_sane, radius_fault, some_frame};

pub fn form(normal: DVec3, radius: f64) -> Form {
    let direction = normal.try_normalize();
    Form {
        frame: some_frame(direction.unwrap_or(DVec3::NEG_Y)),
        half_size: (radius, radius),
        outline: Outline::Disc,
        spread: match direction {
            None if radius == 0.0 => Spread::Point,
            _ => Spread::Plane,
        },
    }
}

pub fn fault(normal: DVec3, radius: f64) -> Option<&'static str> {
    if let Some(fault) = radius_fault(radius) {
        Some(fault)
    } else if !is_sane(normal) {
        Some("its normal is not finite or beyond 1e18")
    } else if radius > 0.0 && normal.try_normalize().is_none() {
        Some("its normal has no length")
    } else {
        None
    }
}
