//! The sizes of the shadow map and of the hierarchies over it, and how often a driver has to be asked to walk them.

use super::Plan;
use super::light::Draft;
use crate::error::{Error, Result};
use crate::gpu::Limits;
use crate::shared::{LEVELS_MAX, ROOT_LEVELS};
use crate::technique::Settings;

/// [level] Of an MSSM over a map of `side` × `side` texels, from single cells to the roots of the largest kernel.
pub(super) fn mssm_levels(side: u32) -> u32 {
    let covering = side.next_power_of_two().ilog2();
    (covering + 1).saturating_sub(ROOT_LEVELS).max(1)
}

impl Plan {
    pub(super) fn size_map(
        &mut self,
        drafts: &[Draft],
        settings: &Settings,
        limits: &Limits,
    ) -> Result<()> {
        let mut sets = drafts.iter().flat_map(Draft::sets).peekable();
        if sets.peek().is_none() {
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
        if sets.any(|set| set.recipe.mssm) {
            self.levels = self.fitting_levels(limits)?;
        }
        Ok(())
    }

    /// [level] Of the MSSM that the device has room for.
    fn fitting_levels(&self, limits: &Limits) -> Result<u32> {
        let side = self.map;
        let level_bytes = u64::from(side) * u64::from(side) * self.mssm_texel_bytes();
        let fitting = (limits.image_bytes / level_bytes).min(limits.image_layers.into());
        match mssm_levels(side).min(LEVELS_MAX).min(fitting as u32) {
            0 => Err(Error::Unsupported(format!(
                "an MSSM level of {level_bytes} bytes is more than the device's largest image of {} bytes; \
                 choose a smaller --map",
                limits.image_bytes
            ))),
            levels => Ok(levels),
        }
    }

    /// [byte] Of a pair of bounds.
    fn mssm_texel_bytes(&self) -> u64 {
        u64::from(self.mssm_bits / 4)
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
