//! Geometry of area lights: what all shapes have in common. A shape's own file says the rest.

mod beam;
mod disc;
mod outline;
mod polygon;
mod rect;
mod sphere;
mod sun;

use glam::DVec3;

pub use beam::Beam;
pub use outline::{Corners, Outline, polygon_area};
pub use sphere::Cone;
pub use sun::{ANGLE_DEG as SUN_ANGLE_DEG, Ball, mapped};

use super::{AreaLight, LightShape, MAX_COORDINATE};
use crate::shared::{SPREAD_PLANE, SPREAD_POINT, SPREAD_SPHERE, SPREAD_SUN};
use crate::{Error, Result};

/// [share of a light's size] Height over its plane up to which a surface is the lamp's own.
const TOUCH: f64 = 1e-7;

/// A shape, as whatever works with lights sees it: what an outline leaves of a rectangle in a plane.
#[derive(Debug, Clone, Copy)]
struct Form {
    /// See [`AreaLight::frame`].
    frame: (DVec3, DVec3, DVec3),
    /// See [`AreaLight::half_size`].
    half_size: (f64, f64),
    outline: Outline,
    spread: Spread,
}

/// Where a light shines from and to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Spread {
    /// From its plane to one side.
    Plane = SPREAD_PLANE,
    /// From a point to all sides alike.
    Point = SPREAD_POINT,
    /// From infinity; its disc is that of directions.
    Sun = SPREAD_SUN,
    /// To all sides; each receiver sees a disc that faces it.
    Sphere = SPREAD_SPHERE,
}

/// A light as some of its receivers see it: a flat one with maps of its own.
#[derive(Debug, Clone)]
pub struct Side {
    pub light: AreaLight,
    /// [scene units] Not 0: the light is where the sun's map has taken it, with this L (see `sun.rs`); its centre is a point of the
    /// plane.
    pub parallel: f64,
    /// Its receivers are those in this cone, seen from the light's centre.
    pub cone: Option<u32>,
}

impl From<AreaLight> for Side {
    fn from(light: AreaLight) -> Self {
        Self {
            light,
            parallel: 0.0,
            cone: None,
        }
    }
}

fn some_frame(normal: DVec3) -> (DVec3, DVec3, DVec3) {
    let (u, v) = normal.any_orthonormal_pair();
    (u, v, normal)
}

// Written so that NaN fails it.
fn is_sane(v: DVec3) -> bool {
    v.is_finite() && v.abs().max_element() <= MAX_COORDINATE
}

fn radius_fault(radius: f64) -> Option<&'static str> {
    let sane = (0.0..=MAX_COORDINATE).contains(&radius);
    (!sane).then_some("its radius must be from 0 to 1e18")
}

impl LightShape {
    /// The centre and the shape of a light that is a convex polygon of 3 to 16 corners \[scene units, world\]. It shines to the side from
    /// which they run counter-clockwise.
    ///
    /// # Errors
    /// [`Error::Invalid`] when they are too few or too many, not finite, the same, on a line, not in a plane, or not convex.
    pub fn polygon(corners: &[DVec3]) -> Result<(DVec3, Self)> {
        polygon::around(corners).map_err(Error::Invalid)
    }
}

impl AreaLight {
    fn form(&self) -> Form {
        match self.shape {
            LightShape::Rect { u, v } => rect::form(u, v),
            LightShape::Disc { normal, radius } => disc::form(normal, radius),
            LightShape::Polygon { u, v, corners } => polygon::form(u, v, corners),
            LightShape::Sphere { radius } => sphere::form(radius),
            LightShape::Sun {
                direction,
                angle_deg,
            } => sun::form(direction, angle_deg),
        }
    }

