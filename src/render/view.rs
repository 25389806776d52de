//! The passes of a view: shadow map and MSSM, then the technique's stages.

use std::mem::offset_of;
use std::sync::Arc;

use crate::error::Result;
use crate::gpu::{
    Attachments, ComputePass, Draw, Gpu, GraphicsPass, GraphicsState, Groups, Recorder, Resources,
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
    opaque: GraphicsPass,
    masked: Option<GraphicsPass>,
    mssm: Option<ComputePass>,
    stages: Vec<(Stage, ComputePass)>,
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
        let constants = |work| specialization::of_view(plan, settings, variant, work);
        let compute = |name: &str, shader: &str, work| {
            ComputePass::new(gpu, name, shader, &constants(work), resources)
        };
        let draw = |name: &str, fragment| {
            let state = GraphicsState {
                vertex: "shadow_map.vert",
                fragment,
                colors: &[],
            };
            GraphicsPass::new(gpu, name, &state, &constants(Work::Packets), resources)
        };
        let stage = |stage: &Stage| Ok((*stage, compute(stage.name, stage.shader, stage.work)?));
        Ok(Self {
            receivers: compute("receivers", "receivers.comp", Work::Pixels)?,
            casters: compute("casters", "casters.comp", Work::Pixels)?,
            fit: compute("fit", "fit.comp", Work::Packets)?,
            opaque: draw("shadow_map", None)?,
            masked: plan
                .masked
                .then(|| draw("shadow_map (masked)", Some("shadow_map.frag")))
                .transpose()?,
            mssm: recipe
                .mssm
                .then(|| compute("mssm", "mssm.comp", Work::Pixels))
                .transpose()?,
            stages: recipe.stages.iter().map(stage).collect::<Result<_>>()?,
        })
    }

    /// Shadow map and MSSM of view `index`, fitted to what can cast.
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

        let fits = resources.buffer("fits")?;
        let indices = resources.buffer("caster_indices")?;
        let casters = |offset| Draw::Indexed {
            indices,
            command: (fits, in_fit(index, offset)),
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
        recorder.draw("shadow_map", push, &attachments, &draws);

        if let Some(mssm) = &self.mssm {
            for level in 0..plan.levels {
                let offset = in_fit(
                    index,
                    offset_of!(Fit, level_groups) + level as usize * size_of::<[u32; 3]>(),
                );
                recorder.dispatch(
                    "mssm",
                    mssm,
                    Push { index, level },
                    Groups::Indirect(fits, offset),
                );
            }
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
        for (stage, pass) in &self.stages {
            let groups = match stage.work {
                Work::Pixels => Groups::Direct(tiles(plan)),
                Work::Kernels => {
                    Groups::Indirect(fits, in_fit(index, offset_of!(Fit, kernel_groups)))
                }
                Work::Packets => {
                    Groups::Indirect(fits, in_fit(index, offset_of!(Fit, classify_groups)))
                }
                Work::PacketList => {
                    Groups::Indirect(lists, in_lists(index, offset_of!(Lists, packet_groups)))
                }
                Work::PixelList => {
                    Groups::Indirect(lists, in_lists(index, offset_of!(Lists, pixel_groups)))
                }
            };
            recorder.dispatch(stage.name, pass, Push { index, level: 0 }, groups);
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
