//! The passes of a view: shadow map and MSSM, then the technique's stages.

use std::mem::offset_of;
use std::sync::Arc;

use crate::error::Result;
use crate::gpu::{
    Attachments, Commands, ComputePass, Draw, Gpu, GraphicsPass, GraphicsState, Groups, Resources,
    Sources, Specialization,
};
use crate::plan::{Casters, Plan, Variant, ViewSet};
use crate::shared::{Fit, GROUP_SIZE, Push, Round, TILE_SIZE};
use crate::technique::{Stage, Work};

use super::specialization;

/// [texel] Frame of the shadow map that stays empty, so that contours close inside the map.
const MAP_MARGIN: u32 = 1;

/// Who draws the shadow maps of the frame that is being recorded.
pub enum Maps<'a> {
    /// The library, from triangles.
    Own,
    /// The host, into the view of that number.
    DrawnByHost(&'a mut dyn FnMut(u32)),
    /// The host has drawn them; those of the list of resources of that number.
    Given(usize),
}

/// Pipelines of the views of one variant in a set.
pub struct ViewPasses {
    receivers: ComputePass,
    fit: ComputePass,
    map: MapPasses,
    /// What draws the casters behind the layers that are kept.
    next_layers: Option<CasterPasses>,
    mssm: Option<ComputePass>,
    hsm: Option<ComputePass>,
    stages: Vec<(Stage, ComputePass)>,
    /// [texel] Side of the map.
    side: u32,
    layers: u32,
    /// [dispatch] In how many rounds lists are worked off at most.
    rounds: u32,
}

/// What a view's shadow map comes from.
enum MapPasses {
    Triangles {
        casters: ComputePass,
        draw: CasterPasses,
    },
    DrawnByHost {
        region: ComputePass,
        projection: ComputePass,
    },
    Given(GraphicsPass),
}

impl MapPasses {
    fn new(
        gpu: &Arc<Gpu>,
        plan: &Plan,
        constants: &Specialization,
        resources: &Resources,
        maps: &[Resources],
    ) -> Result<Self> {
        let compute =
            |name: &str, shader: &str| ComputePass::new(gpu, name, shader, constants, resources);
        Ok(match plan.casters {
            Casters::Scene | Casters::Gathered => Self::Triangles {
                casters: compute("casters", "casters.comp")?,
                draw: CasterPasses::new(gpu, plan, constants, resources, false)?,
            },
            Casters::DrawnByHost => Self::DrawnByHost {
                region: compute("region", "region.comp")?,
                projection: compute("projection", "projection.comp")?,
            },
            Casters::Maps => {
                let state = GraphicsState {
                    vertex: "whole_image.vert",
                    fragment: Some("import_map.frag"),
                    colors: &[],
                    depth: true,
                };
                let lists: Vec<[&Resources; 2]> =
                    maps.iter().map(|given| [given, resources]).collect();
                let lists: Vec<&Sources> = lists.iter().map(|list| list.as_slice()).collect();
                Self::Given(GraphicsPass::with_each(
                    gpu,
                    "shadow_map",
                    &state,
                    constants,
                    &lists,
                )?)
            }
        })
    }
}

/// Draws of opaque and of alpha-masked casters.
struct CasterPasses {
    opaque: GraphicsPass,
    masked: Option<GraphicsPass>,
}

impl CasterPasses {
    fn new(
        gpu: &Arc<Gpu>,
        plan: &Plan,
        base: &Specialization,
        resources: &Resources,
        peel: bool,
    ) -> Result<Self> {
        let draw = |name: &str, masked: bool| {
            let state = GraphicsState {
                vertex: "shadow_map.vert",
                fragment: (masked || peel).then_some("shadow_map.frag"),
                colors: &[],
                depth: true,
            };
            let constants = specialization::of_casters(base, masked, peel);
            GraphicsPass::new(gpu, name, &state, &constants, resources)
        };
        let name = if peel { "peel" } else { "shadow_map" };
        Ok(Self {
            opaque: draw(name, false)?,
            masked: plan
                .masked
                .then(|| draw(&format!("{name} (masked)"), true))
                .transpose()?,
        })
    }

