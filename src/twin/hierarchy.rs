//! The hierarchy over a shadow map [SS07, Yang09 §4.2; algorithm.md §4]: twin of `hierarchy.comp` and of
//! `lib/hierarchy.glsl`.

use super::contour::ShadowMap;
use crate::frame::Density;

/// A node of level l from cell (x, y) on: least and largest depth over the dual cells [x, x + 2^l) × [y, y + 2^l). What lies
/// beyond the map is empty: depth 0.
pub struct Hierarchy<'a> {
    map: ShadowMap<'a>,
    density: Density,
    /// [level] That of single cells included.
    level_count: u32,
    /// Row by row.
    levels: Vec<Vec<[f32; 2]>>,
}

impl<'a> Hierarchy<'a> {
    /// With levels below `level_count` of at most `levels_max`, on which depends what is covered; bounds of 32 or 16 bits.
    pub fn new(
        map: ShadowMap<'a>,
        density: Density,
        level_count: u32,
        levels_max: u32,
        bits: u32,
    ) -> Self {
        let mut hierarchy = Self {
            map,
            density,
            level_count,
            levels: Vec::new(),
        };
        for level in 0..level_count {
            let along = density.nodes_along(map.size as u32, levels_max, level) as i32;
            let spacing = 1 << density.spacing_log2(level);
            let nodes =
                (0..along).flat_map(|y| (0..along).map(move |x| [x * spacing, y * spacing]));
            let bounds = nodes.map(|cell| match (hierarchy.built(cell, level), bits) {
                (bounds, 16) => in_16_bits(bounds),
                (bounds, _) => bounds,
            });
            let bounds = bounds.collect();
            hierarchy.levels.push(bounds);
        }
        hierarchy
    }

    /// Bounds of a node from samples, or from the 2×2 nodes of the level below.
    fn built(&self, [x, y]: [i32; 2], level: u32) -> [f32; 2] {
        if level < 2 {
            let side = 1 << level;
            return self.of_samples([x, y], [x + side, y + side]);
        }
        let half = 1 << (level - 1);
        [[x, y], [x + half, y], [x, y + half], [x + half, y + half]]
            .map(|cell| self.node(cell, level - 1))
            .into_iter()
            .fold(NOTHING, joined)
    }

    /// Bounds of the samples of a box, its borders included.
    fn of_samples(&self, first: [i32; 2], last: [i32; 2]) -> [f32; 2] {
        let all = (first[1]..=last[1]).flat_map(|y| (first[0]..=last[0]).map(move |x| [x, y]));
        all.map(|[x, y]| match x < self.map.size && y < self.map.size {
            true => [self.map.depths[(y * self.map.size + x) as usize]; 2],
            false => [0.0; 2],
        })
        .fold(NOTHING, joined)
    }

    /// The node of a level that begins at `cell`.
    fn node(&self, cell: [i32; 2], level: u32) -> [f32; 2] {
        let nodes = &self.levels[level as usize];
        let along = nodes.len().isqrt();
        let [x, y] = cell.map(|i| (i >> self.density.spacing_log2(level)) as usize);
        match x < along && y < along {
            true => nodes[y * along + x],
            false => [0.0; 2],
        }
    }

    /// (min, max) of each node of a level, row by row.
    pub fn level(&self, level: u32) -> &[[f32; 2]] {
        &self.levels[level as usize]
    }

    /// Whether nodes stand less densely than cells in some level, so that queries may reach beyond what they ask for.
    pub fn is_sparse(&self) -> bool {
        self.density.sparsest > 0
    }

    /// Depth bounds over the cells first … last, inclusive and inside the map, from nodes of one level that cover them and
    /// may overlap: `finer` levels below the one whose nodes are as large. They reach beyond the box by less than the level's
    /// spacing on each side, and farther only where its sides differ by more than a factor of 8 or the level is not built.
    pub fn query(&self, first: [i32; 2], last: [i32; 2], finer: u32) -> [f32; 2] {
        let side = [0, 1].map(|axis| last[axis] - first[axis] + 1);
        let level = query_level(side, self.level_count, finer);
        let (step, spacing) = (1 << level, 1 << self.density.spacing_log2(level));
        let starts = |axis: usize| {
            let from = first[axis] / spacing * spacing;
            // The last node ends at the last cell or less than a spacing beyond it.
            let to = (last[axis] - step + spacing).div_euclid(spacing) * spacing;
            let to = to.max(from);
            (from..to).step_by(step as usize).chain(std::iter::once(to))
        };
        let all = starts(1).flat_map(|y| starts(0).map(move |x| [x, y]));
        all.map(|cell| self.node(cell, level)).fold(NOTHING, joined)
    }
}

/// The level of which a few nodes cover a box of cells, or `finer` levels below.
fn query_level(side: [i32; 2], level_count: u32, finer: u32) -> u32 {
    let fitting = side[0].min(side[1]).ilog2();
    let level = fitting.max(level_covering(side[0].max(side[1])).saturating_sub(3));
    level.saturating_sub(finer).min(level_count - 1)
}

/// Bounds of no depth at all.
const NOTHING: [f32; 2] = [1e30, 0.0];

fn joined(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Bounds as 16-bit floats hold them, which contain the bounds given: the largest normal such float (or 0) that is
/// not above the lower, the smallest that is not below the upper. Twin of `hierarchy.comp`.
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
fn level_covering(side: i32) -> u32 {
    (side as u32).next_power_of_two().ilog2()
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

    const DENSITIES: [Density; 5] = [
        Density::HSM,
        Density::ysm(1),
        Density::graded(1),
        Density::graded(2),
        Density::MSSM,
    ];

    fn hierarchy(depths: &[f32], density: Density) -> Hierarchy<'_> {
        let map = ShadowMap {
            size: SIZE as i32,
            depths,
        };
        Hierarchy::new(map, density, 6, 6, 32)
    }

    #[test]
    fn every_node_bounds_its_cells() {
        let depths = depths();
        for density in DENSITIES {
            let hierarchy = hierarchy(&depths, density);
            for level in 0..6 {
                let along = density.nodes_along(SIZE, 6, level) as usize;
                assert_eq!(hierarchy.level(level).len(), along * along);
                for (i, &found) in hierarchy.level(level).iter().enumerate() {
                    let spacing = 1 << density.spacing_log2(level);
                    let first = [i % along, i / along].map(|i| i as i32 * spacing);
                    assert_eq!(found, bounds(&depths, first, 1 << level));
                }
            }
        }
    }

    #[test]
    fn a_query_of_a_square_is_exact_where_nodes_stand_at_every_cell() {
        let depths = depths();
        let hierarchy = hierarchy(&depths, Density::MSSM);
        for side in 1..12 {
            let last = [4 + side - 1, 6 + side - 1];
            assert_eq!(
                hierarchy.query([4, 6], last, 0),
                bounds(&depths, [4, 6], side)
            );
        }
    }

    #[test]
    fn a_query_contains_what_it_asks_for_whatever_the_density() {
        let depths = depths();
        for density in DENSITIES {
            let hierarchy = hierarchy(&depths, density);
            let boxes = (0..20 * 20).map(|i| [i % 20, i / 20]);
            for first in boxes.clone() {
                for last in boxes
                    .clone()
                    .filter(|l| l[0] >= first[0] && l[1] >= first[1])
                {
                    let wanted = hierarchy.of_samples(first, last.map(|i| i + 1));
                    for finer in 0..2 {
                        let found = hierarchy.query(first, last, finer);
                        assert!(found[0] <= wanted[0] && found[1] >= wanted[1]);
                    }
                }
            }
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
