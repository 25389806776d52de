//! How many views have their maps made side by side: receivers, casters, projections and hierarchies of all of them in one dispatch
//! each. On a device with thousands of lanes a view alone fills few, and each dispatch waits for the one before.

use super::Plan;
use super::light::Draft;
use super::maps::fits;
use crate::frame::map::{self, CASTER_BYTES};
use crate::frame::{Inventory, Shape};
use crate::gpu::Limits;
use crate::technique::Settings;

/// [byte] That maps side by side take by default, beside the first.
const BYTES_MAX: u64 = 64 << 20;

impl Plan {
    /// As many as asked for, or as are fastest; shared out evenly among the dispatches of the largest set.
    pub(super) fn choose_views_at_once(
        &mut self,
        drafts: &[Draft],
        settings: &Settings,
        triangles: u64,
        limits: &Limits,
    ) {
        let sets = || drafts.iter().flat_map(Draft::sets);
        let views = sets().map(|set| set.view_count()).max().unwrap_or(1);
        let map = map::map_shape(self.map);
        let hierarchy = map::hierarchy_shape(self.density, self.map, self.levels, self.bounds_bits);
        let casters = Shape::Buffer(triangles * CASTER_BYTES);
        let slot = map.bytes() + hierarchy.bytes() + casters.bytes();
        let mut most = views.min(settings.views_at_once.unwrap_or(by_default(slot, limits)));
        if most > 1 && sets().any(|set| set.recipe.layers > 0) {
            most = 1;
            if settings.views_at_once.is_some() {
                let note = "layers are peeled in the map itself: views are made one after another, whatever --views-at-once says";
                self.notes.push(note.into());
            }
        }
        let there_is_room = |&count: &u32| {
            let shapes = [map, hierarchy, casters];
            shapes.iter().all(|shape| fits(shape.times(count), limits))
        };
        let most = (1..=most).rev().find(there_is_room).unwrap_or(1);
        self.views_at_once = views.div_ceil(views.div_ceil(most));
    }

    /// Lists the resources of the frame: where it would be too large with maps side by side that nobody asked for, without.
    pub(super) fn size_resources(
        &mut self,
        inventory: &Inventory,
        settings: &Settings,
        limits: &Limits,
    ) {
        self.list_resources(inventory);
        let by_default = settings.views_at_once.is_none() && self.views_at_once > 1;
        if by_default && self.peak_bytes() > limits.bytes_max() {
            self.views_at_once = 1;
            self.graph = self.ordered();
            self.list_resources(inventory);
        }
    }
}

/// `slot`: [byte] for a view. On a CPU a dispatch costs next to nothing, and its caches hold the maps of one view: it takes 5 to 10 %
/// more time for several.
fn by_default(slot: u64, limits: &Limits) -> u32 {
    match limits.is_cpu {
        true => 1,
        false => 1 + (BYTES_MAX / slot.max(1)) as u32,
    }
}
