//! The corners of polygons: twin of `lib/outline.glsl`.

use glam::Vec2;

use crate::shared::Light;

/// A polygon's corners among those of all; none of other lights.
pub fn corners_of<'a>(light: &Light, corners: &'a [[f32; 2]]) -> &'a [[f32; 2]] {
    let first = light.corner_first as usize;
    match light.corner_count as usize {
        0 => &[],
        count => &corners[first..first + count],
    }
}

/// How far corners \[half sizes\] reach along a direction, times its length.
pub fn reach(corners: &[[f32; 2]], direction: Vec2) -> f32 {
    let along = corners
        .iter()
        .map(|&corner| Vec2::from(corner).dot(direction));
    along.fold(f32::NEG_INFINITY, f32::max)
}