    fn fault_of_shape(&self) -> Option<&'static str> {
        match self.shape {
            LightShape::Rect { u, v } | LightShape::Polygon { u, v, .. } => rect::fault(u, v),
            LightShape::Disc { normal, radius } => disc::fault(normal, radius),
            LightShape::Sphere { radius } => sphere::fault(radius),
            LightShape::Sun {
                direction,
                angle_deg,
            } => sun::fault(direction, angle_deg),
        }
    }

    /// Unit vectors (u, v, normal) with normal = u × v the direction in which the light shines. A
    /// rectangle's u lies along its own, a polygon's along one of its sides; a disc's is arbitrary, but the same in every run. A light
    /// without direction gets some frame.
    pub fn frame(&self) -> (DVec3, DVec3, DVec3) {
        self.form().frame
    }

    /// [scene units] How far the light reaches from its centre along the u and v of [`Self::frame`]; of a sun the tangent of its
    /// angular radius.
    pub fn half_size(&self) -> (f64, f64) {
        self.form().half_size
    }

    /// What bounds it within its half sizes; of a sphere, what it is seen as.
    pub fn outline(&self) -> Outline {
        self.form().outline
    }

    pub fn spread(&self) -> Spread {
        self.form().spread
    }

    /// Whether the light has no extent; its shadow is hard.
    pub fn is_point(&self) -> bool {
        self.half_size() == (0.0, 0.0)
    }

    /// [scene units] 0 for a sun. Surfaces no higher over the light's plane touch it, where coordinates are as large as `magnitude`
    /// \[scene units\]: 1e-7 of its size, or half a unit in the last place of such coordinates.
    pub fn touch(&self, magnitude: f64) -> f64 {
        if self.spread() == Spread::Sun {
            return 0.0;
        }
        let (u, v) = self.half_size();
        (TOUCH * 2.0 * u.max(v)).max(0.5 * f64::from(f32::EPSILON) * magnitude)
    }

    /// Whether the light is a point without direction, which shines to all sides alike. A disc of radius 0 with a
    /// normal has a direction: it is the limit of small discs, and shines by the cosine.
    pub fn is_point_without_direction(&self) -> bool {
        self.spread() == Spread::Point
    }

    /// Of how many flat lights the maps are.
    pub fn side_count(&self) -> usize {
        match self.spread() {
            Spread::Plane | Spread::Sun => 1,
            Spread::Point => 2,
            Spread::Sphere => Cone::COUNT,
        }
    }

    /// The flat light that is seen from a side. `ball`: around the scene; only suns ask for it.
    pub fn side(&self, index: usize, ball: &Ball) -> Side {
        let (_, _, normal) = self.frame();
        let (radius, _) = self.half_size();
        match self.spread() {
            Spread::Plane => self.flat(self.shape).into(),
            Spread::Point => self.disc([normal, -normal][index.min(1)], radius).into(),
            Spread::Sphere => Side {
                cone: Some(index as u32),
                ..self.disc(Cone::new(index).middle(), radius).into()
            },
            Spread::Sun => {
                let mut light = self.disc(normal, radius * ball.length());
                light.center = ball.on_plane(normal);
                Side {
                    parallel: ball.length(),
                    ..light.into()
                }
            }
        }
    }

    pub fn sides(&self, ball: &Ball) -> Vec<Side> {
        (0..self.side_count())
            .map(|index| self.side(index, ball))
            .collect()
    }

    fn disc(&self, normal: DVec3, radius: f64) -> Self {
        self.flat(LightShape::Disc { normal, radius })
    }

    /// Does not allocate.
    fn flat(&self, shape: LightShape) -> Self {
        Self {
            name: String::new(),
            shape,
            ..*self
        }
    }

    /// [scene units²]
    pub fn area(&self) -> f64 {
        let (u, v) = self.half_size();
        self.outline().area() * u * v
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
        if !is_sane(self.center) {
            return Some("its center is not finite or beyond 1e18");
        }
        if !(self.color.is_finite() && self.color.min_element() >= 0.0) {
            return Some("its color must be finite and not negative");
        }
        if !self.intensity.is_none_or(|i| i.is_finite() && i >= 0.0) {
            return Some("its intensity must be finite and not negative");
        }
        self.fault_of_shape().or_else(|| self.fault_of_beam())
    }

    fn fault_of_beam(&self) -> Option<&'static str> {
        let beam = self.beam.as_ref()?;
        match self.shape {
            LightShape::Disc { .. } | LightShape::Sphere { .. } => beam.fault(),
            _ => Some("a cone is for discs and spheres"),
        }
    }
}
