//! Shadow maps that a host has drawn with a perspective projection of its own.

use glam::{DMat4, DVec3, DVec4, Vec3, Vec4};

use crate::error::{Error, Result};
use crate::shared::{Given, View};

/// [share of the largest half size] How far from the part's centre a map's eye may stand: f32 matrices round.
const EYE_TOLERANCE: f64 = 1e-2;

/// A shadow map of the host's.
#[derive(Debug, Clone, Copy)]
pub struct GivenMap {
    /// Columns of the matrix that it was drawn with.
    pub clip_from_world: [[f32; 4]; 4],
    /// The depth where there is no caster.
    pub depth_empty: f32,
}

/// Takes the view's directions and its projection from the matrix that a map was drawn with. Does not allocate.
///
/// # Errors
/// The matrix is no perspective projection from the centre of the view's part of the light.
pub fn given_view(view: &mut View, given: &mut Given, map: &GivenMap) -> Result<()> {
    let invalid = |text: &str| Err(Error::Invalid(format!("a shadow map's matrix {text}")));
    let columns = map
        .clip_from_world
        .map(|column| Vec4::from_array(column).as_dvec4());
    let matrix = DMat4::from_cols(columns[0], columns[1], columns[2], columns[3]);
    let scale = matrix.row(3).truncate().length();
    if !(matrix.is_finite() && scale > 0.0) {
        return invalid("is not finite, or no perspective");
    }
    // Such that w is the distance from the eye's plane.
    let [x, y, z, w] = [0, 1, 2, 3].map(|row| matrix.row(row) / scale);
    let forward = w.truncate();
    // Along the axes of the image, without what perspective adds when the centre is moved.
    let across = |row: DVec4| row.truncate() - forward * row.truncate().dot(forward);
    let (right, down) = (across(x), across(y));
    let focal = [right.length(), down.length()];
    if focal.iter().any(|focal| focal.is_nan() || *focal <= 0.0) {
        return invalid("shows nothing");
    }
    let (right, down) = (right / focal[0], down / focal[1]);
    if right.dot(down).abs() > 1e-4 {
        return invalid("is skewed");
    }
    let center = Vec3::from_array(view.center).as_dvec3();
    let eye = |row: DVec4| row.dot(center.extend(1.0)).abs();
    let tolerance = EYE_TOLERANCE * f64::from(view.half_size[0].max(view.half_size[1]));
    if eye(x) > tolerance * focal[0] || eye(y) > tolerance * focal[1] || eye(w) > tolerance {
        return invalid("does not look from the centre of its part of the light");
    }
    // depth · w = z: depth = scale + offset / w.
    let depth_scale = z.truncate().dot(forward);
    let depth_offset = z.dot(center.extend(1.0));
    if depth_offset == 0.0 {
        return invalid("gives all casters the same depth");
    }
    let map_size = f64::from(view.map_size);
    // right × up = forward; a map that is the other way round is read from right to left.
    let mirrored = right.cross(down).dot(forward) < 0.0;
    let side = if mirrored { -1.0 } else { 1.0 };
    let to_texels = |row: DVec4| (0.5 * row.truncate().dot(forward) + 0.5) * map_size - 0.5;
    let texel_x = to_texels(x);
    given.focal = focal.map(|focal| (0.5 * focal * map_size) as f32);
    given.center = [
        if mirrored {
            map_size - 1.0 - texel_x
        } else {
            texel_x
        } as f32,
        to_texels(y) as f32,
    ];
    given.depth_scale = depth_scale as f32;
    given.depth_offset = depth_offset as f32;
    given.depth_empty = map.depth_empty;
    given.mirrored = u32::from(mirrored);
    let array = |vector: DVec3| -> [f32; 3] { vector.as_vec3().into() };
    view.right = array(right * side);
    view.up = array(down);
    view.forward = array(forward);
    Ok(())
}
