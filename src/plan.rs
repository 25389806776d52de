//! What will run, in which sizes, and what is left out and why: a pure function of the shot, of what is
//! asked for and of the device's limits. What is recorded equals what is planned.

mod camera;
mod host;
mod maps;
mod memory;
mod omissions;
mod passes;
mod survey;
mod text;
mod views;

use std::sync::Arc;

use crate::error::Result;
use crate::gpu::Limits;
use crate::scene::AreaLight;
use crate::shared::{self, SECTOR_STEPS, View};
use crate::shot::{Settings, Shot};
use crate::technique::{self, Recipe};
use camera::Frustum;
use memory::Inventory;
use survey::{Survey, survey};

pub use host::{HostFrame, plan_for_host};
pub use views::{Aspect, Site};

/// What the caller wants to have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outputs {
    /// The shaded picture.
    pub picture: bool,
}

/// Where the visible surface comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Front {
    /// The scene is drawn.
    Drawn,
    /// A host's images are read.
    Imported,
}

/// Where the shadow maps come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Casters {
    /// The scene's triangles, fitted to and drawn.
    Scene,
    /// The triangles of a host's meshes, gathered at the start of the frame; then as for a scene.
    Gathered,
    /// A host draws them itself.
    DrawnByHost,
    /// A host has the maps already.
    Maps,
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
    /// [level] MSSM levels that there is memory for; 0 = no MSSM.
    pub levels: u32,
    /// [bit] 16 or 32, of a bound in it.
    pub mssm_bits: u32,
    /// [texel] Side of the shadow map; 0 = no view needs one.
    pub map: u32,
    /// [turn] After which the driver ends loops.
    pub loop_turns: u32,
    /// [pixel] Width and height of a packet.
    pub packet: (u32, u32),
    /// The scene has textures that the frame needs.
    pub textured: bool,
    /// The scene has alpha-masked triangles.
    pub masked: bool,
    /// Names of the passes with the number of times each is recorded, in the order of first recording.
    pub passes: Vec<(&'static str, u32)>,
    /// [byte] Name and size of each resource.
    pub resources: Vec<(&'static str, u64)>,
    /// What is left out, and why.
    pub omissions: Vec<Omission>,
}

/// Something that a scene of another kind would need.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Omission {
    pub what: String,
    pub reason: String,
}

/// What is to be done about a light.
#[derive(Debug, Clone)]
pub struct LightPlan {
    pub name: String,
    pub light: shared::Light,
    pub outcome: Outcome,
    pub views: Vec<ViewPlan>,
    /// [sub-light] In how many parts the light is cut.
    pub part_count: usize,
    /// What runs in each of its views.
    pub recipe: Recipe,
}

impl LightPlan {
    /// Whether its views need something of their recipe.
    fn needs(&self, test: impl Fn(&Recipe) -> bool) -> bool {
        !self.views.is_empty() && test(&self.recipe)
    }

    /// Whether several views add up.
    pub fn accumulates(&self) -> bool {
        self.views.len() > 1
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Nothing visible is lit by it: visibility 0.
    Dark,
    /// Nothing can cast a shadow: visibility 1 where it shines.
    Unshadowed,
    /// Its views decide.
    Shadowed,
}

/// One face of one sub-light.
#[derive(Debug, Clone)]
pub struct ViewPlan {
    pub view: View,
    pub variant: Variant,
    /// Sector table of a sub-light that a disc's rim cuts.
    pub sectors: Option<Arc<[f32]>>,
    /// What the view was planned from.
    pub aspect: Aspect,
}

/// Which pipelines a view needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Variant {
    /// A disc's rim cuts the sub-light.
    pub round: bool,
    /// The map is not parallel to the light.
    pub oblique: bool,
    /// The light has more than one view.
    pub accumulate: bool,
}

