//! What will run, in which sizes, and what is left out and why: a pure function of the shot, of what is
//! asked for and of the device's limits. What is recorded equals what is planned.

mod budget;
mod camera;
mod clip;
mod graph;
mod host;
mod light;
mod maps;
mod memory;
mod notes;
mod omissions;
mod patches;
mod side_by_side;
mod survey;
mod text;
mod views;

use crate::error::Result;
use crate::frame::{Casters, Density, Front, Graph, Inventory};
use crate::gpu::Limits;
use crate::shared;
use crate::shot::Shot;
use crate::technique::Settings;
use crate::technique::{self, Recipe};
use camera::Frustum;
use light::{Draft, Numbering, Placed};
use survey::{LightCoverage, survey};

pub use budget::Budget;
pub use host::{HostFrame, plan_for_host};
pub use light::{LightPlan, Lighting, ViewPlan, ViewSet};
pub use memory::PlannedResource;
pub use notes::shines_along;
pub use views::{MapParams, ViewPose, suited_exposure};

/// What the caller wants to have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outputs {
    /// The shaded picture.
    pub picture: bool,
}

/// A frame, completely.
#[derive(Debug, Clone)]
pub struct Plan {
    pub front: Front,
    pub casters: Casters,
    /// [pixel]
    pub size: (u32, u32),
    pub frame: shared::Frame,
    pub lights: Vec<LightPlan>,
    pub outputs: Outputs,
    /// [level] Of the hierarchy over the map that there is memory for; 0 = no hierarchy.
    pub levels: u32,
    /// [bit] 16 or 32, of a bound in it.
    pub bounds_bits: u32,
    /// How densely its nodes stand.
    pub density: Density,
    /// [texel] Side of the shadow map; 0 = no view needs one.
    pub map: u32,
    /// Views of a set whose maps are made side by side, at most.
    pub views_at_once: u32,
    /// [turn] After which the driver ends loops.
    pub loop_turns: u32,
    /// [pixel] Width and height of a packet.
    pub packet: (u32, u32),
    pub budget: Budget,
    /// Pixels have several samples, for the picture.
    pub multisampled: bool,
    /// Such a sample may take the visibility of a neighbour.
    pub neighbour_visibility: bool,
    /// The scene has textures that the frame needs.
    pub textured: bool,
    /// Its vertices have colours that the frame needs.
    pub colored: bool,
    /// The scene has alpha-masked triangles.
    pub masked: bool,
    /// The camera's rays are parallel.
    pub orthographic: bool,
    /// Some of its triangles cast no shadows.
    pub tells_casters: bool,
    /// All passes of a frame that draws every map.
    pub graph: Graph,
    /// The shadow map of the last frame's last view is kept, and the passes that made it are left out.
    pub retained: bool,
    pub resources: Vec<PlannedResource>,
    /// What is left out, and why.
    pub omissions: Vec<Omission>,
    /// What will not be as it was asked for, a sentence each.
    pub notes: Vec<String>,
}

/// Something that a scene of another kind would need.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Omission {
    pub what: String,
    pub reason: String,
}

/// Plans a frame.
///
/// # Errors
/// The shot makes no sense, or exceeds the device's limits; the message says which knob to turn.
pub fn plan(shot: &Shot, outputs: Outputs, limits: &Limits) -> Result<Plan> {
    shot.validate()?;
    let frustum = Frustum::new(shot);
    let mut plan = Plan {
        textured: reads_textures(shot, outputs),
        colored: reads_colors(shot, outputs) && !shot.scene.colors.is_empty(),
        multisampled: outputs.picture && shot.settings.multisample > 1,
        budget: Budget {
            mapped: shot.budget_map.is_some(),
            ..Budget::new(&shot.settings)
        },
        masked: shot.scene.has_masked(),
        tells_casters: shot.scene.tells_casters(),
        orthographic: frustum.orthographic,
        ..Plan::empty(
            (shot.width, shot.height),
            frustum.frame(shot),
            outputs,
            &shot.settings,
            limits,
        )
    };
    let cover = |light| {
        let parts = technique::parts(light, &shot.settings.of_light(light));
        let placed = Placed::of_shot(shot, light);
        let look = |side: &_| survey(shot, &frustum, side, &parts, placed.touch);
        let sides = light.sides(&placed.ball);
        let found: Vec<LightCoverage> = sides.iter().map(look).collect();
        (Draft::new(&shot.settings, placed, parts, &found), found)
    };
    let (drafts, found): (Vec<_>, Vec<_>) = shot.lights.iter().map(cover).unzip();
    let inventory = Inventory::of(&shot.scene);
    plan.add_lights(drafts, &shot.settings, &inventory, limits)?;
    plan.note_lights(shot, &found);
    plan.list_resources(&inventory);
    plan.list_omissions(shot);
    plan.check(limits)?;
    Ok(plan)
}

