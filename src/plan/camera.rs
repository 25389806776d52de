//! The camera as the shaders and the survey see it.

use glam::DVec3;

use super::clip::clip;
use crate::scene::Scene;
use crate::shared::Frame;
use crate::shot::Shot;

/// What the camera sees: a pyramid, or a box of parallel rays. Positions are relative to its eye.
pub struct Frustum {
    /// Unit vector.
    pub forward: DVec3,
    /// Unit vectors divided by the tangents of the half angles, or by half of what parallel rays see: |right · way| is at most
    /// `reach` inside.
    pub right: DVec3,
    pub up: DVec3,
    /// [scene units]
    pub near: f64,
    /// [scene units] Beyond everything.
    far: f64,
    /// Rays are parallel.
    pub orthographic: bool,
}

/// [share] Near plane of a camera that states none, of the distance to its target and of the farthest thing that there is,
/// whichever is less. Reverse-Z in f32 loses nothing by a near one.
const NEAR: f64 = 1e-7;

impl Frustum {
    pub fn new(shot: &Shot) -> Self {
        let camera = &shot.camera;
        let (forward, distance) = (camera.target - camera.eye).normalize_and_length();
        let right = forward.cross(camera.up).normalize();
        let up = right.cross(forward);
        let half = match camera.ortho_height {
            Some(height) => 0.5 * height,
            None => (0.5 * camera.vfov_deg.to_radians()).tan(),
        };
        let aspect = f64::from(shot.width) / f64::from(shot.height);
        let farthest = farthest(&shot.scene, camera.eye);
        let nearest = NEAR * distance.min(farthest);
        // A plane through the eye itself has no depths.
        let near = camera.near.unwrap_or(0.0).max(nearest);
        Self {
            forward,
            right: right / (half * aspect),
            up: up / half,
            near,
            far: near + 1.001 * farthest,
            orthographic: camera.ortho_height.is_some(),
        }
    }

    /// The part of a triangle that the camera can see if nothing hides it.
    pub fn clip(&self, corners: [DVec3; 3]) -> Vec<DVec3> {
        let mut polygon = corners.to_vec();
        for axis in [self.right, -self.right, self.up, -self.up] {
            let inside = |point: DVec3| match self.orthographic {
                true => 1.0 + axis.dot(point),
                false => (self.forward + axis).dot(point),
            };
            if corners.iter().any(|&corner| inside(corner) < 0.0) {
                clip(&mut polygon, inside);
            }
        }
        if self.orthographic && corners.iter().any(|corner| self.forward.dot(*corner) < 0.0) {
            clip(&mut polygon, |point| self.forward.dot(point));
        }
        polygon
    }

    pub fn frame(&self, shot: &Shot) -> Frame {
        let scene = &shot.scene;
        Frame {
            right: self.right.as_vec3().into(),
            up: self.up.as_vec3().into(),
            forward: self.forward.as_vec3().into(),
            near: self.near as f32,
            far: self.far as f32,
            size: [shot.width, shot.height],
            opaque_count: scene.opaque_count as u32,
            masked_count: (scene.triangles.len() - scene.opaque_count) as u32,
        }
    }
}

/// [scene units] Distance from the eye to the farthest corner of the scene's box.
fn farthest(scene: &Scene, eye: DVec3) -> f64 {
    let (lower, upper) = scene.bounds();
    let reach = (lower - eye).abs().max((upper - eye).abs());
    reach.length()
}
