//! Records a step of a plan with its pipelines.

use std::mem::offset_of;

use super::draw::Drawing;
use super::pipelines::Pipelines;
use super::recording::{Inputs, Recording, in_fit, push};
use crate::error::Result;
use crate::frame::{Domain, Scope, Step, Work};
use crate::gpu::{Commands, Groups};
use crate::shared::{
    Fit, GROUP_SIZE, GROUPS_PER_ROW, HierarchyGroups, Instance, Lists, Push, Round, TILE_SIZE,
};

impl Recording<'_> {
    /// `side`: [texel] of the view's map. Does not allocate.
    ///
    /// # Errors
    /// A resource is missing that the plan should have listed, or an input that it asks for.
    pub fn record(
        &self,
        commands: &mut Commands,
        step: &Step,
        pipelines: &Pipelines,
        side: u32,
        inputs: &mut Inputs,
    ) -> Result<()> {
        let (name, resources) = (step.pass.name, self.resources);
        match step.pass.work {
            Work::Clear(names) => {
                resources.check_buffers(names)?;
                let buffers = names.iter().flat_map(|name| resources.buffer(name));
                commands.clear(name, buffers);
            }
            Work::Upload => {
                let names = inputs.uploads.iter().map(|(name, _)| name);
                resources.check_buffers(names)?;
                let uploads = inputs.uploads.iter();
                let update = |&(name, data)| Some((resources.buffer(name).ok()?, data));
                commands.update(name, uploads.filter_map(update));
            }
            Work::Dispatch {
                over: Domain::Instances,
                ..
            } => dispatch_instances(commands, name, pipelines, inputs),
            Work::Dispatch {
                over: list @ (Domain::PacketList | Domain::PixelList),
                ..
            } => self.dispatch_list(commands, step, pipelines, list)?,
            Work::Dispatch { over, .. } => {
                let bound = pipelines.compute()?.with(self.list(step, inputs));
                let groups = self.groups(over, step, side)?;
                commands.dispatch(name, bound, push(step), groups);
            }
            Work::Draw { what, into, .. } => commands.render(name, |rendering| {
                let views = step.scope.each().map(|scope| Step { scope, ..*step });
                let draw = |step| Drawing {
                    recording: self,
                    step,
                    side,
                };
                let mut drawings = views.map(draw);
                drawings.try_for_each(|drawing| {
                    drawing.record(rendering, pipelines, what, into, inputs)
                })
            })?,
            Work::CopyLayer { from, to } => {
                let (from, to) = (resources.image(from)?, resources.image(to)?);
                commands.copy_layer(name, from, to, step.level);
            }
        }
        Ok(())
    }

    /// Lists are worked off in rounds, each of which finds its own groups.
    fn dispatch_list(
        &self,
        commands: &mut Commands,
        step: &Step,
        pipelines: &Pipelines,
        list: Domain,
    ) -> Result<()> {
        let (push, bound) = (push(step), pipelines.compute()?.with(0));
        let rounds = self.resources.buffer("rounds")?;
        let dispatch = |round| {
            let first = push.index as usize * self.rounds as usize;
            let offset = (first + round as usize) * size_of::<Round>() + in_round(list);
            let push = Push {
                level: round,
                ..push
            };
            (bound, push, Groups::Indirect(rounds, offset as u64))
        };
        commands.dispatch_all(step.pass.name, (0..self.rounds).map(dispatch));
        Ok(())
    }

    /// `side`: [texel] of the views' maps.
    fn groups(&self, over: Domain, step: &Step, side: u32) -> Result<Groups<'_>> {
        let (plan, push) = (self.plan, push(step));
        let triangles = plan.frame.opaque_count + plan.frame.masked_count;
        let found = |offset| {
            let fits = self.resources.buffer("fits")?;
            Ok(Groups::Indirect(fits, in_fit(push.index, offset)))
        };
        let mut groups = match over {
            Domain::Image => Groups::Direct(tiles(plan.size)),
            Domain::PixelReduction => reduction(plan.size.0 * plan.size.1),
            Domain::TriangleReduction => reduction(triangles),
            Domain::Pixels => return found(offset_of!(Fit, image_groups)),
            Domain::Tiles => {
                let count: u32 = tiles(plan.size).iter().product();
                listed(count.div_ceil(GROUP_SIZE))
            }
            Domain::ListedTiles => {
                let lists = self.resources.buffer("lists")?;
                let view = push.index as usize * size_of::<Lists>();
                let offset = view + offset_of!(Lists, tile_groups);
                Groups::Indirect(lists, offset as u64)
            }
            Domain::Packets => return found(offset_of!(Fit, classify_groups)),
            Domain::HierarchyLevel => {
                let groups = self.resources.buffer("hierarchy_groups")?;
                let of_view = push.index as usize * size_of::<HierarchyGroups>();
                let offset = of_view + push.level as usize * size_of::<[u32; 3]>();
                return Ok(Groups::Indirect(groups, offset as u64));
            }
            Domain::PyramidLevel => {
                let side = side.div_ceil(1 << push.level);
                Groups::Direct(tiles((side, side)))
            }
            Domain::MapTexels => Groups::Direct(tiles((side, side))),
            Domain::Once | Domain::Instances | Domain::PacketList | Domain::PixelList => {
                Groups::Direct([1, 1, 1])
            }
        };
        if let (Groups::Direct([_, _, z]), Scope::Views { count, .. }) = (&mut groups, step.scope) {
            *z = count;
        }
        Ok(groups)
    }
}

/// Without meshes there are neither pipelines nor instances.
fn dispatch_instances(
    commands: &mut Commands,
    name: &'static str,
    pipelines: &Pipelines,
    inputs: &Inputs,
) {
    let instances = inputs.instances.iter().zip(inputs.meshes).enumerate();
    let dispatch = |(index, (instance, &mesh)): (usize, (&Instance, &usize))| {
        let push = Push {
            index: index as u32,
            stride: 0,
            level: 0,
        };
        let count = instance.vertex_count.max(instance.triangle_count);
        Some((pipelines.compute().ok()?.with(mesh), push, reduction(count)))
    };
    commands.dispatch_independent(name, instances.filter_map(dispatch));
}

/// Work groups of a pass that reduces `count` items: each invocation takes several, so that few of them
/// have to agree in memory.
fn reduction(count: u32) -> Groups<'static> {
    const ITEMS_PER_INVOCATION: u32 = 8;
    const GROUPS_MAX: u32 = 4096;
    let groups = count.div_ceil(GROUP_SIZE * ITEMS_PER_INVOCATION);
    Groups::Direct([groups.clamp(1, GROUPS_MAX), 1, 1])
}

/// So many work groups, as lists are worked off.
fn listed(groups: u32) -> Groups<'static> {
    Groups::Direct([
        groups.min(GROUPS_PER_ROW),
        groups.div_ceil(GROUPS_PER_ROW),
        1,
    ])
}

/// Work groups over an image of this size.
fn tiles((width, height): (u32, u32)) -> [u32; 3] {
    [width.div_ceil(TILE_SIZE), height.div_ceil(TILE_SIZE), 1]
}

/// [byte] Where in a round the groups of a list stand.
fn in_round(list: Domain) -> usize {
    match list {
        Domain::PacketList => offset_of!(Round, packet_groups),
        _ => offset_of!(Round, pixel_groups),
    }
}
