//! Memory and pipelines of an effect, for the images and meshes that a host lends.

use std::sync::Arc;

use ash::vk;

use super::super::chain::{Chain, Loans};
use super::super::recording::Inputs;
use super::super::resources;
use super::input::{Mesh, SlotImages};
use super::surface::{Rounding, is_fractional_color, rounding};
use crate::error::{Error, Result};
use crate::frame::Casters;
use crate::gpu::{Commands, Gpu, HostBuffer, HostImage, HostImageInfo, Loan, Resources};
use crate::plan::{HostFrame, Plan};
use crate::shared::{Costs, Instance};

/// Most slots of images.
const MAX_SLOTS: usize = 64;
/// Most meshes.
const MAX_MESHES: usize = 65536;

pub struct Prepared {
    pub resources: Resources,
    pub slots: Vec<Slot>,
    /// The host's shadow maps: those of the first slot's views, then of the next slot's.
    maps: Vec<Resources>,
    /// Of each mesh, what all its instances have in common.
    pub layouts: Vec<Instance>,
    chain: Chain,
    /// The serial of the last frame that was recorded with it; 0 = none was.
    pub last: u64,
}

/// The images of a slot.
pub struct Slot {
    /// How exactly its image holds the surface.
    pub rounding: Rounding,
    inputs: Resources,
    output: HostImage,
}

impl Prepared {
    /// # Safety
    /// As for `Effect::prepare`.
    pub unsafe fn new(
        gpu: &Arc<Gpu>,
        host: &HostFrame,
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
        let meshes = meshes.iter().map(|mesh| unsafe { mesh_buffers(gpu, mesh) });
        let (meshes, layouts): (Vec<_>, Vec<_>) =
            meshes.collect::<Result<Vec<_>>>()?.into_iter().unzip();
        let loans = Loans {
            surfaces: lent.iter().map(|slot| &slot.inputs).collect(),
            meshes: meshes.iter().collect(),
            maps: maps.iter().collect(),
            output: lent[0].output.format(),
        };
        Ok(Self {
            chain: Chain::new(gpu, plan, &resources, &loans)?,
            resources,
            slots: lent,
            maps,
            layouts,
            last: 0,
        })
    }

    /// Records all passes of a frame.
    pub fn record(&self, commands: &mut Commands, plan: &Plan, inputs: &mut Inputs) -> Result<()> {
        let slot = &self.slots[inputs.slot];
        let view_count = plan.views().count();
        let maps = match plan.casters {
            Casters::Maps => &self.maps[inputs.slot * view_count..][..view_count],
            _ => &[],
        };
        let lent = || {
            let maps = maps.iter().flat_map(Resources::host_images);
            slot.inputs.host_images().chain(maps).chain([&slot.output])
        };
        inputs.output = Some(slot.output.target());
        commands.initialize(&self.resources);
        lent().for_each(|image| commands.acquire(image));
        self.chain
            .record(commands, plan, &self.resources, inputs, |_| true)?;
        lent().for_each(|image| commands.release(image));
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
            "{name} is an image of {}x{}; it must be one of {}x{}",
            image.size.0, image.size.1, size.0, size.1
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
        let rounding = rounding(images.surface.format, host.surface)?;
        for (name, image) in [
            ("normal", &images.normal),
            ("visibility", &images.visibility),
        ] {
            if !is_fractional_color(image.format) {
                return Err(Error::Invalid(format!(
                    "{name}: {:?} is no colour of fractions; lend a UNORM, SNORM or SFLOAT format",
                    image.format
                )));
            }
        }
        let of_image = |image: &HostImageInfo| (image.raw, image.layer, image.level);
        for (name, image) in [("surface", &images.surface), ("normal", &images.normal)] {
            if of_image(image) == of_image(&images.visibility) {
                return Err(Error::Invalid(format!(
                    "visibility is the same image as {name}; the result needs an image of its own"
                )));
            }
        }
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
            rounding,
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

/// The buffers of a mesh as passes see them, and what all its instances have in common.
///
/// # Safety
/// As for `Effect::prepare`.
unsafe fn mesh_buffers(gpu: &Gpu, mesh: &Mesh) -> Result<(Resources, Instance)> {
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
        let bytes =
            (3 * u64::from(mesh.triangle_count) * u64::from(mesh.index_bytes)).next_multiple_of(4);
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
    let layout = Instance {
        vertex_count: mesh.vertex_count,
        triangle_count: mesh.triangle_count,
        vertex_word_first: (first / 4) as u32,
        vertex_words: mesh.vertex_stride / 4,
        index_first: (index_first / u64::from(index_bytes.max(1))) as u32,
        index_bytes,
        ..Instance::default()
    };
    Ok((buffers, layout))
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