    /// Draws the casters of view `push.index` into the shadow map.
    fn record(
        &self,
        commands: &mut Commands,
        name: &'static str,
        resources: &Resources,
        side: u32,
        push: Push,
    ) -> Result<()> {
        let fits = resources.buffer("fits")?;
        let indices = resources.buffer("caster_indices")?;
        let casters = |offset| Draw::Indexed {
            indices,
            command: (fits, in_fit(push.index, offset)),
        };
        let opaque = (self.opaque.with(0), casters(offset_of!(Fit, opaque_draw)));
        let masked = (self.masked.as_ref())
            .map(|masked| (masked.with(0), casters(offset_of!(Fit, masked_draw))));
        let draws = [Some(opaque), masked].into_iter().flatten();
        commands.draw(name, push, &into_map(resources, side)?, draws);
        Ok(())
    }
}

/// A shadow map of `side` × `side` texels, but for its margin.
fn into_map(resources: &Resources, side: u32) -> Result<Attachments<'static>> {
    let mut target = resources.image("shadow_map")?.target();
    target.size = (side, side);
    Ok(Attachments {
        colors: &[],
        depth: Some(target),
        margin: MAP_MARGIN,
    })
}

impl ViewPasses {
    pub fn new(
        gpu: &Arc<Gpu>,
        plan: &Plan,
        set: &ViewSet,
        variant: Variant,
        resources: &Resources,
        maps: &[Resources],
    ) -> Result<Self> {
        let recipe = &set.recipe;
        let constants = |work| specialization::of_view(plan, set, variant, work);
        let compute = |name: &str, shader: &str, work| {
            ComputePass::new(gpu, name, shader, &constants(work), resources)
        };
        let base = constants(Work::Packets);
        let structure = |wanted: bool, name: &str, shader: &str| {
            wanted
                .then(|| compute(name, shader, Work::Pixels))
                .transpose()
        };
        let mssm = match plan.mssm_bits {
            16 => "mssm_16.comp",
            _ => "mssm.comp",
        };
        let stage = |stage: &Stage| Ok((*stage, compute(stage.name, stage.shader, stage.work)?));
        Ok(Self {
            receivers: compute("receivers", "receivers.comp", Work::Pixels)?,
            fit: compute("fit", "fit.comp", Work::Packets)?,
            map: MapPasses::new(gpu, plan, &base, resources, maps)?,
            next_layers: (recipe.layers > 1)
                .then(|| CasterPasses::new(gpu, plan, &base, resources, true))
                .transpose()?,
            mssm: structure(recipe.mssm, "mssm", mssm)?,
            hsm: structure(recipe.hsm, "hsm", "hsm.comp")?,
            stages: recipe.stages.iter().map(stage).collect::<Result<_>>()?,
            side: set.settings.map,
            layers: recipe.layers,
            rounds: plan.rounds(),
        })
    }

    /// Shadow map and what is built from it, for view `index`, fitted to what can cast.
    pub fn record_map(
        &self,
        commands: &mut Commands,
        plan: &Plan,
        resources: &Resources,
        maps: &mut Maps,
        index: u32,
    ) -> Result<()> {
        let push = Push { index, level: 0 };
        let once = || Groups::Direct([1, 1, 1]);
        let pixels = plan.size.0 * plan.size.1;
        commands.dispatch("receivers", &self.receivers, push, reduction(pixels));
        match &self.map {
            MapPasses::Triangles { casters, .. } => {
                let triangles = plan.frame.opaque_count + plan.frame.masked_count;
                commands.dispatch("casters", casters, push, reduction(triangles));
            }
            MapPasses::DrawnByHost { region, .. } => {
                commands.dispatch("region", region, push, once());
            }
            MapPasses::Given(_) => {}
        }
        commands.dispatch("fit", &self.fit, push, once());
        match (&self.map, maps) {
            (MapPasses::Triangles { draw, .. }, _) => {
                draw.record(commands, "shadow_map", resources, self.side, push)?;
            }
            (MapPasses::DrawnByHost { projection, .. }, Maps::DrawnByHost(draw)) => {
                commands.dispatch("projection", projection, push, once());
                let map = into_map(resources, self.side)?;
                commands.draw_by_host("shadow_map", &map, || draw(index));
            }
            (MapPasses::Given(import), Maps::Given(list)) => {
                let views = plan.views().count();
                let bound = import.with(*list * views + index as usize);
                let draw = (bound, Draw::Vertices(3));
                let map = into_map(resources, self.side)?;
                commands.draw("shadow_map", push, &map, [draw]);
            }
            _ => {
                return Err(crate::Error::Invalid(
                    "the shadow maps of this frame come from elsewhere than was planned".into(),
                ));
            }
        }
        self.record_structures(commands, plan, resources, index)?;
        self.record_layers(commands, resources, index)
    }

