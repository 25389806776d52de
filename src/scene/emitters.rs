//! Lights and cameras of a glTF file.
//!
//! Area lights are those of the draft extension `EXT_lights_area`: a `rect` is `size` high (local y)
//! and `size` × `rect.aspect` wide (local x), a `disk` has the diameter `size`; both shine along the
//! node's −Z and grow with the largest component of its world scale. Intensities are in nit. Those of `KHR_lights_punctual` are points and
//! spots in candela, which become spheres, and suns in lux.

use std::cell::Cell;
use std::f64::consts::PI;

use glam::{DAffine3, DVec3, Vec3};
use gltf::json::Camera as CameraJson;
use gltf::json::Node;
use gltf::json::extensions::scene::khr_lights_punctual::Type;
use gltf::json::validation::Checked;
use serde::Deserialize;

use super::document::{Document, label};
use super::notes::Notes;
use super::options::LoadOptions;
use super::tree::Placed;
use super::{AreaLight, Beam, Camera, LightShape, SUN_ANGLE_DEG, Scene};
use crate::Result;

const AREA: &str = "EXT_lights_area";

#[derive(Deserialize, Default)]
struct AreaLights {
    lights: Vec<AreaLightJson>,
}

#[derive(Deserialize)]
struct AreaLightJson {
    name: Option<String>,
    #[serde(rename = "type", default = "rect")]
    kind: String,
    #[serde(default = "one")]
    size: f64,
    #[serde(default)]
    rect: RectJson,
    #[serde(default = "white")]
    color: [f32; 3],
    intensity: Option<f32>,
}

#[derive(Deserialize)]
struct RectJson {
    #[serde(default = "one")]
    aspect: f64,
}

impl Default for RectJson {
    fn default() -> Self {
        Self { aspect: one() }
    }
}

#[derive(Deserialize)]
struct AreaLightUse {
    light: usize,
}

fn rect() -> String {
    "rect".into()
}

fn one() -> f64 {
    1.0
}

fn white() -> [f32; 3] {
    [1.0; 3]
}

/// Turns nodes into lights and cameras.
pub(super) struct Emitters<'a> {
    document: &'a Document<'a>,
    area_lights: Vec<AreaLightJson>,
    punctual_radius: Option<f64>,
    sun_angle_deg: Option<f64>,
    /// Whether a light has taken that radius, that angle.
    radius_taken: Cell<bool>,
    angle_taken: Cell<bool>,
    /// [scene units, world]
    scene_center: DVec3,
    /// [scene units] The length of the bounding box's diagonal.
    scene_extent: f64,
}

impl<'a> Emitters<'a> {
    /// `scene` holds all triangles.
    ///
    /// # Errors
    /// When the file's area lights are malformed.
    pub fn new(document: &'a Document<'a>, options: &LoadOptions, scene: &Scene) -> Result<Self> {
        let extensions = document.root.extensions.as_ref();
        let area_lights = match extensions.and_then(|extensions| extensions.others.get(AREA)) {
            Some(json) => {
                AreaLights::deserialize(json).map_err(|e| document.error(format!("{AREA}: {e}")))?
            }
            None => AreaLights::default(),
        };
        let (low, high) = scene.bounds();
        Ok(Self {
            document,
            area_lights: area_lights.lights,
            punctual_radius: options.punctual_radius,
            sun_angle_deg: options.sun_angle_deg,
            radius_taken: Cell::new(false),
            angle_taken: Cell::new(false),
            scene_center: 0.5 * (low + high),
            scene_extent: (high - low).length(),
        })
    }

    /// A note on each flag that is of no use to the lights so far.
    pub fn idle_flags(&self) -> impl Iterator<Item = String> {
        let radius = self.punctual_radius.is_some() && !self.radius_taken.get();
        let angle = self.sun_angle_deg.is_some() && !self.angle_taken.get();
        let flags = [
            ("--radius", "point or spot", radius),
            ("--sun-angle", "directional", angle),
        ];
        let idle = flags.into_iter().filter(|(_, _, idle)| *idle);
        idle.map(|(flag, kind, _)| format!("{flag} is ignored, for the scene has no {kind} light."))
    }

