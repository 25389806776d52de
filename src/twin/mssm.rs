//! The dual-grid MSSM [Yang09 §4.2; algorithm.md §4]: twin of `mssm.comp` and of `lib/mssm.glsl`.

/// Level l, texel (i, j): least and largest depth over the dual cells [i, i + 2^l) × [j, j + 2^l). What lies
/// beyond the map is empty: depth 0.
pub struct Mssm {
    /// [texel] Width and height of the map.
    size: i32,
    levels: Vec<Vec<[f32; 2]>>,
}

impl Mssm {
    /// The lowest `level_count` levels over a map of `size` × `size` depths, row by row; bounds of 32 or 16 bits.
    ///
    /// # Panics
    /// When `depths` are not as many.
    pub fn new(size: u32, depths: &[f32], level_count: u32, bits: u32) -> Self {
        assert_eq!(depths.len(), (size * size) as usize);
        let mut mssm = Self {
            size: size as i32,
            levels: Vec::new(),
        };
        let samples: Vec<[f32; 2]> = depths.iter().map(|&d| [d, d]).collect();
        for level in 0..level_count {
            let next = match level {
                0 => mssm.above(&samples, 1),
                _ => mssm.above(&mssm.levels[level as usize - 1], 1 << (level - 1)),
            };
            mssm.levels.push(match bits {
                16 => next.into_iter().map(in_16_bits).collect(),
                _ => next,
            });
        }
        mssm
    }

    /// Bounds over each texel of `below` and its neighbours at `offset` along x, along y and along both.
    fn above(&self, below: &[[f32; 2]], offset: i32) -> Vec<[f32; 2]> {
        let texels = (0..self.size).flat_map(|y| (0..self.size).map(move |x| (x, y)));
        texels
            .map(|(x, y)| {
                [(0, 0), (offset, 0), (0, offset), (offset, offset)]
                    .map(|(dx, dy)| self.texel(below, x + dx, y + dy))
                    .into_iter()
                    .fold(NOTHING, joined)
            })
            .collect()
    }

    fn texel(&self, level: &[[f32; 2]], x: i32, y: i32) -> [f32; 2] {
        if x >= self.size || y >= self.size {
            return [0.0; 2];
        }
        level[(y * self.size + x) as usize]
    }

    /// (min, max) of each texel of a level, row by row.
    pub fn level(&self, level: usize) -> &[[f32; 2]] {
        &self.levels[level]
    }

    /// Depth bounds over the cells first … last, inclusive and inside the map, from squares of one level
    /// that overlap. They may reach beyond `last` where the sides differ by more than a factor of 8 or
    /// the level that fits is not built.
    pub fn query(&self, first: [i32; 2], last: [i32; 2]) -> [f32; 2] {
        let side = [0, 1].map(|axis| last[axis] - first[axis] + 1);
        let fitting = side[0].min(side[1]).ilog2() as i32;
        let level = fitting.max(level_covering(side[0].max(side[1])) - 3);
        let level = level.min(self.levels.len() as i32 - 1);
        let step = 1 << level;
        // The last square ends at the last cell, unless it is larger than the whole side.
        let starts = |axis: usize| {
            let end = (last[axis] - step + 1).max(first[axis]);
            (first[axis]..=last[axis])
                .step_by(step as usize)
                .map(move |start| start.min(end))
        };
        let mut bounds = NOTHING;
        for y in starts(1) {
            for x in starts(0) {
                bounds = joined(bounds, self.texel(&self.levels[level as usize], x, y));
            }
        }
        bounds
    }
}

/// Bounds of no depth at all.
const NOTHING: [f32; 2] = [1e30, 0.0];

