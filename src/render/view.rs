//! The passes of a view: shadow map and MSSM, then the technique's stages.

use std::mem::offset_of;
use std::sync::Arc;

use crate::error::Result;
use crate::gpu::{
    Attachments, ComputePass, Draw, Gpu, GraphicsPass, GraphicsState, Groups, Recorder, Resources,
    Specialization,
};
use crate::plan::{Plan, Variant};
use crate::shared::{Fit, GROUP_SIZE, Lists, Push, TILE_SIZE};
use crate::shot::Settings;
use crate::technique::{Recipe, Stage, Work};

use super::specialization;

/// [texel] Frame of the shadow map that stays empty, so that contours close inside the map.
const MAP_MARGIN: u32 = 1;

/// Pipelines of the views of one variant under one recipe.
pub struct ViewPasses {
    receivers: ComputePass,
    casters: ComputePass,
    fit: ComputePass,
    first_layer: CasterPasses,
    /// What draws the casters behind the layers that are kept.
    next_layers: Option<CasterPasses>,
    mssm: Option<ComputePass>,
    hsm: Option<ComputePass>,
    stages: Vec<(Stage, ComputePass)>,
    layers: u32,
    /// [dispatch] In how many rounds lists are worked off at most.
    rounds: u32,
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
        recorder: &mut Recorder,
        name: &str,
        resources: &Resources,
        push: Push,
    ) -> Result<()> {
        let fits = resources.buffer("fits")?;
        let indices = resources.buffer("caster_indices")?;
        let casters = |offset| Draw::Indexed {
            indices,
            command: (fits, in_fit(push.index, offset)),
        };
        let mut draws = vec![(&self.opaque, casters(offset_of!(Fit, opaque_draw)))];
        if let Some(masked) = &self.masked {
            draws.push((masked, casters(offset_of!(Fit, masked_draw))));
        }
        let attachments = Attachments {
            colors: &[],
            depth: resources.image("shadow_map")?,
            margin: MAP_MARGIN,
        };
        recorder.draw(name, push, &attachments, &draws);
        Ok(())
    }
}

impl ViewPasses {
    pub fn new(
        gpu: &Arc<Gpu>,
        plan: &Plan,
        settings: &Settings,
        recipe: &Recipe,
        variant: Variant,
        resources: &Resources,
    ) -> Result<Self> {
        let constants = |work| specialization::of_view(plan, settings, recipe, variant, work);
        let compute = |name: &str, shader: &str, work| {
            ComputePass::new(gpu, name, shader, &constants(work), resources)
        };
        let casters =
            |peel| CasterPasses::new(gpu, plan, &constants(Work::Packets), resources, peel);
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
            casters: compute("casters", "casters.comp", Work::Pixels)?,
            fit: compute("fit", "fit.comp", Work::Packets)?,
            first_layer: casters(false)?,
            next_layers: (recipe.layers > 1).then(|| casters(true)).transpose()?,
            mssm: structure(recipe.mssm, "mssm", mssm)?,
            hsm: structure(recipe.hsm, "hsm", "hsm.comp")?,
            stages: recipe.stages.iter().map(stage).collect::<Result<_>>()?,
            layers: recipe.layers,
            rounds: plan.rounds(recipe),
        })
    }

    /// Shadow map and what is built from it, for view `index`, fitted to what can cast.
    pub fn record_map(
        &self,
        recorder: &mut Recorder,
        plan: &Plan,
        resources: &Resources,
        index: u32,
    ) -> Result<()> {
        let push = Push { index, level: 0 };
        let triangles = plan.frame.opaque_count + plan.frame.masked_count;
        let pixels = plan.size.0 * plan.size.1;
        recorder.dispatch("receivers", &self.receivers, push, reduction(pixels));
        recorder.dispatch("casters", &self.casters, push, reduction(triangles));
        recorder.dispatch("fit", &self.fit, push, Groups::Direct([1, 1, 1]));
        self.first_layer
            .record(recorder, "shadow_map", resources, push)?;
        self.record_structures(recorder, plan, resources, index)?;
        self.record_layers(recorder, resources, index)
    }

    fn record_structures(
        &self,
        recorder: &mut Recorder,
        plan: &Plan,
        resources: &Resources,
        index: u32,
    ) -> Result<()> {
        if let Some(mssm) = &self.mssm {
            let fits = resources.buffer("fits")?;
            for level in 0..plan.levels {
                let offset = offset_of!(Fit, level_groups) + level as usize * size_of::<[u32; 3]>();
                let groups = Groups::Indirect(fits, in_fit(index, offset));
                recorder.dispatch("mssm", mssm, Push { index, level }, groups);
            }
        }
        if let Some(hsm) = &self.hsm {
            for level in 1..=plan.hsm_levels() {
                let side = plan.map.div_ceil(1 << level).div_ceil(TILE_SIZE);
                let groups = Groups::Direct([side, side, 1]);
                recorder.dispatch("hsm", hsm, Push { index, level }, groups);
            }
        }
        Ok(())
    }

    /// Keeps layer after layer and draws the next into the shadow map.
    fn record_layers(
        &self,
        recorder: &mut Recorder,
        resources: &Resources,
        index: u32,
    ) -> Result<()> {
        let (map, layers) = (resources.image("shadow_map")?, resources.image("layers")?);
        for level in 0..self.layers {
            if let (1.., Some(casters)) = (level, &self.next_layers) {
                casters.record(recorder, "peel", resources, Push { index, level })?;
            }
            recorder.copy_layer("keep_layer", map, layers, level);
        }
        Ok(())
    }

    /// The technique's stages in view `index`.
    pub fn record_stages(
        &self,
        recorder: &mut Recorder,
        plan: &Plan,
        resources: &Resources,
        index: u32,
    ) -> Result<()> {
        let (fits, lists) = (resources.buffer("fits")?, resources.buffer("lists")?);
        let push = |level| Push { index, level };
        for (stage, pass) in &self.stages {
            let once = |groups| vec![(push(0), groups)];
            let in_rounds = |offset: usize| -> Vec<_> {
                let groups = |round: u32| {
                    let offset = offset + round as usize * size_of::<[u32; 3]>();
                    Groups::Indirect(lists, in_lists(index, offset))
                };
                (0..self.rounds)
                    .map(|round| (push(round), groups(round)))
                    .collect()
            };
            let in_fit = |offset| Groups::Indirect(fits, in_fit(index, offset));
            let dispatches = match stage.work {
                Work::Pixels => once(Groups::Direct(tiles(plan))),
                Work::Kernels => once(in_fit(offset_of!(Fit, kernel_groups))),
                Work::Packets => once(in_fit(offset_of!(Fit, classify_groups))),
                Work::PacketList => in_rounds(offset_of!(Lists, packet_groups)),
                Work::PixelList => in_rounds(offset_of!(Lists, pixel_groups)),
            };
            recorder.dispatch_all(stage.name, pass, &dispatches);
        }
        Ok(())
    }
}

/// Work groups of a pass that reduces `count` items: each invocation takes several, so that few of them
/// have to agree in memory.
fn reduction(count: u32) -> Groups<'static> {
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

fn in_lists(index: u32, offset: usize) -> u64 {
    (index as usize * size_of::<Lists>() + offset) as u64
}
