//! The sizes of the shadow map and of the hierarchies over it, and how often a driver has to be asked to walk them.

use super::Plan;
use crate::error::{Error, Result};
use crate::gpu::Limits;
use crate::shared::{LEVELS_MAX, ROOT_LEVELS};
use crate::shot::Settings;

/// [level] Of an MSSM over a map of `side` × `side` texels, from single cells to the roots of the largest kernel.
pub(super) fn mssm_levels(side: u32) -> u32 {
    let covering = side.next_power_of_two().ilog2();
    (covering + 1).saturating_sub(ROOT_LEVELS).max(1)
}

impl Plan {
    pub(super) fn size_map(&mut self, settings: &Settings, limits: &Limits) -> Result<()> {
        if self.views().next().is_none() {
            return Ok(());
        }
        let side = settings.map;
        if side > limits.image_side {
            return Err(Error::Unsupported(format!(
                "a map of {side} texels is more than the device's {}; choose a smaller --map",
                limits.image_side
            )));
        }
        self.map = side;
        if self.needs(|recipe| recipe.mssm) {
            let level_bytes = u64::from(side) * u64::from(side) * self.mssm_texel_bytes();
            let fitting = (limits.image_bytes / level_bytes).min(limits.image_layers.into());
            self.levels = mssm_levels(side).min(LEVELS_MAX).min(fitting as u32);
            if self.levels == 0 {
                return Err(Error::Unsupported(format!(
                    "an MSSM level of {level_bytes} bytes is more than the device's largest image of {} bytes; \
                     choose a smaller --map",
                    limits.image_bytes
                )));
            }
        }
        let levels = self.levels;
        for view in self.views_mut() {
            view.view.levels_max = levels.max(1);
        }
        Ok(())
    }

    /// [byte] Of a pair of bounds.
    pub(crate) fn mssm_texel_bytes(&self) -> u64 {
        u64::from(self.mssm_bits / 4)
    }

    /// [level] Of the hierarchical shadow map, from 2×2 texels to a single node.
    pub fn hsm_levels(&self) -> u32 {
        self.map.next_power_of_two().ilog2()
    }

    /// [dispatch] In how many rounds a list is worked off at most.
    pub fn rounds(&self) -> u32 {
        let per_cell = self
            .sets()
            .map(|set| set.recipe.turns * set.recipe.layers.max(1))
            .max();
        let turns = u64::from(self.map) * u64::from(self.map) * u64::from(per_cell.unwrap_or(0));
        turns
            .div_ceil(self.loop_turns.into())
            .clamp(1, u32::MAX.into()) as u32
    }
}
