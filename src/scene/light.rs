//! Geometry of area lights.

use std::f64::consts::PI;

use glam::DVec3;

use super::{AreaLight, LightShape, MAX_COORDINATE};
use crate::{Error, Result};

/// The largest |cos| between the half-axes of a rectangle.
const PERPENDICULAR_TOLERANCE: f64 = 1e-4;

/// [share of a light's size] Height over its plane up to which a surface is the lamp's own.
const TOUCH: f64 = 1e-7;

impl AreaLight {
    /// Unit vectors (u, v, normal) with normal = u × v the direction in which the light shines. A
    /// rectangle's u lies along its own; a disc's is arbitrary, but the same in every run. A point
    /// light without direction gets some frame.
    pub fn frame(&self) -> (DVec3, DVec3, DVec3) {
        let some_frame = |normal: DVec3| {
            let (u, v) = normal.any_orthonormal_pair();
            (u, v, normal)
        };
        match self.shape {
            LightShape::Rect { u, v } => match (u.try_normalize(), u.cross(v).try_normalize()) {
                (Some(u), Some(normal)) => (u, normal.cross(u), normal),
                _ => some_frame(DVec3::NEG_Y),
            },
            LightShape::Disc { normal, .. } => {
                some_frame(normal.try_normalize().unwrap_or(DVec3::NEG_Y))
            }
        }
    }

    /// [scene units] How far the light reaches from its centre along the u and v of [`Self::frame`].
    pub fn half_size(&self) -> (f64, f64) {
        match self.shape {
            LightShape::Rect { u, v } => (u.length(), v.length()),
            LightShape::Disc { radius, .. } => (radius, radius),
        }
    }

    /// Whether the light has no extent; its shadow is hard.
    pub fn is_point(&self) -> bool {
        self.half_size() == (0.0, 0.0)
    }

    /// [scene units] Surfaces no higher over the light's plane touch it, where coordinates are as large as `magnitude`
    /// \[scene units\]: 1e-7 of its size, or half a unit in the last place of such coordinates.
    pub fn touch(&self, magnitude: f64) -> f64 {
        let (u, v) = self.half_size();
        (TOUCH * 2.0 * u.max(v)).max(0.5 * f64::from(f32::EPSILON) * magnitude)
    }

    /// Whether the light is a point without direction, which shines to all sides alike. A disc of radius 0 with a
    /// normal has a direction: it is the limit of small discs, and shines by the cosine.
    pub fn is_point_without_direction(&self) -> bool {
        let directed = match self.shape {
            LightShape::Rect { .. } => false,
            LightShape::Disc { normal, .. } => normal.try_normalize().is_some(),
        };
        self.is_point() && !directed
    }

    /// The light as it shines to each side of a plane: itself, and turned round where it shines to all sides.
    pub fn sides(&self) -> Vec<Self> {
        let mut sides = vec![self.clone()];
        if self.is_point_without_direction() {
            sides.push(self.turned());
        }
        sides
    }

    /// A disc that shines to the other side.
    pub fn turned(&self) -> Self {
        let mut turned = self.clone();
        let (_, _, forward) = self.frame();
        if let LightShape::Disc { normal, .. } = &mut turned.shape {
            *normal = -forward;
        }
        turned
    }

    /// [scene units²]
    pub fn area(&self) -> f64 {
        let (u, v) = self.half_size();
        match self.shape {
            LightShape::Rect { .. } => 4.0 * u * v,
            LightShape::Disc { .. } => PI * u * v,
        }
    }

    /// # Errors
    /// [`Error::Invalid`] when the light cannot be rendered: a number is not finite or beyond 10¹⁸, the
    /// half-axes of a rectangle are not perpendicular or only one is zero, a radius is negative, a disc
    /// with extent has no normal, or the colour or intensity is negative.
    pub fn validate(&self) -> Result<()> {
        self.fault().map_or(Ok(()), |fault| {
            let name: String = self.name.chars().take(60).collect();
            Err(Error::Invalid(match name.as_str() {
                "" => format!("the light: {fault}"),
                name => format!("light {name:?}: {fault}"),
            }))
        })
    }

    fn fault(&self) -> Option<&'static str> {
        // Written so that NaN fails them.
        let sane = |v: DVec3| v.is_finite() && v.abs().max_element() <= MAX_COORDINATE;
        if !sane(self.center) {
            return Some("its center is not finite or beyond 1e18");
        }
        if !(self.color.is_finite() && self.color.min_element() >= 0.0) {
            return Some("its color must be finite and not negative");
        }
        if !self.intensity.is_none_or(|i| i.is_finite() && i >= 0.0) {
            return Some("its intensity must be finite and not negative");
        }
        match self.shape {
            LightShape::Rect { u, v } if !sane(u) || !sane(v) => {
                Some("its u or v is not finite or beyond 1e18")
            }
            LightShape::Rect { u, v } => {
                let (u_length, v_length) = (u.length(), v.length());
                if (u_length == 0.0) != (v_length == 0.0) {
                    Some(
                        "one of u and v is zero, which makes it a line; give both an extent, or none",
                    )
                } else if u.dot(v).abs() > PERPENDICULAR_TOLERANCE * u_length * v_length {
                    Some("its u and v are not perpendicular")
                } else {
                    None
                }
            }
            LightShape::Disc { normal, radius } => {
                if !(0.0..=MAX_COORDINATE).contains(&radius) {
                    Some("its radius must be from 0 to 1e18")
                } else if !sane(normal) {
                    Some("its normal is not finite or beyond 1e18")
                } else if radius > 0.0 && normal.try_normalize().is_none() {
                    Some("its normal has no length")
                } else {
                    None
                }
            }
        }
    }
}
