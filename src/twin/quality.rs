//! Levels of quality [Schwarz08 §4.2, §6]: twin of `lib/coarse_map.glsl`, `lib/quality.glsl`, `lib/blend.glsl` and
//! `smooth_quality.comp`.

use glam::{Vec2, Vec3};

use super::contour::ShadowMap;
use super::receiver::Receiver;
use crate::shared::{BIAS_SLOPE_MAX, Fit, KERNEL_PENUMBRA, Kernel, View};

/// Cells, first and last, inclusive.
type Cells = ([i32; 2], [i32; 2]);

/// The levels of a map that are coarser than it: texels of 2^level × 2^level, each with the least and the largest depth.
pub struct CoarseMap {
    size: i32,
    /// From level 1 on, row by row.
    levels: Vec<Vec<[f32; 2]>>,
}

/// What limits the quality of a pixel.
#[derive(Debug, Clone, Copy)]
pub struct Budget {
    /// [texel] Along a side of a kernel.
    pub texels: f32,
    /// [level] Coarser than the map that there are.
    pub levels: u32,
    /// Queries hold all that coarse texels stand for.
    pub grows: bool,
}

impl CoarseMap {
    /// By the definition: each texel from the map's own.
    pub fn new(map: &ShadowMap, levels: u32) -> Self {
        let depth = |x: i32, y: i32| match x < map.size && y < map.size {
            true => map.depths[(y * map.size + x) as usize],
            false => 0.0,
        };
        let level = |level: u32| {
            let (texel, side) = (1 << level, side(map.size, level));
            let bounds = |i: i32| {
                let (left, top) = (i % side * texel, i / side * texel);
                let all =
                    (top..top + texel).flat_map(|y| (left..left + texel).map(move |x| (x, y)));
                all.fold([1e30, 0.0], |[least, most]: [f32; 2], (x, y)| {
                    let depth = depth(x, y);
                    [least.min(depth), most.max(depth)]
                })
            };
            (0..side * side).map(bounds).collect()
        };
        Self {
            size: map.size,
            levels: (1..=levels).map(level).collect(),
        }
    }

    /// (least, largest) of each texel of a level from 1 up, row by row.
    pub fn level(&self, level: u32) -> &[[f32; 2]] {
        &self.levels[level as usize - 1]
    }

    /// A level from 1 up as a map of its own, the depths nearest to the light, inside the larger map that has room round it: side
    /// and depths.
    pub fn seen(&self, level: u32) -> (i32, Vec<f32>) {
        let margin = 1 << (self.levels.len() as u32 - level);
        let own = side(self.size, level);
        // As much behind it as before it.
        let side = own + 2 * margin;
        let mut depths = vec![0.0; (side * side) as usize];
        for (i, [_, most]) in self.level(level).iter().enumerate() {
            let (x, y) = (i as i32 % own + margin, i as i32 / own + margin);
            depths[(y * side + x) as usize] = *most;
        }
        (side, depths)
    }
}

/// [texel] Of a level.
fn side(map: i32, level: u32) -> i32 {
    (map + (1 << level) - 1) >> level
}

impl Budget {
    fn texels_along((first, last): Cells) -> f32 {
        let side = [0, 1].map(|axis| last[axis] - first[axis] + 2);
        side[0].max(side[1]) as f32
    }

    /// [level] A fractional one.
    pub fn quality(&self, cells: Cells) -> f32 {
        let level = (Self::texels_along(cells) / self.texels).log2();
        level.clamp(0.0, self.levels as f32)
    }

    /// [level] The first whole one with no more texels than the budget allows.
    pub fn level(&self, cells: Cells) -> u32 {
        let keeps = |level: &u32| Self::texels_along(cells) <= self.texels * (1 << level) as f32;
        (0..self.levels).find(keeps).unwrap_or(self.levels)
    }

    /// A kernel's cells in a level, seen in the larger map.
    pub fn coarse_cells(&self, (first, last): Cells, level: u32) -> Cells {
        let cell =
            |corner: i32| (2 * (corner + (1 << self.levels)) + 1 - (1 << level)) >> (level + 1);
        (first.map(cell), last.map(|i| cell(i + 1)))
    }

    /// The cells that a query asks for in place of a kernel's.
    pub fn queried(&self, cells: Cells, map: i32) -> Cells {
        let level = self.level(cells);
        if level == 0 || !self.grows {
            return cells;
        }
        let (first, last) = self.coarse_cells(cells, level);
        let texel = |i: i32| (i << level) - (1 << self.levels);
        (
            first.map(|i| texel(i).max(0)),
            last.map(|i| (texel(i + 2) - 2).min(map - 2)),
        )
    }
}

/// [texel] A place of the map in a level, seen in the larger map.
fn place(t: Vec2, level: u32, levels: u32) -> Vec2 {
    (t + ((1 << levels) as f32 + 0.5)) / (1 << level) as f32 - 0.5
}

