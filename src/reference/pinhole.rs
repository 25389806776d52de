//! A camera's rays: those of a pinhole from its eye, or parallel ones.

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
    /// Rays are parallel, and what is seen is as large at any distance.
    orthographic: bool,
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
        // Written so that NaN fails them.
        let half_height = match camera.ortho_height {
            Some(height) if height > 0.0 && height.is_finite() => 0.5 * height,
            None if camera.vfov_deg > 0.0 && camera.vfov_deg < 180.0 => {
                (0.5 * camera.vfov_deg.to_radians()).tan()
            }
            _ => {
                return Err(invalid(
                    "needs a vertical field of view between 0° and 180°, or a height of more than 0",
                ));
            }
        };
        let size = [f64::from(width), f64::from(height)];
        Ok(Self {
            forward,
            right: right * (half_height * size[0] / size[1]),
            up: right.cross(forward) * half_height,
            orthographic: camera.ortho_height.is_some(),
            size,
        })
    }

    /// Where the ray through the centre of pixel (x, y) starts, relative to the eye, and its direction, of length 1 along the
    /// view axis; row 0 is at the top.
    pub fn ray(&self, x: usize, y: usize) -> (DVec3, DVec3) {
        let along = |index: usize, size: f64| (index as f64 + 0.5) / size * 2.0 - 1.0;
        let aside = self.right * along(x, self.size[0]) - self.up * along(y, self.size[1]);
        match self.orthographic {
            true => (aside, self.forward),
            false => (DVec3::ZERO, self.forward + aside),
        }
    }
}
