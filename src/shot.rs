//! One image, completely: a scene, a camera, lights, a size and the settings of the technique.

use std::sync::Arc;

use glam::DVec3;

use crate::image::Plane;
use crate::scene::{AreaLight, Camera, MAX_COORDINATE, Scene};
use crate::technique::Settings;
use crate::{Error, Result};

mod budget_map;
#[cfg(feature = "cli")]
mod built_in;
mod load;

pub use load::Overrides;

/// One image, completely.
#[derive(Debug, Clone)]
pub struct Shot {
    pub scene: Arc<Scene>,
    pub camera: Camera,
    /// [pixel]
    pub width: u32,
    /// [pixel]
    pub height: u32,
    pub lights: Vec<AreaLight>,
    pub settings: Settings,
    /// [0, 1] Shares of the settings' budget that pixels have [Schwarz08 §4.2], stretched over the image; none = all of it.
    pub budget_map: Option<Arc<Plane>>,
    /// The lights come in candela, lux and nit, so that their picture needs an exposure (`plan::suited_exposure`).
    pub physical: bool,
    /// What the shot file asked for and is ignored, a sentence each (`Scene::notes` are the scene's).
    pub notes: Vec<String>,
}

/// [pixel] The largest width and height of an image.
pub const MAX_SIZE: u32 = 32768;

impl Shot {
    /// [scene units, world] What positions on the device are relative to: the camera's eye, so that what is seen keeps its
    /// precision whatever else the scene holds.
    pub fn origin(&self) -> DVec3 {
        self.camera.eye
    }

    /// [scene units] Surfaces no higher over the plane of a light touch it: they are the lamp's own and cast no shadow. That
    /// is 1e-7 of the light's size, or what rounds off coordinates as large as the light's, be it in the file, whose are
    /// no larger than the scene, or seen from the eye.
    pub fn touch(&self, light: &AreaLight) -> f64 {
        let (lower, upper) = self.scene.bounds();
        let in_file = light.center.abs().max_element();
        let of_scene = 0.5 * (upper - lower).max_element();
        let from_eye = (light.center - self.origin()).abs().max_element();
        light.touch(from_eye.max(in_file.min(of_scene)))
    }

    /// # Errors
    /// [`Error::Invalid`] when the shot cannot be rendered: no triangles, no light, or a camera, size,
    /// light, budget map or setting that makes no sense.
    pub fn validate(&self) -> Result<()> {
        if self.scene.triangles.is_empty() {
            return Err(Error::Invalid("the scene holds no triangles".into()));
        }
        let size = 1..=MAX_SIZE;
        if !size.contains(&self.width) || !size.contains(&self.height) {
            return Err(Error::Invalid(format!(
                "an image is 1 to {MAX_SIZE} pixels wide and high, not {}x{}",
                self.width, self.height
            )));
        }
        self.camera.validate()?;
        if self.lights.is_empty() {
            return Err(Error::Invalid("there is no light".into()));
        }
        self.lights.iter().try_for_each(AreaLight::validate)?;
        let is_share = |share: &f32| (0.0..=1.0).contains(share);
        let are_shares = |map: &Plane| !map.data.is_empty() && map.data.iter().all(is_share);
        if !self.budget_map.as_deref().is_none_or(are_shares) {
            return Err(Error::Invalid(
                "the budget map has no pixels, or some that are not from 0 to 1".into(),
            ));
        }
        self.settings.validate()
    }
}

/// The smallest |sin| between a camera's `up` and its view direction.
const UP_TOLERANCE: f64 = 1e-6;

impl Camera {
    /// # Errors
    /// [`Error::Invalid`] when a number is not finite or beyond 10¹⁸, eye and target coincide, `up` has
    /// no length or lies along the view direction, the field of view is not in (0, 180), the height of what parallel rays see
    /// is not in (0, 10¹⁸], or the near plane is not in [0, 10¹⁸].
    pub fn validate(&self) -> Result<()> {
        let vectors = [self.eye, self.target, self.up];
        let sane = |v: &DVec3| v.is_finite() && v.abs().max_element() <= MAX_COORDINATE;
        let view = (self.target - self.eye).try_normalize();
        let fault = match (view, self.up.try_normalize()) {
            _ if !vectors.iter().all(sane) => "its eye, target or up is not finite or beyond 1e18",
            _ if !self
                .ortho_height
                .is_none_or(|height| height > 0.0 && height <= MAX_COORDINATE) =>
            {
                "its ortho_height must be more than 0 and at most 1e18"
            }
            _ if self.ortho_height.is_none() && !(self.vfov_deg > 0.0 && self.vfov_deg < 180.0) => {
                "its vertical field of view must be more than 0 and less than 180 degrees"
            }
            _ if !self
                .near
                .is_none_or(|near| (0.0..=MAX_COORDINATE).contains(&near)) =>
            {
                "its near plane must be at a distance from 0 to 1e18"
            }
            (None, _) => "its eye and target are the same point",
            (_, None) => "its up has no length",
            (Some(view), Some(up)) if view.cross(up).length() < UP_TOLERANCE => {
                "its up is parallel to the view direction"
            }
            _ => return Ok(()),
        };
        Err(Error::Invalid(format!(
            "the camera cannot be used: {fault}"
        )))
    }
}
