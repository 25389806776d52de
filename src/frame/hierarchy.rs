//! The hierarchy over a shadow map [SS07, DU07, Schwarz08 §6, Yang09 §4.2; algorithm.md §4]: where its nodes stand, and how
//! they lie in an image. As `lib/hierarchy_layout.glsl` has it.

use crate::shared::LEVELS_MAX;

/// How densely the nodes of each level stand. A node of level l bounds 2^l × 2^l cells and begins at a multiple of the
/// level's spacing, which is 1 up to a dense level and doubles with every level from there on, up to the sparsest. Level 0 is
/// single cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Density {
    /// [level] The last whose nodes stand at every cell.
    pub dense: u32,
    /// [log2 cell] The largest spacing.
    pub sparsest: u32,
}

impl Density {
    /// A node at every cell, in every level: the multi-scale shadow map [SS07; Yang09 §4.2].
    pub const MSSM: Self = Self {
        dense: 0,
        sparsest: 0,
    };
    /// Nodes side by side: the hierarchical shadow map [DU07].
    pub const HSM: Self = Self::graded(0);

    /// Nodes that overlap by all but a 2^`dense`th of their side.
    pub const fn graded(dense: u32) -> Self {
        Self {
            dense,
            sparsest: LEVELS_MAX,
        }
    }

    /// Side by side up to where 2^`sparsest` cells are a step, at each of these steps from there on: the Y shadow map
    /// [Schwarz08 §6].
    pub const fn ysm(sparsest: u32) -> Self {
        Self { dense: 0, sparsest }
    }

    /// [log2 cell] How far apart a level's nodes stand.
    pub const fn spacing_log2(self, level: u32) -> u32 {
        let sparse = level.saturating_sub(self.dense);
        match sparse < self.sparsest {
            true => sparse,
            false => self.sparsest,
        }
    }

    /// [cell] Side of what a hierarchy of levels below `levels` covers over a map of `map` × `map` texels.
    pub const fn covered_side(self, map: u32, levels: u32) -> u32 {
        map.next_multiple_of(1 << self.spacing_log2(levels - 1))
    }

    /// [node] Of a level, along a side.
    pub const fn nodes_along(self, map: u32, levels: u32, level: u32) -> u32 {
        self.covered_side(map, levels) >> self.spacing_log2(level)
    }

    /// [texel] Width, height and layers of the image that holds the levels below `levels`: dense levels below one another,
    /// then, side by side, those of ever larger spacing. Where all are dense, each has a layer. All 0 without levels.
    pub fn extent(self, map: u32, levels: u32) -> (u32, u32, u32) {
        if levels == 0 {
            return (0, 0, 0);
        }
        let side = self.covered_side(map, levels);
        if self.sparsest == 0 {
            return (side, side, levels);
        }
        let of_spacing = |spacing: u32| {
            let all = 0..levels;
            all.filter(|&level| self.spacing_log2(level) == spacing)
                .count() as u32
        };
        let sparser = of_spacing(1).min(1) * side / 2;
        // Those that are as sparse as any, but for the first, in rows of them.
        let further = of_spacing(self.sparsest).saturating_sub(1);
        let rows = further.div_ceil(1 << self.sparsest) * (side >> self.sparsest);
        (side, of_spacing(0) * side + sparser + rows, 1)
    }

    /// [texel] Where a level's nodes begin in that image, row by row: left, top, layer.
    pub fn origin(self, map: u32, levels: u32, level: u32) -> (u32, u32, u32) {
        let side = self.covered_side(map, levels);
        let spacing = self.spacing_log2(level);
        if self.sparsest == 0 {
            return (0, 0, level);
        }
        if spacing == 0 {
            return (0, level * side, 0);
        }
        let top = (self.dense + 1) * side;
        match level.checked_sub(self.dense + self.sparsest + 1) {
            None => (side - ((2 * side) >> spacing), top, 0),
            Some(further) => {
                let (along, step) = (1 << self.sparsest, side >> self.sparsest);
                let (column, row) = (further % along, further / along);
                (column * step, top + side / 2 + row * step, 0)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_holds_all_levels_and_little_else() {
        let extent = |density: Density| density.extent(1024, 9);
        assert_eq!(extent(Density::MSSM), (1024, 1024, 9));
        assert_eq!(extent(Density::HSM), (1024, 1024 + 512, 1));
        assert_eq!(extent(Density::graded(1)), (1024, 2 * 1024 + 512, 1));
        assert_eq!(extent(Density::graded(2)), (1024, 3 * 1024 + 512, 1));
        // Levels 0 to 2, then six more as sparse as level 2, four in a row.
        assert_eq!(extent(Density::ysm(2)), (1024, 1024 + 512 + 2 * 256, 1));
    }

    #[test]
    fn levels_lie_beside_one_another_inside_the_image() {
        let densities = [
            Density::HSM,
            Density::ysm(1),
            Density::ysm(2),
            Density::graded(1),
            Density::graded(2),
            Density::MSSM,
        ];
        for (density, map) in densities
            .into_iter()
            .flat_map(|d| [64, 100, 256].map(|m| (d, m)))
        {
            let levels = 6;
            let (width, height, layers) = density.extent(map, levels);
            let mut taken = vec![false; (width * height * layers) as usize];
            for level in 0..levels {
                let along = density.nodes_along(map, levels, level);
                let (left, top, layer) = density.origin(map, levels, level);
                assert!(left + along <= width && top + along <= height && layer < layers);
                for i in 0..along * along {
                    let (x, y) = (left + i % along, top + i / along);
                    let texel = &mut taken[((layer * height + y) * width + x) as usize];
                    assert!(!*texel, "{density:?}, level {level}");
                    *texel = true;
                }
            }
        }
    }

    #[test]
    fn what_is_covered_is_a_whole_number_of_the_largest_steps() {
        assert_eq!(Density::HSM.covered_side(1000, 8), 1024);
        assert_eq!(Density::HSM.nodes_along(1000, 8, 7), 8);
        assert_eq!(Density::graded(2).covered_side(520, 9), 576);
        assert_eq!(Density::MSSM.covered_side(520, 9), 520);
    }
}