    /// The light of a node, if it has one that can be rendered.
    ///
    /// # Errors
    /// When it is malformed or does not exist.
    pub fn light(&self, place: &Placed, notes: &mut Notes) -> Result<Option<AreaLight>> {
        let node = self.document.get(place.node, "node", "the node tree")?;
        let name = label("node", place.node.value(), node.name.as_deref());
        let Some(extensions) = &node.extensions else {
            return Ok(None);
        };
        if let Some(json) = extensions.others.get(AREA) {
            let reference = AreaLightUse::deserialize(json)
                .map_err(|e| self.document.error(format!("{name}: {AREA}: {e}")))?;
            return self.area_light(reference.light, node, &name, &place.world, notes);
        }
        match &extensions.khr_lights_punctual {
            Some(reference) => {
                self.punctual_light(reference.light, node, &name, &place.world, notes)
            }
            None => Ok(None),
        }
    }

    fn area_light(
        &self,
        index: usize,
        node: &Node,
        user: &str,
        world: &DAffine3,
        notes: &mut Notes,
    ) -> Result<Option<AreaLight>> {
        let document = self.document;
        let json = self.area_lights.get(index).ok_or_else(|| {
            document.error(format!(
                "{user} refers to area light {index}, which does not exist"
            ))
        })?;
        let name = label("area light", index, json.name.as_deref());
        if json.size < 0.0 || json.rect.aspect < 0.0 {
            return Err(document.error(format!("{name}: has a negative size")));
        }
        let matrix = world.matrix3;
        let scale = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(DVec3::length);
        let half = 0.5 * json.size * scale.into_iter().fold(0.0, f64::max);
        let frame = Frame::of(world);
        let shape = match json.kind.as_str() {
            "rect" => LightShape::Rect {
                u: frame.right * (half * json.rect.aspect),
                v: frame.forward.cross(frame.right) * half,
            },
            "disk" | "disc" => LightShape::Disc {
                normal: frame.forward,
                radius: half,
            },
            _ => {
                notes.add(
                    "an area light that is neither rect nor disk is left out",
                    &name,
                );
                return Ok(None);
            }
        };
        Ok(Some(AreaLight {
            name: json.name.clone().or(node.name.clone()).unwrap_or(name),
            center: world.translation,
            shape,
            color: Vec3::from(json.color).max(Vec3::ZERO),
            intensity: json.intensity,
            beam: None,
        }))
    }

    fn punctual_light(
        &self,
        index: gltf::json::Index<gltf::json::extensions::scene::khr_lights_punctual::Light>,
        node: &Node,
        user: &str,
        world: &DAffine3,
        notes: &mut Notes,
    ) -> Result<Option<AreaLight>> {
        let json = self.document.get(index, "light", user)?;
        let name = label("light", index.value(), json.name.as_deref());
        let forward = Frame::of(world).forward;
        let mut beam = None;
        let shape = match (&json.type_, self.punctual_radius) {
            (Checked::Invalid, _) => {
                notes.add("a light of an invalid type is left out", &name);
                return Ok(None);
            }
            (Checked::Valid(Type::Directional), _) => {
                self.angle_taken.set(true);
                LightShape::Sun {
                    direction: forward,
                    angle_deg: self.sun_angle_deg.unwrap_or(SUN_ANGLE_DEG),
                }
            }
            (_, None) => {
                notes.add(
                    "a point or spot light has no extent and is left out; pass --radius to give it one",
                    &name,
                );
                return Ok(None);
            }
            (Checked::Valid(kind), Some(radius)) => {
                self.radius_taken.set(true);
                beam = (json.spot.as_ref().filter(|_| *kind == Type::Spot)).map(|spot| Beam {
                    direction: forward,
                    inner_deg: f64::from(spot.inner_cone_angle).to_degrees(),
                    outer_deg: f64::from(spot.outer_cone_angle).to_degrees(),
                });
                LightShape::Sphere { radius }
            }
        };
        // Candela of a point or spot light, of which a sphere's radiance is what its disc has to have; lux of a directional one.
        let intensity = match shape {
            LightShape::Sphere { radius } if radius > 0.0 => {
                f64::from(json.intensity) / (PI * radius * radius)
            }
            _ => f64::from(json.intensity),
        };
        Ok(Some(AreaLight {
            name: json.name.clone().or(node.name.clone()).unwrap_or(name),
            center: world.translation,
            shape,
            color: Vec3::from(json.color).max(Vec3::ZERO),
            intensity: Some(intensity as f32),
            beam,
        }))
    }

