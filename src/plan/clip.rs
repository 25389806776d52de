//! Clipping of polygons.

use glam::DVec3;

/// Keeps the part of a convex polygon where `distance` ≥ 0 (Sutherland and Hodgman).
pub fn clip(polygon: &mut Vec<DVec3>, distance: impl Fn(DVec3) -> f64) {
    let Some(&last) = polygon.last() else { return };
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    let (mut previous, mut before) = (last, distance(last));
    for &current in polygon.iter() {
        let after = distance(current);
        if (before < 0.0) != (after < 0.0) {
            kept.push(previous.lerp(current, before / (before - after)));
        }
        if after >= 0.0 {
            kept.push(current);
        }
        (previous, before) = (current, after);
    }
    *polygon = kept;
}
