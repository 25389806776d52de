//! Memory and pipelines of an effect, for the images and meshes that a host lends.

use std::sync::Arc;

use ash::vk;

use super::super::chain::Chain;
use super::super::view::{Maps, reduction, tiles};
use super::super::{resources, specialization};
use super::input::{DrawnView, FrameInput, Mesh, SlotImages, Surface};
use crate::error::{Error, Result};
use crate::gpu::{
    Attachments, Commands, ComputePass, Draw, Gpu, GraphicsPass, GraphicsState, Groups, HostBuffer,
    HostImage, HostImageInfo, Loan, Resources, Sources,
};
use crate::plan::{Casters, HostFrame, Plan};
use crate::shared::{self, Costs, Given, Instance, Projection, Push, View};

/// Most slots of images.
const MAX_SLOTS: usize = 64;
/// Most meshes.
const MAX_MESHES: usize = 65536;

pub struct Prepared {
    pub resources: Resources,
    pub slots: Vec<Slot>,
    /// The host's shadow maps: those of the first slot's views, then of the next slot's.
    maps: Vec<Resources>,
    pub meshes: Vec<MeshSet>,
    pub view_count: usize,
    import: ComputePass,
    gather: Option<ComputePass>,
    chain: Chain,
    export: GraphicsPass,
    /// The serial of the last frame that was recorded with it; 0 = none was.
    pub last: u64,
}

/// The images of a slot.
pub struct Slot {
    inputs: Resources,
    output: HostImage,
}

/// A mesh with its buffers as passes see them.
pub struct MeshSet {
    buffers: Resources,
    /// What all its instances have in common.
    pub layout: Instance,
}

impl Prepared {
    /// # Safety
    /// As for `Effect::prepare`.
    pub unsafe fn new(
        gpu: &Arc<Gpu>,
        host: &HostFrame,
        surface: Surface,
        plan: &Plan,
        costs: Costs,
        slots: &[SlotImages],
        meshes: &[Mesh],
    ) -> Result<Self> {
        check_counts(slots, meshes)?;
        let view_count = plan.views().count();
        let resources = resources::create_for_host(gpu, plan, costs)?;
        let (mut lent, mut maps) = (Vec::new(), Vec::new());
        for slot in slots {
            // SAFETY: the caller's promise, here and below.
            lent.push(unsafe { Slot::new(gpu, host, slot) }?);
            maps.extend(unsafe { given_maps(gpu, host, view_count, slot) }?);
        }
        let meshes = meshes
            .iter()
            .map(|mesh| unsafe { MeshSet::new(gpu, mesh) })
            .collect::<Result<Vec<_>>>()?;
        let with_each = |name: &str, shader: &str, constants, lists: &[[&Resources; 2]]| {
            let lists: Vec<&Sources> = lists.iter().map(|list| list.as_slice()).collect();
            ComputePass::with_each(gpu, name, shader, constants, &lists)
        };
        let of_slots: Vec<_> = lent.iter().map(|slot| [&slot.inputs, &resources]).collect();
        let constants = specialization::of_import(surface == Surface::Positions);
        let import = with_each(
            "import_surface",
            "import_surface.comp",
            &constants,
            &of_slots,
        )?;
        let of_meshes: Vec<_> = meshes
            .iter()
            .map(|mesh| [&mesh.buffers, &resources])
            .collect();
        let gather = (!meshes.is_empty())
            .then(|| with_each("gather", "gather.comp", &constants, &of_meshes))
            .transpose()?;
        let chain = Chain::new(gpu, plan, &resources, &maps)?;
        let state = GraphicsState {
            vertex: "whole_image.vert",
            fragment: Some("export.frag"),
            colors: &[lent[0].output.format()],
            depth: false,
        };
        let export = GraphicsPass::new(gpu, "export", &state, &constants, &resources)?;
        Ok(Self {
            resources,
            slots: lent,
            maps,
            meshes,
            view_count,
            import,
            gather,
            chain,
            export,
            last: 0,
        })
    }

