//! The values of specialization constants, by the names that shaders give them.

use crate::frame::{Casters, Front, Pass};
use crate::gpu::Constants;
use crate::plan::{LightPlan, Plan, ViewPlan, ViewSet};
use crate::shared::ALL_CONES;
use crate::sub_light::Cut;

/// What all passes of a frame have in common.
pub fn of_frame(plan: &Plan) -> Constants {
    Constants::from([
        ("COLORED", plan.colored.into()),
        ("TEXTURED", plan.textured.into()),
        ("LOOP_BUDGET", plan.loop_turns),
        ("ROUNDS", plan.rounds()),
        (
            "GIVEN_SURFACE",
            matches!(plan.front, Front::Imported(_)).into(),
        ),
        ("POLYGONS", (!plan.corners().is_empty()).into()),
        ("ORTHOGRAPHIC", plan.orthographic.into()),
        ("DENSE_LEVELS", plan.density.dense),
        ("SPARSEST", plan.density.sparsest),
        ("VIEWS_AT_ONCE", plan.views_at_once),
        ("GIVEN_MAPS", (plan.casters == Casters::Maps).into()),
        ("RESIDUALS", (plan.casters == Casters::Scene).into()),
        ("TELLS_CASTERS", plan.tells_casters.into()),
        ("MULTISAMPLED", plan.multisampled.into()),
        ("NEIGHBOUR_VISIBILITY", plan.neighbour_visibility.into()),
        ("BUDGET", plan.budget.number.unwrap_or(0)),
        ("BUDGETS_VARY", plan.budgets_vary().into()),
        ("BUDGET_FALLOFF", plan.budget.falloff.to_bits()),
        ("BUDGET_MASKING", plan.budget.masking.to_bits()),
        ("BUDGET_MAPPED", plan.budget.mapped.into()),
    ])
}

/// What the passes of a view have beside them.
pub fn of_view(plan: &Plan, light: &LightPlan, set: &ViewSet, view: &ViewPlan) -> Constants {
    let mut constants: Constants = set.settings.constants().into_iter().collect();
    constants.extend([
        ("DISC_LIGHT", matches!(view.cut(), Cut::Rim { .. }).into()),
        ("EDGES", view.cut().edges().len() as u32),
        ("OBLIQUE", view.oblique.into()),
        ("PARALLEL", (view.view.parallel > 0.0).into()),
        ("BEAM", (view.view.beam != [0.0; 3]).into()),
        ("CONES", (view.view.cone != ALL_CONES).into()),
        ("ACCUMULATE", light.accumulates().into()),
        ("SIDE_BY_SIDE", plan.looks_side_by_side(&set.recipe).into()),
        ("LAYERS", set.recipe.layers.max(1)),
        ("COARSE_LEVELS", set.recipe.coarse_levels),
        ("EVALUATE", set.recipe.grids),
    ]);
    constants
}

/// Those with the pass's own.
pub fn of_pass(pass: &Pass, mut constants: Constants) -> Constants {
    constants.extend(pass.constants.iter().copied());
    constants
}

#[cfg(test)]
mod tests {
    use crate::gpu::is_constant;
    use crate::technique::{KNOBS, Technique};

    #[test]
    fn what_techniques_set_is_what_some_shader_uses() {
        let own = Technique::ALL
            .iter()
            .flat_map(|technique| technique.variants());
        let own = own.flat_map(|settings| settings.constants());
        let of_knobs = KNOBS.iter().filter_map(|knob| knob.row.constant);
        for name in own.map(|(name, _)| name).chain(of_knobs) {
            assert!(is_constant(name), "no shader uses {name}");
        }
    }
}
