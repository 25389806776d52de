//! The camera as the shaders and the survey see it.

use glam::DVec3;

use super::survey::clip;
use crate::scene::Scene;
use crate::shared::Frame;
use crate::shot::Shot;

/// The camera's pyramid, relative to the scene's origin.
pub struct Frustum {
    pub eye: DVec3,
    /// Unit vector.
    pub forward: DVec3,
    /// Unit vectors divided by the tangents of the half angles: |right · way| ≤ forward · way inside.
    pub right: DVec3,
    pub up: DVec3,
    /// [scene units]
    pub near: f64,
}

/// [share of the distance that can matter] Near plane: reverse-Z in f32 loses nothing by a near one.
const NEAR: f64 = 1e-5;

impl Frustum {
    pub fn new(shot: &Shot) -> Self {
        let camera = &shot.camera;
        let forward = (camera.target - camera.eye).normalize();
        let right = forward.cross(camera.up).normalize();
        let up = right.cross(forward);
        let tangent = (0.5 * camera.vfov_deg.to_radians()).tan();
        let aspect = f64::from(shot.width) / f64::from(shot.height);
        let eye = camera.eye - shot.scene.origin;
        Self {
            eye,
            forward,
            right: right / (tangent * aspect),
            up: up / tangent,
            near: NEAR * farthest(&shot.scene, eye),
        }
    }

    /// The part of a triangle that the camera can see if nothing hides it.
    pub fn clip(&self, corners: [DVec3; 3]) -> Vec<DVec3> {
        let sides = [
            self.forward + self.right,
            self.forward - self.right,
            self.forward + self.up,
            self.forward - self.up,
        ];
        let mut polygon = corners.to_vec();
        for side in sides {
            if corners
                .iter()
                .any(|&corner| side.dot(corner - self.eye) < 0.0)
            {
                clip(&mut polygon, |point| side.dot(point - self.eye));
            }
        }
        polygon
    }

    pub fn frame(&self, shot: &Shot) -> Frame {
        let scene = &shot.scene;
        Frame {
            eye: self.eye.as_vec3().into(),
            right: self.right.as_vec3().into(),
            up: self.up.as_vec3().into(),
            forward: self.forward.as_vec3().into(),
            near: self.near as f32,
            size: [shot.width, shot.height],
            opaque_count: scene.opaque_count as u32,
            masked_count: (scene.triangles.len() - scene.opaque_count) as u32,
        }
    }
}

/// [scene units] Distance from the eye to the farthest corner of the scene's box.
fn farthest(scene: &Scene, eye: DVec3) -> f64 {
    let (lower, upper) = scene.bounds();
    let reach = (lower.as_dvec3() - eye)
        .abs()
        .max((upper.as_dvec3() - eye).abs());
    reach.length()
}
