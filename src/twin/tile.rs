//! Tiles of the image: twin of `tile_bounds.comp`, in f32 and to the bit, for what is decided about tiles is decided on these bounds.

use glam::Vec3;

use crate::shared::TileBounds;

/// Bounds of the surface points in a tile, each a position relative to the eye and the normal of its visible side; None where there is
/// no surface.
pub fn bounds(points: impl IntoIterator<Item = (Vec3, Vec3)>) -> Option<TileBounds> {
    let of_point = |(position, normal): (Vec3, Vec3)| {
        let height = normal.x * position.x + normal.y * position.y + normal.z * position.z;
        TileBounds {
            lower: position.into(),
            upper: position.into(),
            normal_lower: normal.into(),
            normal_upper: normal.into(),
            height_lower: height,
            height_upper: height,
            error: 0.0,
        }
    };
    points.into_iter().map(of_point).reduce(joined)
}

fn joined(a: TileBounds, b: TileBounds) -> TileBounds {
    let least = |a: [f32; 3], b: [f32; 3]| Vec3::from(a).min(b.into()).into();
    let most = |a: [f32; 3], b: [f32; 3]| Vec3::from(a).max(b.into()).into();
    TileBounds {
        lower: least(a.lower, b.lower),
        upper: most(a.upper, b.upper),
        normal_lower: least(a.normal_lower, b.normal_lower),
        normal_upper: most(a.normal_upper, b.normal_upper),
        height_lower: a.height_lower.min(b.height_lower),
        height_upper: a.height_upper.max(b.height_upper),
        error: a.error.max(b.error),
    }
}
