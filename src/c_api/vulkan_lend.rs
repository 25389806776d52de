//! Images and meshes that a host lends.

use ash::vk;

use super::call_result::{CallResult, Fault};
use super::check::{input, structures_of};
use super::vulkan_frame_types::*;
use crate::gpu::{HostImageInfo, ImageState};
use crate::render::{Mesh, SlotImages};

fn image_of(
    given: &hs_vk_image,
    needed: vk::ImageUsageFlags,
    name: &str,
) -> CallResult<HostImageInfo> {
    if given.image == vk::Image::null() {
        return Err(Fault::invalid(format!("{name}: the image is NULL")));
    }
    if !given.usage.contains(needed) {
        return Err(Fault::invalid(format!(
            "{name}: the image must be created with the usage {needed:?}"
        )));
    }
    let found = ImageState {
        layout: given.current_layout,
        stage: given.current_stage,
        access: given.current_access,
    };
    let left = match given.final_layout {
        vk::ImageLayout::UNDEFINED => found,
        layout => ImageState {
            layout,
            stage: given.final_stage,
            access: given.final_access,
        },
    };
    if matches!(
        left.layout,
        vk::ImageLayout::UNDEFINED | vk::ImageLayout::PREINITIALIZED
    ) {
        return Err(Fault::invalid(format!(
            "{name}: the image cannot be left in an undefined layout; state final_layout"
        )));
    }
    let read = needed == vk::ImageUsageFlags::SAMPLED;
    if read && found.layout == vk::ImageLayout::UNDEFINED {
        return Err(Fault::invalid(format!(
            "{name}: what is read is not in an undefined layout; state current_layout"
        )));
    }
    Ok(HostImageInfo {
        raw: given.image,
        format: given.format,
        size: (given.width, given.height),
        layer: given.layer,
        level: given.level,
        found,
        left,
    })
}

/// # Safety
/// The slot's pointers are as it says.
pub unsafe fn slot_of(given: &hs_vk_slot) -> CallResult<SlotImages> {
    let sampled = vk::ImageUsageFlags::SAMPLED;
    // SAFETY: the caller's promise, here and below.
    let (surface, normal, visibility) = unsafe {
        (
            input(given.surface)?,
            input(given.normal)?,
            input(given.visibility)?,
        )
    };
    let maps = unsafe { structures_of(given.maps, given.map_count, "maps") }?;
    Ok(SlotImages {
        surface: image_of(&surface, sampled, "surface")?,
        normal: image_of(&normal, sampled, "normal")?,
        visibility: image_of(
            &visibility,
            vk::ImageUsageFlags::COLOR_ATTACHMENT,
            "visibility",
        )?,
        casters: (maps.iter())
            .map(|map| image_of(map, sampled, "map"))
            .collect::<CallResult<_>>()?,
    })
}

pub fn mesh_of(given: &hs_vk_mesh) -> CallResult<Mesh> {
    let index_bytes = match given.index_type {
        vk::IndexType::UINT16 => 2,
        vk::IndexType::UINT32 => 4,
        _ if given.indices == vk::Buffer::null() => 0,
        _ => {
            return Err(Fault::invalid(
                "a mesh has indices of VK_INDEX_TYPE_UINT16 or VK_INDEX_TYPE_UINT32",
            ));
        }
    };
    Ok(Mesh {
        vertices: given.vertices,
        vertex_offset: given.vertex_offset,
        vertex_stride: given.vertex_stride,
        vertex_count: given.vertex_count,
        indices: given.indices,
        index_offset: given.index_offset,
        index_bytes,
        triangle_count: given.triangle_count,
    })
}