    /// Sends what stands where.
    pub fn send(
        &self,
        commands: &mut Commands,
        plan: &Plan,
        host: &shared::Host,
        views: &[View],
        givens: &[Given],
        instances: &[Instance],
    ) -> Result<()> {
        let buffer = |name| self.resources.buffer(name);
        let given = match plan.casters {
            Casters::DrawnByHost | Casters::Maps => givens,
            Casters::Scene | Casters::Gathered => &[],
        };
        let light = plan
            .lights
            .first()
            .map(|light| light.light)
            .unwrap_or_default();
        commands.initialize(&self.resources);
        commands.update(
            "update",
            &[
                (buffer("frame")?, bytemuck::bytes_of(&plan.frame)),
                (buffer("lights")?, bytemuck::bytes_of(&light)),
                (buffer("host")?, bytemuck::bytes_of(host)),
                (buffer("views")?, bytemuck::cast_slice(views)),
                (buffer("givens")?, bytemuck::cast_slice(given)),
                (buffer("instances")?, bytemuck::cast_slice(instances)),
            ],
        );
        Ok(())
    }

    /// Records all passes of a frame.
    pub fn record(
        &self,
        commands: &mut Commands,
        plan: &Plan,
        instances: &[Instance],
        chosen: &[usize],
        frame: &mut FrameInput,
    ) -> Result<()> {
        let slot = &self.slots[frame.slot];
        let of_slot = frame.slot * self.view_count;
        let maps = match plan.casters {
            Casters::Maps => &self.maps[of_slot..of_slot + self.view_count],
            _ => &[],
        };
        let inputs = || {
            slot.inputs
                .host_images()
                .chain(maps.iter().flat_map(Resources::host_images))
        };
        inputs().for_each(|image| commands.acquire(image));
        let whole = Groups::Direct(tiles(plan));
        commands.dispatch(
            "import_surface",
            self.import.with(frame.slot),
            Push::default(),
            whole,
        );
        if plan.casters == Casters::Gathered {
            let all = self.gather.iter().flat_map(|gather| {
                instances
                    .iter()
                    .zip(chosen)
                    .enumerate()
                    .map(|(index, (instance, &mesh))| {
                        let push = Push {
                            index: index as u32,
                            level: 0,
                        };
                        let count = instance.vertex_count.max(instance.triangle_count);
                        (gather.with(mesh), push, reduction(count))
                    })
            });
            commands.dispatch_independent("gather", all);
        }
        let mut nobody = |_| {};
        let draw = match &mut frame.draw {
            Some(draw) => draw,
            None => &mut nobody as &mut dyn FnMut(DrawnView),
        };
        let mut drawn = |index: u32| {
            let offset = u64::from(index) * size_of::<Projection>() as u64;
            draw(DrawnView { index, offset });
        };
        let mut maps = match plan.casters {
            Casters::DrawnByHost => Maps::DrawnByHost(&mut drawn),
            Casters::Maps => Maps::Given(frame.slot),
            Casters::Scene | Casters::Gathered => Maps::Own,
        };
        self.chain
            .record(commands, plan, &self.resources, &mut maps, None)?;
        commands.acquire(&slot.output);
        let attachments = Attachments {
            colors: &[slot.output.target()],
            depth: None,
            margin: 0,
        };
        let draw = (self.export.with(0), Draw::Vertices(3));
        commands.draw("export", Push::default(), &attachments, [draw]);
        commands.release(&slot.output);
        inputs().for_each(|image| commands.release(image));
        Ok(())
    }
}

fn check_counts(slots: &[SlotImages], meshes: &[Mesh]) -> Result<()> {
    if !(1..=MAX_SLOTS).contains(&slots.len()) {
        return Err(Error::Invalid(format!(
            "an effect has 1 to {MAX_SLOTS} slots of images, not {}",
            slots.len()
        )));
    }
    if meshes.len() > MAX_MESHES {
        return Err(Error::Invalid(format!(
            "{} meshes are more than {MAX_MESHES}",
            meshes.len()
        )));
    }
    let formats = slots.iter().map(|slot| slot.visibility.format);
    if formats
        .clone()
        .any(|format| format != slots[0].visibility.format)
    {
        return Err(Error::Invalid(
            "the visibility images of all slots have the same format".into(),
        ));
    }
    Ok(())
}

fn check_size(name: &str, image: &HostImageInfo, size: (u32, u32)) -> Result<()> {
    match image.size == size && image.raw != vk::Image::null() {
        true => Ok(()),
        false => Err(Error::Invalid(format!(
            "{name} is an image of {}x{}, not of {}x{}",
            size.0, size.1, image.size.0, image.size.1
        ))),
    }
}