    /// The camera of a node, if it has one that can be rendered.
    ///
    /// # Errors
    /// When it does not exist.
    pub fn camera(&self, place: &Placed, notes: &mut Notes) -> Result<Option<Camera>> {
        let node = self.document.get(place.node, "node", "the node tree")?;
        let Some(index) = node.camera else {
            return Ok(None);
        };
        let user = label("node", place.node.value(), node.name.as_deref());
        let json = self.document.get(index, "camera", &user)?;
        let name = label("camera", index.value(), json.name.as_deref());
        let Some((vfov_deg, ortho_height, aspect, near)) = projection(json) else {
            notes.add(
                "a camera that is neither a perspective nor an orthographic one is left out",
                &name,
            );
            return Ok(None);
        };
        let frame = Frame::of(&place.world);
        let eye = place.world.translation;
        // The point of the view axis nearest to the scene's centre stands for what the camera looks at.
        let ahead = (self.scene_center - eye).dot(frame.forward);
        let distance = match (ahead > 0.0, self.scene_extent > 0.0) {
            (true, _) => ahead,
            (false, true) => self.scene_extent,
            (false, false) => 1.0,
        };
        Ok(Some(Camera {
            name: json.name.clone().or(node.name.clone()).unwrap_or(name),
            eye,
            target: eye + frame.forward * distance,
            up: frame.up,
            vfov_deg,
            ortho_height,
            aspect,
            near: Some(near),
        }))
    }
}

/// [degree, scene units, width / height, scene units] Field of view, height of what parallel rays see, aspect ratio and near
/// plane of a camera. A negative extent mirrors the picture, which is not done here.
fn projection(json: &CameraJson) -> Option<(f64, Option<f64>, Option<f64>, f64)> {
    let of = |value: f32| f64::from(value);
    if let Some(pinhole) = &json.perspective {
        let aspect = pinhole.aspect_ratio.map(of);
        return Some((
            of(pinhole.yfov).to_degrees(),
            None,
            aspect,
            of(pinhole.znear),
        ));
    }
    let parallel = json.orthographic.as_ref()?;
    let (x, y) = (of(parallel.xmag).abs(), of(parallel.ymag).abs());
    Some((0.0, Some(2.0 * y), Some(x / y), of(parallel.znear)))
}

/// The directions of a node in world space, orthonormal whatever its scale.
struct Frame {
    right: DVec3,
    up: DVec3,
    /// The node's −Z.
    forward: DVec3,
}

impl Frame {
    fn of(world: &DAffine3) -> Self {
        let [x, y, z] = [
            world.matrix3.x_axis,
            world.matrix3.y_axis,
            world.matrix3.z_axis,
        ];
        // A scale of 0 along z still leaves the plane of x and y.
        let back = z.try_normalize().or_else(|| x.cross(y).try_normalize());
        let back = back.unwrap_or(DVec3::Z);
        let right = (x - back * x.dot(back)).try_normalize();
        let right = right.unwrap_or_else(|| back.any_orthonormal_vector());
        let up = back.cross(right);
        let up = if up.dot(y) < 0.0 { -up } else { up };
        Self {
            right,
            up,
            forward: -back,
        }
    }
}
