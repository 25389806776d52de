//! Cameras and lights, written alike into the shot file and into the glTF.

use glam::{DMat3, DMat4, DQuat, DVec3};
use serde_json::json;

use super::document::Document;

/// An area light, in world space.
pub enum Light {
    /// Half-axis vectors, perpendicular to each other; it shines along u × v.
    Rect { center: DVec3, u: DVec3, v: DVec3 },
    /// It shines along `normal` (of unit length).
    Disc {
        center: DVec3,
        normal: DVec3,
        radius: f64,
    },
}

/// What a shot file holds: one camera, one light, 256 × 256 pixels.
pub struct Shot {
    pub name: &'static str,
    /// One sentence: what to look at.
    pub what: &'static str,
    pub eye: DVec3,
    pub target: DVec3,
    /// [degree] The full vertical field of view.
    pub vfov_deg: f64,
    pub light: Light,
}

impl Light {
    fn to_json(&self) -> serde_json::Value {
        match *self {
            Self::Rect { center, u, v } => json!({
                "type": "rect",
                "center": center.to_array(), "u": u.to_array(), "v": v.to_array(),
            }),
            Self::Disc {
                center,
                normal,
                radius,
            } => json!({
                "type": "disc",
                "center": center.to_array(), "normal": normal.to_array(), "radius": radius,
            }),
        }
    }
}

impl Shot {
    /// [pixel] Width and height of every shot.
    const SIZE: u32 = 256;

    /// The shot file, for the scene file of this name beside it.
    pub fn to_json(&self, scene: &str) -> String {
        self.under(&self.light.to_json(), scene)
    }

    /// The shot file with another light.
    pub fn under(&self, light: &serde_json::Value, scene: &str) -> String {
        let camera = json!({
            "eye": self.eye.to_array(), "target": self.target.to_array(), "up": [0, 1, 0],
            "vfov_deg": self.vfov_deg, "width": Self::SIZE, "height": Self::SIZE,
        });
        format!(
            "{{\n  \"name\": {},\n  \"what\": {},\n  \"scene\": {},\n  \"camera\": {camera},\n  \"lights\": [\n    {light}\n  ]\n}}\n",
            json!(self.name),
            json!(self.what),
            json!(scene),
        )
    }

    /// Adds the camera and the light to the glTF; returns their nodes.
    pub fn add_to(&self, document: &mut Document) -> [usize; 2] {
        let back = (self.eye - self.target).normalize();
        let right = DVec3::Y.cross(back).normalize();
        let axes = DMat3::from_cols(right, back.cross(right), back);
        let camera_to_world = DMat4::from_mat3_translation(axes, self.eye);
        let camera = document.camera(json!({
            "type": "perspective",
            "perspective": {
                "yfov": self.vfov_deg.to_radians(), "aspectRatio": 1.0, "znear": 0.05,
            },
        }));
        let camera = document.node(json!({
            "name": "camera", "camera": camera,
            "matrix": camera_to_world.to_cols_array(),
        }));
        [camera, self.add_light_to(document)]
    }

    /// EXT_lights_area: the light lies in its node's xy plane and shines along −z. No intensity is
    /// given, as in the shot file.
    fn add_light_to(&self, document: &mut Document) -> usize {
        let (center, x, direction, light) = match self.light {
            Light::Rect { center, u, v } => (
                center,
                u.normalize(),
                u.cross(v).normalize(),
                json!({
                    "name": "light", "type": "rect", "size": 2.0 * v.length(),
                    "rect": { "aspect": u.length() / v.length() },
                }),
            ),
            Light::Disc {
                center,
                normal,
                radius,
            } => (
                center,
                normal.any_orthonormal_vector(),
                normal,
                json!({ "name": "light", "type": "disk", "size": 2.0 * radius }),
            ),
        };
        let axes = DMat3::from_cols(x, x.cross(direction), -direction);
        let rotation = DQuat::from_mat3(&axes).normalize();
        document.area_light(center, rotation, light)
    }
}
