//! Pixels that are joined from their neighbours on a grid: twin of `grids.comp`, of what `kernels.comp` decides about them, and of
//! `join.comp`. Places are those of a pixel in its tile: column, row.

use glam::Vec3;

use super::kernels::unpacked;
use crate::shared::{GRID_MAX, GRID_ROWS, KERNEL_PENUMBRA, Kernel, TILE_SIZE};

/// [share of the way] How far a point is off the plane of another one of its surface.
const OFF_PLANE: f32 = 0.1;
/// [cosine] Least between their normals.
const ALONG_NORMAL: f32 = 0.95;
/// Kernels are alike whose borders are apart by no more than one in so many of their cells.
const ALIKE: i32 = 2;

/// Whether a grid has a row, or a column.
fn is_row(grid: u32, row: u32) -> bool {
    GRID_ROWS >> (grid * TILE_SIZE + row) & 1 != 0
}

/// The last row, or column, of a grid up to one, and the first from there on.
fn rows_around(grid: u32, row: u32) -> [u32; 2] {
    let is_on = |&row: &u32| is_row(grid, row);
    let before = (0..=row).rev().find(is_on);
    let after = (row..TILE_SIZE).find(is_on);
    [before, after].map(|found| found.expect("a grid has the first and the last row"))
}

/// The neighbours of a pixel on a grid, two to a row.
pub fn neighbours(grid: u32, [column, row]: [u32; 2]) -> [[u32; 2]; 4] {
    let ([left, right], [above, below]) = (rows_around(grid, column), rows_around(grid, row));
    [[left, above], [right, above], [left, below], [right, below]]
}

/// Whether two points, each a position and the normal of its visible side, are of one surface that hardly bends between them.
fn is_same_surface((a, normal_a): (Vec3, Vec3), (b, normal_b): (Vec3, Vec3)) -> bool {
    let dot = |a: Vec3, b: Vec3| a.x * b.x + a.y * b.y + a.z * b.z;
    let way = b - a;
    let off = dot(normal_a, way).abs().max(dot(normal_b, way).abs());
    let most = OFF_PLANE * OFF_PLANE * dot(way, way);
    off * off <= most && dot(normal_a, normal_b) >= ALONG_NORMAL
}

/// The grids on which a pixel has neighbours of its surface, a bit each. `point_at`: what is visible at a place of the tile.
pub fn grids(place: [u32; 2], point_at: impl Fn([u32; 2]) -> Option<(Vec3, Vec3)>) -> u32 {
    let like = |neighbour: [u32; 2]| match (point_at(place), point_at(neighbour)) {
        (Some(point), Some(other)) => is_same_surface(point, other),
        _ => false,
    };
    let has = |&grid: &u32| {
        let around = neighbours(grid, place);
        around[0] != place && around.into_iter().all(like)
    };
    (1..=GRID_MAX).filter(has).map(|grid| 1 << grid).sum()
}

/// The grid on which a pixel is joined, of those up to `sparsest` on which it has neighbours of its surface; None: it is as its
/// kernel says. `kernel_at`: that of a place of the tile.
pub fn joined_on(
    place: [u32; 2],
    grids: u32,
    sparsest: u32,
    kernel_at: impl Fn([u32; 2]) -> Kernel,
) -> Option<u32> {
    let kernel = kernel_at(place);
    let is_like = |neighbour| {
        let other = kernel_at(neighbour);
        other.status == KERNEL_PENUMBRA && is_alike(&kernel, &other)
    };
    let joins =
        |&grid: &u32| grids >> grid & 1 != 0 && neighbours(grid, place).into_iter().all(is_like);
    let of_sparsest = (1..=sparsest).rev().find(joins);
    of_sparsest.filter(|_| kernel.status == KERNEL_PENUMBRA)
}

fn is_alike(kernel: &Kernel, other: &Kernel) -> bool {
    let borders = |kernel: &Kernel| (unpacked(kernel.first), unpacked(kernel.last));
    let ((first, last), (other_first, other_last)) = (borders(kernel), borders(other));
    (0..2).all(|axis| {
        let moved = (other_first[axis] - first[axis]).abs();
        let moved = moved.max((other_last[axis] - last[axis]).abs());
        ALIKE * moved <= last[axis] - first[axis] + 1
    })
}

/// What a view hides of a pixel that is joined on a grid. `hidden`: what it hides of a place of the tile.
pub fn joined(place: [u32; 2], grid: u32, hidden: impl Fn([u32; 2]) -> f64) -> f64 {
    let around = neighbours(grid, place);
    let share = |axis: usize| {
        let [before, after] = [around[0], around[3]].map(|neighbour| neighbour[axis]);
        f64::from(place[axis] - before) / f64::from((after - before).max(1))
    };
    let [left_above, right_above, left_below, right_below] = around.map(hidden);
    let (along, down) = (share(0), share(1));
    let above = left_above + along * (right_above - left_above);
    let below = left_below + along * (right_below - left_below);
    above + down * (below - above)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_end_with_the_tile_and_have_all_of_sparser_ones() {
        for grid in 0..=GRID_MAX {
            assert!(is_row(grid, 0) && is_row(grid, TILE_SIZE - 1));
            let count = (0..TILE_SIZE).filter(|&row| is_row(grid, row)).count() as u32;
            assert_eq!(count, TILE_SIZE >> grid);
            assert!(
                (0..TILE_SIZE).all(|row| grid == 0 || !is_row(grid, row) || is_row(grid - 1, row))
            );
        }
    }

    #[test]
    fn what_is_linear_is_joined_as_it_is() {
        let linear =
            |[column, row]: [u32; 2]| 0.1 + 0.03 * f64::from(column) - 0.02 * f64::from(row);
        for grid in 0..=GRID_MAX {
            for place in (0..64).map(|i| [i % 8, i / 8]) {
                let found = joined(place, grid, linear);
                assert!((found - linear(place)).abs() < 1e-15, "{grid}, {place:?}");
            }
        }
    }
}
