//! The sizes of the shadow map and of the hierarchies over it, and how often a driver has to be asked to walk them.

use super::Plan;
use super::light::Draft;
use crate::error::{Error, Result};
use crate::frame::{Density, Shape, map::hierarchy_shape};
use crate::gpu::Limits;
use crate::shared::{LEVELS_MAX, ROOT_LEVELS};
use crate::technique::{Hierarchy, Settings};

/// [level] Of a hierarchy over a map of `side` × `side` texels, from single cells to the roots of the largest kernel.
pub(super) fn hierarchy_levels(side: u32) -> u32 {
    let covering = side.next_power_of_two().ilog2();
    (covering + 1).saturating_sub(ROOT_LEVELS).max(1)
}

/// Whether a device has images like that.
pub(super) fn fits(shape: Shape, limits: &Limits) -> bool {
    match shape {
        Shape::Buffer(bytes) => bytes <= limits.buffer_bytes,
        Shape::Image { size, layers, .. } => {
            size.0.max(size.1) <= limits.image_side
                && layers <= limits.image_layers
                && shape.bytes() <= limits.image_bytes
        }
    }
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
        if sets.any(|set| set.recipe.kernels) {
            self.fit_hierarchy(limits)?;
        }
        Ok(())
    }

    /// Finds a density and a number of levels that the device has room for: as dense as asked for, or else with nodes side by
    /// side.
    fn fit_hierarchy(&mut self, limits: &Limits) -> Result<()> {
        let wanted = hierarchy_levels(self.map).min(LEVELS_MAX);
        let shape = |density, levels| hierarchy_shape(density, self.map, levels, self.bounds_bits);
        let fitting = |density| {
            let all = (1..=wanted).rev();
            all.map(move |levels| (levels, density))
                .find(|&(levels, density)| fits(shape(density, levels), limits))
        };
        let [asked, sparser] = [self.density, Density::HSM].map(fitting);
        let found = match (asked, sparser) {
            (Some((levels, _)), Some((most, _))) if levels < most => sparser,
            (None, sparser) => sparser,
            (asked, _) => asked,
        };
        let bytes = shape(self.density, 1).bytes();
        (self.levels, self.density) = found.ok_or_else(|| {
            Error::Unsupported(format!(
                "a hierarchy level of {bytes} bytes is more than the device's largest image of {} bytes; \
                 choose a smaller --map",
                limits.image_bytes
            ))
        })?;
        Ok(())
    }

    /// How densely it stands: as asked for, or else with nodes side by side.
    pub(super) fn hierarchy(&self, settings: &Settings) -> Hierarchy {
        match settings.hierarchy.density(self.map) == self.density {
            true => settings.hierarchy,
            false => Hierarchy::Hsm,
        }
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