fn joined(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Bounds as 16-bit floats hold them, which contain the bounds given: the largest normal such float (or 0) that is
/// not above the lower, the smallest that is not below the upper. Twin of `mssm_16.comp`.
pub fn in_16_bits([lower, upper]: [f32; 2]) -> [f32; 2] {
    const DROPPED: u32 = 0x1fff;
    const SMALLEST: f32 = 1.0 / 16384.0;
    let below = match lower < SMALLEST {
        true => 0.0,
        false => f32::from_bits(lower.to_bits() & !DROPPED),
    };
    let above = f32::from_bits((upper.to_bits() + DROPPED) & !DROPPED);
    let above = match upper > 0.0 {
        true => above.max(SMALLEST),
        false => 0.0,
    };
    [below, above]
}

/// Lowest level whose nodes cover `side` cells.
fn level_covering(side: i32) -> i32 {
    (side as u32).next_power_of_two().ilog2() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: u32 = 21;

    fn depths() -> Vec<f32> {
        (0..SIZE * SIZE)
            .map(|i| (i.wrapping_mul(2_654_435_761) >> 8) as f32 / 16_777_216.0)
            .collect()
    }

    /// By the definition: over the cells' corner samples.
    fn bounds(depths: &[f32], first: [i32; 2], side: i32) -> [f32; 2] {
        let mut bounds = NOTHING;
        for y in first[1]..=first[1] + side {
            for x in first[0]..=first[0] + side {
                let inside = x < SIZE as i32 && y < SIZE as i32;
                let d = if inside {
                    depths[(y * SIZE as i32 + x) as usize]
                } else {
                    0.0
                };
                bounds = joined(bounds, [d, d]);
            }
        }
        bounds
    }

    #[test]
    fn every_texel_bounds_its_cells() {
        let depths = depths();
        let mssm = Mssm::new(SIZE, &depths, 6, 32);
        for level in 0..6 {
            for (i, &found) in mssm.level(level).iter().enumerate() {
                let first = [i as i32 % SIZE as i32, i as i32 / SIZE as i32];
                assert_eq!(found, bounds(&depths, first, 1 << level));
            }
        }
    }

    #[test]
    fn a_query_of_a_square_is_exact() {
        let depths = depths();
        let mssm = Mssm::new(SIZE, &depths, 6, 32);
        for side in 1..12 {
            let last = [4 + side - 1, 6 + side - 1];
            assert_eq!(mssm.query([4, 6], last), bounds(&depths, [4, 6], side));
        }
    }

    /// A normal 16-bit float in [0, 1], or 0.
    fn is_half(value: f32) -> bool {
        value == 0.0 || (1.0 / 16384.0..=1.0).contains(&value) && value.to_bits() & 0x1fff == 0
    }

    #[test]
    fn bounds_of_16_bits_contain_what_they_bound() {
        // All 16-bit floats in [0, 1], subnormal ones as well, with their neighbours in 32 bits; then a walk through
        // all 32-bit floats there in odd steps.
        let halves = (0..=0x3c00u32).map(|half| match half < 0x400 {
            true => half as f32 / 16_777_216.0,
            false => f32::from_bits((half << 13) + (112 << 23)),
        });
        let near =
            halves.flat_map(|half| [half.next_down().max(0.0), half, half.next_up().min(1.0)]);
        let walk = (0..=1f32.to_bits()).step_by(9973).map(f32::from_bits);
        for depth in near.chain(walk) {
            let [lower, upper] = in_16_bits([depth, depth]);
            assert!(lower <= depth && depth <= upper, "{lower} {depth} {upper}");
            assert!(is_half(lower) && is_half(upper), "{lower} {upper}");
            // No wider than one step of 16-bit floats, 11 significant bits.
            let step = f64::from(depth).max(1.0 / 16384.0) / 1024.0;
            assert!(f64::from(upper) - f64::from(lower) <= step || depth < 1.0 / 16384.0);
            assert_eq!(in_16_bits([lower, upper]), [lower, upper]);
        }
        assert_eq!(in_16_bits([0.0, 0.0]), [0.0, 0.0]);
    }
}
