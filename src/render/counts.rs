//! What the device counts, by name.

use std::collections::BTreeMap;

use crate::shared::Counters;

impl Counters {
    /// What was counted since `before`. Narrow counters may have wrapped around once in between.
    pub fn since(&self, before: &Self) -> BTreeMap<&'static str, u64> {
        let wide = |count: [u32; 2]| u64::from(count[0]) | u64::from(count[1]) << 32;
        let narrow = |after: u32, before: u32| u64::from(after.wrapping_sub(before));
        let broad = |after, before| wide(after).wrapping_sub(wide(before));
        BTreeMap::from([
            ("pixels", narrow(self.pixels, before.pixels)),
            ("lit", narrow(self.lit, before.lit)),
            ("umbra", narrow(self.umbra, before.umbra)),
            ("penumbra", narrow(self.penumbra, before.penumbra)),
            ("packets", narrow(self.packets, before.packets)),
            (
                "coherent_packets",
                narrow(self.coherent_packets, before.coherent_packets),
            ),
            (
                "reprocessed_packets",
                narrow(self.reprocessed_packets, before.reprocessed_packets),
            ),
            (
                "nodes_visited",
                broad(self.nodes_visited, before.nodes_visited),
            ),
            (
                "edges_extracted",
                broad(self.edges_extracted, before.edges_extracted),
            ),
            (
                "samples_read",
                broad(self.samples_read, before.samples_read),
            ),
            (
                "coarse_levels",
                narrow(self.coarse_levels, before.coarse_levels),
            ),
        ])
    }
}
