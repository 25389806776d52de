//! The plain stage, and what a case may change about it.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use crate::scene::{AreaLight, Camera, LightShape, Scene, Shape};
use crate::shot::Shot;
use crate::technique::{Settings, Technique};

/// [pixel] Width and height of an image, unless its size is the case.
const SIDE: u32 = 48;
/// [texel] Width and height of a map, unless its size is the case.
pub(super) const MAP: u32 = 128;

/// A shot with something extreme about it.
#[derive(Debug, Clone)]
pub struct Case {
    /// What is extreme.
    pub family: &'static str,
    pub name: String,
    pub shot: Shot,
    /// What the case wants changed in a technique's settings.
    changes: Changes,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Changes {
    pub map: u32,
    pub split: Option<u32>,
    pub packet: Option<(u32, u32)>,
}

impl Case {
    /// The shot with these settings as far as the case does not say otherwise.
    pub fn with(&self, settings: &Settings) -> Shot {
        let Changes { map, split, packet } = self.changes;
        let splits = settings.technique != Technique::ReferenceMaps;
        Shot {
            settings: Settings {
                map,
                split: split.filter(|_| splits).unwrap_or(settings.split),
                packet: packet.unwrap_or(settings.packet),
                ..settings.clone()
            },
            ..self.shot.clone()
        }
    }
}

/// What the light is. `light_half` says its half width, radius or half sizes; a sun has an angle instead.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    Rect,
    Disc,
    /// The half of the rectangle on one side of its diagonal.
    Triangle,
    Sphere,
    Sun {
        angle_deg: f64,
    },
}

/// A plate between the ground and a square light, and what a case changes about it. Lengths in [scene units] before `scale`.
#[derive(Debug, Clone)]
pub(super) struct Stage {
    pub scale: f64,
    pub offset: DVec3,
    pub light_height: f64,
    pub light_half: (f64, f64),
    /// The light is tilted by so many degrees about z.
    pub light_tilt: f64,
    pub light_shape: Kind,
    /// Height of the plate's middle, and what it is turned by about y and tilted by about z, in degrees.
    pub plate_height: f64,
    pub plate_half: f64,
    pub plate_turn: f64,
    pub plate_tilt: f64,
    pub plate_aside: f64,
    pub ground: bool,
    pub more: Shape,
    pub eye: DVec3,
    pub target: DVec3,
    pub size: (u32, u32),
    pub changes: Changes,
}

impl Default for Stage {
    fn default() -> Self {
        Self {
            scale: 1.0,
            offset: DVec3::ZERO,
            light_height: 2.0,
            light_half: (0.5, 0.5),
            light_tilt: 0.0,
            light_shape: Kind::Rect,
            plate_height: 1.0,
            plate_half: 0.4,
            plate_turn: 17.0,
            plate_tilt: 0.0,
            plate_aside: 0.0,
            ground: true,
            more: Shape::default(),
            eye: DVec3::new(0.3, 2.6, 4.2),
            target: DVec3::new(0.0, 0.3, 0.0),
            size: (SIDE, SIDE),
            changes: Changes {
                map: MAP,
                split: None,
                packet: None,
            },
        }
    }
}

impl Stage {
    pub fn case(self, family: &'static str, name: impl Into<String>) -> Case {
        let place = |point: DVec3| point * self.scale + self.offset;
        let mut plate = Shape::square(self.plate_half);
        for point in &mut plate.positions {
            let turned = rotated(*point, DVec3::Y, self.plate_turn);
            *point = rotated(turned, DVec3::Z, self.plate_tilt)
                + DVec3::new(self.plate_aside, self.plate_height, 0.0);
        }
        let ground = match self.ground {
            true => Shape::square(4.0),
            false => Shape::default(),
        };
        let colors = [
            Vec3::splat(0.8),
            Vec3::new(0.7, 0.4, 0.3),
            Vec3::new(0.3, 0.5, 0.7),
        ];
        let mut parts: Vec<(Shape, Vec3)> = [ground, plate, self.more.clone()]
            .into_iter()
            .zip(colors)
            .collect();
        parts.retain(|(shape, _)| !shape.triangles.is_empty());
        for point in parts.iter_mut().flat_map(|(shape, _)| &mut shape.positions) {
            *point = place(*point);
        }
        let (center, shape) = self.light(place(DVec3::Y * self.light_height));
        let light = AreaLight {
            name: String::new(),
            center,
            shape,
            color: Vec3::ONE,
            intensity: None,
            beam: None,
        };
        let camera = Camera {
            name: String::new(),
            eye: place(self.eye),
            target: place(self.target),
            up: DVec3::Y,
            vfov_deg: 40.0,
            aspect: None,
            ortho_height: None,
            near: None,
        };
        Case {
            family,
            name: name.into(),
            shot: Shot {
                scene: Arc::new(Scene::of_shapes(&parts)),
                camera,
                width: self.size.0,
                height: self.size.1,
                lights: vec![light],
                settings: Settings::default(),
                budget_map: None,
                physical: false,
                notes: Vec::new(),
            },
            changes: self.changes,
        }
    }

    /// Where it is and what, around a place.
    fn light(&self, place: DVec3) -> (DVec3, LightShape) {
        let tilted = |axis: DVec3| rotated(axis, DVec3::Z, self.light_tilt);
        let (half_u, half_v) = (
            self.light_half.0 * self.scale,
            self.light_half.1 * self.scale,
        );
        let shape = match self.light_shape {
            Kind::Triangle => {
                let (u, v) = (tilted(DVec3::X) * half_u, tilted(DVec3::Z) * half_v);
                let corners = [-u - v, u - v, v - u].map(|corner| place + corner);
                return LightShape::polygon(&corners)
                    .unwrap_or((place, LightShape::Sphere { radius: 0.0 }));
            }
            Kind::Rect => LightShape::Rect {
                u: tilted(DVec3::X) * half_u,
                v: tilted(DVec3::Z) * half_v,
            },
            Kind::Disc => LightShape::Disc {
                normal: tilted(DVec3::NEG_Y),
                radius: half_u,
            },
            Kind::Sphere => LightShape::Sphere { radius: half_u },
            Kind::Sun { angle_deg } => LightShape::Sun {
                direction: tilted(DVec3::NEG_Y),
                angle_deg,
            },
        };
        (place, shape)
    }
}

pub(super) fn rotated(point: DVec3, axis: DVec3, degrees: f64) -> DVec3 {
    glam::DQuat::from_axis_angle(axis, degrees.to_radians()) * point
}
