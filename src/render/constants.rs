//! The values of specialization constants, by the names that shaders give them.

use crate::frame::{Casters, Pass};
use crate::gpu::Constants;
use crate::plan::{LightPlan, Plan, ViewPlan, ViewSet};
use crate::shot::{Leaf, Mapping, Pattern, Settings, Technique};

/// What all passes of a frame have in common.
pub fn of_frame(plan: &Plan) -> Constants {
    Constants::from([
        ("TEXTURED", plan.textured.into()),
        ("STEPS_MAX", plan.loop_turns),
        ("ROUNDS", plan.rounds()),
        ("GIVEN", (plan.casters == Casters::Maps).into()),
        ("RESIDUALS", (plan.casters == Casters::Scene).into()),
    ])
}

/// What the passes of a view have beside them.
pub fn of_view(light: &LightPlan, set: &ViewSet, view: &ViewPlan) -> Constants {
    let mut constants = of_technique(&set.settings);
    constants.extend([
        ("ROUND", u32::from(view.is_round())),
        ("OBLIQUE", view.oblique.into()),
        ("ACCUMULATE", light.accumulates().into()),
        ("COUNT", set.settings.counters.into()),
        ("LAYERS", set.recipe.layers.max(1)),
    ]);
    constants
}

/// Those with the pass's own.
pub fn of_pass(pass: &Pass, mut constants: Constants) -> Constants {
    constants.extend(pass.constants.iter().copied());
    constants
}

fn of_technique(settings: &Settings) -> Constants {
    let packets = settings.technique == Technique::PacketContour;
    let packet = if packets { settings.packet } else { (1, 1) };
    let lanes = packets && settings.mapping == Mapping::Lanes;
    let footprint = settings.footprint_pruning && packets;
    let held = if lanes { 1 } else { packet.0 * packet.1 };
    let gap_filling = settings.gap_filling && settings.technique != Technique::DepthPeeling;
    let filter_reach = settings.technique == Technique::Hard && settings.percentage_closer;
    Constants::from([
        ("PACKET_WIDTH", packet.0),
        ("PACKET_HEIGHT", packet.1),
        ("REPROCESS", (settings.leaf == Leaf::Reprocess).into()),
        ("LANES", lanes.into()),
        ("FOOTPRINT", footprint.into()),
        ("HELD", held),
        ("GAP_FILLING", gap_filling.into()),
        ("CONTOURS", settings.has_contours().into()),
        ("LIGHT_SAMPLES", settings.light_samples),
        ("JITTERED", (settings.pattern == Pattern::Jittered).into()),
        ("BLOCKER_SAMPLES", settings.blocker_samples),
        ("FILTER_SAMPLES", settings.filter_samples),
        ("FILTER_REACH", filter_reach.into()),
    ])
}