/// Whether the frame needs the scene's textures: for the picture, for holes, or for what hides shadows.
fn reads_textures(shot: &Shot, outputs: Outputs) -> bool {
    let wanted = reads_colors(shot, outputs) || shot.scene.has_masked();
    wanted && !shot.scene.textures.is_empty()
}

/// Whether the colours of surfaces matter.
fn reads_colors(shot: &Shot, outputs: Outputs) -> bool {
    let masks_budgets = shot.settings.budget_masking < 1.0 && shot.settings.budget.is_some();
    outputs.picture || masks_budgets
}

impl Plan {
    /// The same frame where the shadow map of the last frame's last view is still there and nothing that it depends on
    /// has changed since: scene, camera, lights, map size and bias. Several views share a map, which then is drawn anew.
    #[must_use]
    pub fn retaining(&self) -> Self {
        let mut plan = self.clone();
        plan.retained = self.views().count() == 1;
        if plan.retained {
            plan.omit_lasting();
        }
        plan
    }

    /// [half sizes] Of the lights that are polygons, one after the other.
    pub fn corners(&self) -> Vec<[f32; 2]> {
        let corners = self.lights.iter().flat_map(|light| light.outline.corners());
        corners.map(|corner| corner.as_vec2().into()).collect()
    }

    pub fn views(&self) -> impl Iterator<Item = &ViewPlan> {
        self.lights.iter().flat_map(LightPlan::views)
    }

    /// The sets of views of all lights.
    pub(crate) fn sets(&self) -> impl Iterator<Item = &ViewSet> {
        self.lights.iter().flat_map(|light| &light.sets)
    }

    /// [sub-light] Of all lights, that points stand for.
    pub fn near_count(&self) -> usize {
        self.lights.iter().map(|light| light.near_count).sum()
    }

    fn views_mut(&mut self) -> impl Iterator<Item = &mut ViewPlan> {
        let sets = self.lights.iter_mut().flat_map(|light| &mut light.sets);
        sets.flat_map(|set| &mut set.views)
    }

    /// Sizes the maps for the lights, gives them their views, and puts their passes in order.
    fn add_lights(
        &mut self,
        drafts: Vec<Draft>,
        settings: &Settings,
        inventory: &Inventory,
        limits: &Limits,
    ) -> Result<()> {
        self.size_map(&drafts, settings, limits)?;
        let mut numbering = Numbering::default();
        for (index, draft) in drafts.into_iter().enumerate() {
            let light = draft.finish(index, self.levels, &mut numbering);
            self.lights.push(light);
        }
        if self.loop_turns == Limits::ENDLESS_LOOPS {
            let sets = self.lights.iter_mut().flat_map(|light| &mut light.sets);
            sets.for_each(|set| set.recipe.passes.retain(|(pass, _)| !pass.leftovers));
        }
        self.choose_views_at_once(settings, inventory, limits);
        self.graph = self.ordered();
        Ok(())
    }

    /// A plan of a drawn scene, without lights yet.
    fn empty(
        size: (u32, u32),
        frame: shared::Frame,
        outputs: Outputs,
        settings: &Settings,
        limits: &Limits,
    ) -> Self {
        Self {
            front: Front::Drawn,
            casters: Casters::Scene,
            size,
            frame,
            lights: Vec::new(),
            outputs,
            levels: 0,
            bounds_bits: settings.mssm_bits,
            density: settings.hierarchy.density(settings.map),
            map: 0,
            views_at_once: 1,
            loop_turns: limits.loop_turns,
            packet: settings.window(),
            budget: Budget::new(settings),
            multisampled: false,
            neighbour_visibility: settings.neighbour_visibility,
            textured: false,
            colored: false,
            masked: false,
            orthographic: false,
            tells_casters: false,
            graph: Graph::default(),
            retained: false,
            resources: Vec::new(),
            omissions: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// Whether some light's views need something of their recipe.
    pub fn needs(&self, test: impl Fn(&Recipe) -> bool) -> bool {
        self.sets().any(|set| test(&set.recipe))
    }
}