/// Plans a frame.
///
/// `retained`: the shadow map of the last frame's last view is still there and nothing that it depends on has
/// changed since: scene, camera, lights, map size and bias.
///
/// # Errors
/// The shot makes no sense, or exceeds the device's limits; the message says which knob to turn.
pub fn plan(shot: &Shot, outputs: Outputs, limits: &Limits, retained: bool) -> Result<Plan> {
    shot.validate()?;
    let frustum = Frustum::new(shot);
    let mut plan = Plan {
        textured: !shot.scene.textures.is_empty() && (outputs.picture || shot.scene.has_masked()),
        masked: shot.scene.has_masked(),
        ..Plan::empty(
            (shot.width, shot.height),
            frustum.frame(shot),
            outputs,
            &shot.settings,
            limits,
        )
    };
    let site = Site {
        origin: shot.scene.origin,
        map: shot.settings.map,
        bias: shot.settings.bias,
        levels: 0,
    };
    for light in &shot.lights {
        let found = survey(&shot.scene, &frustum, light);
        let intensity = views::intensity(shot, light);
        plan.add_light(&shot.settings, &site, light, found, intensity);
    }
    plan.size_map(&shot.settings, limits)?;
    let retained = retained && plan.views().count() == 1;
    plan.list_passes(retained);
    plan.list_resources(&shot.settings, &Inventory::of(&shot.scene));
    plan.list_omissions(shot, retained);
    plan.check(limits)?;
    Ok(plan)
}

impl Plan {
    pub fn views(&self) -> impl Iterator<Item = &ViewPlan> {
        self.lights.iter().flat_map(|light| &light.views)
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
            mssm_bits: settings.mssm_bits,
            map: 0,
            loop_turns: limits.loop_turns,
            packet: settings.packet,
            textured: false,
            masked: false,
            passes: Vec::new(),
            resources: Vec::new(),
            omissions: Vec::new(),
        }
    }

    fn add_light(
        &mut self,
        settings: &Settings,
        site: &Site,
        light: &AreaLight,
        found: Survey,
        intensity: [f32; 3],
    ) {
        let outcome = match found {
            Survey {
                receivers: false, ..
            } => Outcome::Dark,
            Survey { casters: false, .. } => Outcome::Unshadowed,
            _ => Outcome::Shadowed,
        };
        let parts = technique::parts(light, settings);
        let faces: Vec<usize> = (0..5).filter(|&face| found.faces[face]).collect();
        let view_first = self.views().count() as u32;
        let tables = self.views().filter(|view| view.sectors.is_some()).count() as u32;
        let mut sector_first = tables * (SECTOR_STEPS + 1);
        let mut views = Vec::new();
        if outcome == Outcome::Shadowed {
            let accumulate = parts.len() * faces.len() > 1;
            for part in &parts {
                views.extend(faces.iter().map(|&face| {
                    let aspect = Aspect {
                        part: part.clone(),
                        face,
                        sides: faces.len() > 1,
                    };
                    let sectors = aspect.sectors();
                    let mut view = aspect.view(site, light, 0);
                    if let Some(table) = &sectors {
                        view.sector_first = sector_first;
                        sector_first += table.len() as u32;
                    }
                    ViewPlan {
                        view,
                        variant: Variant {
                            round: sectors.is_some(),
                            oblique: face != 0,
                            accumulate,
                        },
                        sectors,
                        aspect,
                    }
                }));
            }
        }
        let name = if light.name.is_empty() {
            format!("light {}", self.lights.len())
        } else {
            light.name.clone()
        };
        let weight_sum = views::weight_sum(&parts);
        let view_range = view_first..view_first + views.len() as u32;
        self.lights.push(LightPlan {
            name,
            light: views::whole_light(site.origin, light, intensity, weight_sum, view_range),
            outcome,
            views,
            part_count: parts.len(),
            recipe: Recipe::new(settings, light.is_point()),
        });
    }

    /// Whether some light's views need something of their recipe.
    pub fn needs(&self, test: impl Fn(&Recipe) -> bool) -> bool {
        self.lights.iter().any(|light| light.needs(&test))
    }
}