/// A receiver seen in a level from 1 up.
pub fn receiver_at(view: &View, receiver: &Receiver, level: u32, levels: u32) -> Receiver {
    let side = (1 << level) as f32;
    let slope = receiver.plane.x.abs() + receiver.plane.y.abs();
    let bias = slope * ((side - 1.0) * (view.bias + 0.5));
    let mut t = place(receiver.t, level, levels);
    if (2.0 * t.x).fract() == 0.0 {
        t.x = f32::from_bits(t.x.to_bits() + 1);
    }
    Receiver {
        t,
        biased: receiver.biased + bias.min(BIAS_SLOPE_MAX * receiver.d),
        plane: receiver.plane * side,
        ku: receiver.ku * side,
        kv: receiver.kv * side,
        b: receiver.b * side,
        ..*receiver
    }
}

/// A view's projection to a level from 1 up.
pub fn fit_at(fit: &Fit, level: u32, levels: u32) -> Fit {
    Fit {
        focal: fit.focal.map(|focal| focal / (1 << level) as f32),
        center: place(fit.center.into(), level, levels).into(),
        ..*fit
    }
}

/// [pixel] To both sides.
const REACH: i32 = 5;
/// [share of the distance from the light] Off the plane of the pixel before.
const OFF_PLANE: f32 = 0.02;

/// What smoothing has to know of an image.
pub struct Surface<'a> {
    /// [pixel]
    pub size: [i32; 2],
    pub kernels: &'a [Kernel],
    /// Position and normal; None where there is no surface.
    pub points: &'a [Option<(Vec3, Vec3)>],
    /// The sub-light's centre.
    pub light: Vec3,
}

impl Surface<'_> {
    /// Of a pixel that is integrated, its place in the image and its point.
    fn point(&self, [x, y]: [i32; 2]) -> Option<(usize, (Vec3, Vec3))> {
        let inside = x >= 0 && y >= 0 && x < self.size[0] && y < self.size[1];
        let index = inside.then(|| (y * self.size[0] + x) as usize)?;
        let penumbra = self.kernels[index].status == KERNEL_PENUMBRA;
        Some((index, self.points[index].filter(|_| penumbra)?))
    }

    fn goes_on(&self, from: (Vec3, Vec3), to: (Vec3, Vec3)) -> bool {
        let way = to.0 - from.0;
        let off = from.1.dot(way).abs().max(to.1.dot(way).abs());
        off <= OFF_PLANE * to.0.distance(self.light)
    }

    /// The mean level round a pixel along an axis, 0 or 1.
    fn mean(&self, levels: &[f32], pixel: [i32; 2], axis: usize) -> Option<f32> {
        let (index, own) = self.point(pixel)?;
        let mut near = vec![levels[index]];
        for way in [-1, 1] {
            let mut before = own;
            for i in 1..=REACH {
                let mut next = pixel;
                next[axis] += way * i;
                match self.point(next) {
                    Some((index, point)) if self.goes_on(before, point) => {
                        near.push(levels[index]);
                        before = point;
                    }
                    _ => break,
                }
            }
        }
        Some(near.iter().sum::<f32>() / near.len() as f32)
    }

    /// Levels smoothed along rows, then along columns; as they are where nothing is integrated.
    pub fn smoothed(&self, levels: &[f32]) -> Vec<f32> {
        let pixels = (0..levels.len() as i32).map(|i| [i % self.size[0], i / self.size[0]]);
        let along = |levels: &[f32], axis| -> Vec<f32> {
            let mean = |(own, pixel): (&f32, _)| self.mean(levels, pixel, axis).unwrap_or(*own);
            levels.iter().zip(pixels.clone()).map(mean).collect()
        };
        along(&along(levels, 0), 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BUDGET: Budget = Budget {
        texels: 8.0,
        levels: 6,
        grows: true,
    };

    fn boxes() -> impl Iterator<Item = Cells> {
        let sides = [0, 1, 6, 7, 30, 31, 63, 100];
        (0..20).flat_map(move |at| sides.map(|side| ([at, 2 * at], [at + side, 2 * at + side / 2])))
    }

    #[test]
    fn whole_levels_keep_to_the_budget_and_no_finer_one_does() {
        for cells in boxes() {
            let texels = Budget::texels_along(cells);
            let level = BUDGET.level(cells);
            let along = |level: u32| texels / (1 << level) as f32;
            assert!(along(level) <= BUDGET.texels);
            assert!(level == 0 || along(level - 1) > BUDGET.texels);
            assert_eq!(BUDGET.quality(cells).ceil() as u32, level, "{cells:?}");
        }
    }

    /// All that the corners of a level's cells stand for, and the kernel itself.
    #[test]
    fn queries_hold_what_coarse_texels_stand_for() {
        let map = 256;
        for (first, last) in boxes() {
            let level = BUDGET.level((first, last));
            let grown = BUDGET.queried((first, last), map);
            let inner = BUDGET.coarse_cells((first, last), level);
            for axis in 0..2 {
                assert!(grown.0[axis] <= first[axis] && grown.1[axis] >= last[axis]);
                // No farther than two coarse texels.
                assert!(first[axis] - grown.0[axis] < 2 << level);
                assert!(grown.1[axis] - last[axis] < 2 << level);
                let texels = (inner.1[axis] + 1 - inner.0[axis] + 1) << level;
                assert!(level == 0 || grown.1[axis] + 2 - grown.0[axis] <= texels);
            }
        }
    }
}