impl Slot {
    /// # Safety
    /// As for `Effect::prepare`.
    unsafe fn new(gpu: &Arc<Gpu>, host: &HostFrame, images: &SlotImages) -> Result<Self> {
        let lend = |name: &str, info: HostImageInfo, loan| {
            check_size(name, &info, host.size)?;
            // SAFETY: the caller's promise.
            unsafe { HostImage::new(gpu, name, info, loan) }
        };
        let mut inputs = Resources::default();
        inputs.add_host_image(
            "host_surface",
            lend("host_surface", images.surface, Loan::Sampled)?,
        );
        inputs.add_host_image(
            "host_normal",
            lend("host_normal", images.normal, Loan::Sampled)?,
        );
        Ok(Self {
            inputs,
            output: lend("visibility", images.visibility, Loan::Drawn)?,
        })
    }
}

/// # Safety
/// As for `Effect::prepare`.
unsafe fn given_maps(
    gpu: &Arc<Gpu>,
    host: &HostFrame,
    view_count: usize,
    images: &SlotImages,
) -> Result<Vec<Resources>> {
    let expected = match host.casters {
        Casters::Maps => view_count,
        _ => 0,
    };
    if images.casters.len() != expected {
        return Err(Error::Invalid(format!(
            "a slot has {expected} shadow maps, one for each view, not {}",
            images.casters.len()
        )));
    }
    let side = (host.settings.map, host.settings.map);
    let map = |info: &HostImageInfo| {
        check_size("host_map", info, side)?;
        let mut list = Resources::default();
        // SAFETY: the caller's promise.
        let image = unsafe { HostImage::new(gpu, "host_map", *info, Loan::Sampled) }?;
        list.add_host_image("host_map", image);
        Ok(list)
    };
    images.casters.iter().map(map).collect()
}

impl MeshSet {
    /// # Safety
    /// As for `Effect::prepare`.
    unsafe fn new(gpu: &Gpu, mesh: &Mesh) -> Result<Self> {
        check_mesh(mesh)?;
        let (vertices, first) = {
            let bytes = u64::from(mesh.vertex_stride) * u64::from(mesh.vertex_count - 1) + 12;
            // SAFETY: the caller's promise, here and below.
            unsafe {
                HostBuffer::new(
                    gpu,
                    "a mesh's vertices",
                    mesh.vertices,
                    mesh.vertex_offset,
                    bytes,
                )
            }?
        };
        let indexed = mesh.indices != vk::Buffer::null();
        let (indices, index_first) = if indexed {
            // Whole words, as shaders read them.
            let bytes = (3 * u64::from(mesh.triangle_count) * u64::from(mesh.index_bytes))
                .next_multiple_of(4);
            unsafe {
                HostBuffer::new(
                    gpu,
                    "a mesh's indices",
                    mesh.indices,
                    mesh.index_offset,
                    bytes,
                )
            }?
        } else {
            (vertices, 0)
        };
        let index_bytes = if indexed { mesh.index_bytes } else { 0 };
        let mut buffers = Resources::default();
        buffers.add_host_buffer("host_vertices", vertices);
        buffers.add_host_buffer("host_indices", indices);
        Ok(Self {
            buffers,
            layout: Instance {
                vertex_count: mesh.vertex_count,
                triangle_count: mesh.triangle_count,
                vertex_word_first: (first / 4) as u32,
                vertex_words: mesh.vertex_stride / 4,
                index_first: (index_first / u64::from(index_bytes.max(1))) as u32,
                index_bytes,
                ..Instance::default()
            },
        })
    }
}

fn check_mesh(mesh: &Mesh) -> Result<()> {
    let invalid = |text: &str| Err(Error::Invalid(format!("a mesh {text}")));
    let indexed = mesh.indices != vk::Buffer::null();
    if mesh.vertices == vk::Buffer::null() || mesh.vertex_count == 0 || mesh.triangle_count == 0 {
        return invalid("has no vertices or no triangles");
    }
    if mesh.vertex_stride < 12
        || !mesh.vertex_stride.is_multiple_of(4)
        || !mesh.vertex_offset.is_multiple_of(4)
    {
        return invalid("has a stride below 12, or a stride or an offset that is no multiple of 4");
    }
    if indexed && !(mesh.index_bytes == 2 || mesh.index_bytes == 4) {
        return invalid("has indices of 2 or 4 bytes");
    }
    if indexed
        && !mesh
            .index_offset
            .is_multiple_of(u64::from(mesh.index_bytes))
    {
        return invalid("has indices at an offset that is no multiple of their size");
    }
    if !indexed && u64::from(mesh.triangle_count) * 3 > u64::from(mesh.vertex_count) {
        return invalid("without indices has three vertices for each triangle");
    }
    Ok(())
}