    fn record_structures(
        &self,
        commands: &mut Commands,
        plan: &Plan,
        resources: &Resources,
        index: u32,
    ) -> Result<()> {
        if let Some(mssm) = &self.mssm {
            let fits = resources.buffer("fits")?;
            for level in 0..plan.levels {
                let offset = offset_of!(Fit, level_groups) + level as usize * size_of::<[u32; 3]>();
                let groups = Groups::Indirect(fits, in_fit(index, offset));
                commands.dispatch("mssm", mssm, Push { index, level }, groups);
            }
        }
        if let Some(hsm) = &self.hsm {
            for level in 1..=plan.hsm_levels() {
                let side = plan.map.div_ceil(1 << level).div_ceil(TILE_SIZE);
                let groups = Groups::Direct([side, side, 1]);
                commands.dispatch("hsm", hsm, Push { index, level }, groups);
            }
        }
        Ok(())
    }

    /// Keeps layer after layer and draws the next into the shadow map.
    fn record_layers(
        &self,
        commands: &mut Commands,
        resources: &Resources,
        index: u32,
    ) -> Result<()> {
        let (map, layers) = (resources.image("shadow_map")?, resources.image("layers")?);
        for level in 0..self.layers {
            if let (1.., Some(casters)) = (level, &self.next_layers) {
                casters.record(
                    commands,
                    "peel",
                    resources,
                    self.side,
                    Push { index, level },
                )?;
            }
            commands.copy_layer("keep_layer", map, layers, level);
        }
        Ok(())
    }

    /// The technique's stages in view `index`.
    pub fn record_stages(
        &self,
        commands: &mut Commands,
        resources: &Resources,
        index: u32,
    ) -> Result<()> {
        let (fits, rounds) = (resources.buffer("fits")?, resources.buffer("rounds")?);
        for (stage, pass) in &self.stages {
            // Lists are worked off in rounds, each of which finds its own groups.
            let in_list = |offset: usize, round: u32| {
                let first = index as usize * self.rounds as usize;
                let offset = (first + round as usize) * size_of::<Round>() + offset;
                Groups::Indirect(rounds, offset as u64)
            };
            let groups = |round| match stage.work {
                Work::Pixels => {
                    Groups::Indirect(fits, in_fit(index, offset_of!(Fit, kernel_groups)))
                }
                Work::Packets => {
                    Groups::Indirect(fits, in_fit(index, offset_of!(Fit, classify_groups)))
                }
                Work::PacketList => in_list(offset_of!(Round, packet_groups), round),
                Work::PixelList => in_list(offset_of!(Round, pixel_groups), round),
            };
            let rounds = match stage.work {
                Work::PacketList | Work::PixelList => self.rounds,
                _ => 1,
            };
            let dispatch = |level| (pass.with(0), Push { index, level }, groups(level));
            commands.dispatch_all(stage.name, (0..rounds).map(dispatch));
        }
        Ok(())
    }
}

/// Work groups of a pass that reduces `count` items: each invocation takes several, so that few of them
/// have to agree in memory.
pub fn reduction(count: u32) -> Groups<'static> {
    const ITEMS_PER_INVOCATION: u32 = 8;
    const GROUPS_MAX: u32 = 4096;
    let groups = count.div_ceil(GROUP_SIZE * ITEMS_PER_INVOCATION);
    Groups::Direct([groups.clamp(1, GROUPS_MAX), 1, 1])
}

/// Work groups over the image.
pub fn tiles(plan: &Plan) -> [u32; 3] {
    [
        plan.size.0.div_ceil(TILE_SIZE),
        plan.size.1.div_ceil(TILE_SIZE),
        1,
    ]
}

fn in_fit(index: u32, offset: usize) -> u64 {
    (index as usize * size_of::<Fit>() + offset) as u64
}
