//! A sun: light from a disc of directions.
//!
//! With heights h over a plane beyond the scene, perpendicular to the light's direction n, and x the place where the light's ray
//! through a point meets that plane, (L x / h, L² / h) is a projective map: it keeps lines, and takes the sun to a disc around
//! the origin in the plane L² / h = 0 whose radius is L times the tangent of the sun's angular radius. What holds for discs holds
//! for the sun there.

use glam::DVec3;

use super::{Form, Outline, Spread, is_sane, some_frame};

/// [degree] The sun's angular diameter, seen from the earth.
pub const ANGLE_DEG: f64 = 0.533;

/// [radius of the scene] How far the plane is from the scene's middle: all heights are between 1 and 3 then.
const PLANE: f64 = 2.0;

pub fn form(direction: DVec3, angle_deg: f64) -> Form {
    let tangent = (0.5 * angle_deg).to_radians().tan();
    Form {
        frame: some_frame(direction.try_normalize().unwrap_or(DVec3::NEG_Y)),
        half_size: (tangent, tangent),
        outline: Outline::Disc,
        spread: Spread::Sun,
    }
}

pub fn fault(direction: DVec3, angle_deg: f64) -> Option<&'static str> {
    if !is_sane(direction) || direction.try_normalize().is_none() {
        Some("its direction is not finite, beyond 1e18, or has no length")
    } else if !(0.0..180.0).contains(&angle_deg) {
        Some("its angle must be from 0 to less than 180 degrees")
    } else {
        None
    }
}

/// A ball around a scene, which says where the plane is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// [scene units, world]
    pub center: DVec3,
    /// [scene units] More than 0.
    pub radius: f64,
}

impl Ball {
    /// Of a bounding box.
    pub fn around((lower, upper): (DVec3, DVec3)) -> Self {
        let radius = 0.5 * (upper - lower).length();
        Self {
            center: 0.5 * (lower + upper),
            radius: if radius > 0.0 { radius } else { 1.0 },
        }
    }

    /// [scene units, world] A point of the plane of light along `normal`.
    pub fn on_plane(&self, normal: DVec3) -> DVec3 {
        self.center + normal * self.length()
    }

    /// [scene units] L.
    pub fn length(&self) -> f64 {
        PLANE * self.radius
    }
}

/// The map, from the ways from a point of the plane; `length`: L.
pub fn mapped(way: DVec3, normal: DVec3, length: f64) -> DVec3 {
    let height = -normal.dot(way);
    (way + normal * (height + length)) * (length / height)
}
