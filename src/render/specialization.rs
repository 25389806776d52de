//! Specialization constants: `glsl/lib/constants.glsl` on the host's side.

use crate::gpu::Specialization;
use crate::plan::{Plan, Variant};
use crate::shot::{Leaf, Mapping, Settings, Technique};
use crate::technique::Work;

/// Turns of loops that any driver allows an invocation: lavapipe ends all loops after 65535 in sum,
/// without a word. What is not finished by then is reported (`Fit::unfinished`).
const STEPS_MAX: u32 = 60000;

/// Constants of the passes of a view.
pub fn of_view(plan: &Plan, settings: &Settings, variant: Variant, work: Work) -> Specialization {
    // Whoever walks the pixel list has packets of one pixel; so have techniques without packets.
    let packets = settings.technique == Technique::PacketContour && work != Work::PixelList;
    let packet = if packets { settings.packet } else { (1, 1) };
    let lanes = packets && settings.mapping == Mapping::Lanes;
    let footprint = settings.footprint_pruning && settings.technique == Technique::PacketContour;
    let held = if lanes { 1 } else { packet.0 * packet.1 };
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
        (11, STEPS_MAX),
    ]
}

/// Constants of passes that no view's variant matters to.
pub fn of_frame(plan: &Plan) -> Specialization {
    vec![(9, u32::from(plan.textured))]
}
