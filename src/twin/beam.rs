//! The cone that a light's shine is kept in: twin of `lib/beam.glsl`.

use glam::Vec3;

use crate::shared::Light;

/// [0, 1] The share of the shine that goes to a place.
pub fn share(light: &Light, position: Vec3) -> f32 {
    let way = position - Vec3::from(light.center);
    let cosine = Vec3::from(light.beam).dot(way) / way.length_squared().max(1e-36).sqrt();
    let root = 1.0 - (light.beam_start - cosine) * light.beam_slope;
    root.clamp(0.0, 1.0).powi(2)
}
