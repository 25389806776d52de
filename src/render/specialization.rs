//! Specialization constants: `glsl/lib/constants.glsl` on the host's side.

use crate::gpu::Specialization;
use crate::plan::{Casters, Plan, Variant, ViewSet};
use crate::shot::{Leaf, Mapping, Pattern, Technique};
use crate::technique::Work;

/// Constants of the passes of a view.
pub fn of_view(plan: &Plan, set: &ViewSet, variant: Variant, work: Work) -> Specialization {
    let settings = &set.settings;
    // Whoever walks the pixel list has packets of one pixel; so have techniques without packets.
    let packets = settings.technique == Technique::PacketContour && work != Work::PixelList;
    let packet = if packets { settings.packet } else { (1, 1) };
    let lanes = packets && settings.mapping == Mapping::Lanes;
    let footprint = settings.footprint_pruning && settings.technique == Technique::PacketContour;
    let held = if lanes { 1 } else { packet.0 * packet.1 };
    let gap_filling = settings.gap_filling && settings.technique != Technique::DepthPeeling;
    let filter_reach = settings.technique == Technique::Hard && settings.percentage_closer;
    vec![
        (0, packet.0),
        (1, packet.1),
        (2, u32::from(settings.leaf == Leaf::Reprocess)),
        (3, u32::from(lanes)),
        (4, u32::from(footprint)),
        (5, u32::from(variant.round)),
        (6, u32::from(variant.oblique)),
        (7, u32::from(settings.counters)),
        (8, u32::from(variant.accumulate)),
        (9, u32::from(plan.textured)),
        (10, held),
        (11, plan.loop_turns),
        (12, plan.rounds()),
        (13, set.recipe.layers.max(1)),
        (15, u32::from(gap_filling)),
        (16, u32::from(settings.has_contours())),
        (17, settings.light_samples),
        (18, u32::from(settings.pattern == Pattern::Jittered)),
        (19, settings.blocker_samples),
        (20, settings.filter_samples),
        (21, u32::from(filter_reach)),
        (23, u32::from(plan.casters == Casters::Maps)),
        (25, u32::from(plan.casters == Casters::Scene)),
    ]
}

/// Constants of a draw of casters; `peel`: behind the layers that are kept already.
pub fn of_casters(base: &Specialization, masked: bool, peel: bool) -> Specialization {
    let mut constants = base.clone();
    constants.extend([(14, u32::from(peel)), (22, u32::from(masked))]);
    constants
}

/// Constants of passes that no view's variant matters to.
pub fn of_frame(plan: &Plan) -> Specialization {
    vec![(9, u32::from(plan.textured))]
}

/// Constants of the pass that reads a host's surface: positions, or else depths.
pub fn of_import(positions: bool) -> Specialization {
    vec![(24, u32::from(positions))]
}
