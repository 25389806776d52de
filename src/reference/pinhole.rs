//! A pinhole camera's rays, from its eye.

use glam::DVec3;

use crate::scene::Camera;
use crate::{Error, Result};

/// A camera with its axes worked out.
pub struct Pinhole {
    forward: DVec3,
    /// To the right border of the image plane at distance 1.
    right: DVec3,
    /// To its upper border.
    up: DVec3,
    /// [pixel]
    size: [f64; 2],
}

impl Pinhole {
    /// # Errors
    /// When the camera looks nowhere, along its own up vector, or has no field of view.
    pub fn new(camera: &Camera, width: u32, height: u32) -> Result<Self> {
        let invalid = |what: &str| Error::Invalid(format!("the camera {what}"));
        let (forward, distance) = (camera.target - camera.eye).normalize_and_length();
        if !(distance > 0.0 && distance.is_finite() && camera.eye.is_finite()) {
            return Err(invalid(
                "has no direction: eye and target are the same or not finite",
            ));
        }
        let right = forward
            .cross(camera.up.normalize_or_zero())
            .normalize_or_zero();
        if right == DVec3::ZERO {
            return Err(invalid("looks along its own up vector"));
        }
        if !(camera.vfov_deg > 0.0 && camera.vfov_deg < 180.0) {
            return Err(invalid(
                "needs a vertical field of view between 0° and 180°",
            ));
        }
        let half_height = (camera.vfov_deg.to_radians() / 2.0).tan();
        let size = [f64::from(width), f64::from(height)];
        Ok(Self {
            forward,
            right: right * (half_height * size[0] / size[1]),
            up: right.cross(forward) * half_height,
            size,
        })
    }

    /// The direction (not normalised) through the centre of pixel (x, y); row 0 is at the top.
    pub fn direction(&self, x: usize, y: usize) -> DVec3 {
        let along = |index: usize, size: f64| (index as f64 + 0.5) / size * 2.0 - 1.0;
        self.forward + self.right * along(x, self.size[0]) - self.up * along(y, self.size[1])
    }
}
