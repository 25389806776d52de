//! Recording a host's frame.

use ash::vk;

use super::call_result::{CallResult, Fault};
use super::check::structures_of;
use super::convert;
use super::structure::Structure;
use super::types::HS_NOT_READY;
use super::vulkan_frame_types::*;
use crate::render::{DrawnView, Effect, FrameInput, GivenMap, MeshInstance};

/// An effect, and what its frames have in common.
pub struct Frames {
    pub effect: Effect,
    /// One of `shared::NORMAL_…`.
    pub normals: u32,
}

/// Records a frame; takes no memory unless it fails.
///
/// # Safety
/// As for `hs_vk_effect_record`.
pub unsafe fn record(
    frames: &mut Frames,
    commands: vk::CommandBuffer,
    frame: &hs_vk_frame,
) -> CallResult {
    if commands == vk::CommandBuffer::null() {
        return Err(Fault::invalid("the command buffer is NULL"));
    }
    if !frames.effect.is_prepared() {
        return Err(not_ready());
    }
    // SAFETY: the caller's promise, here and below.
    let light = unsafe { convert::light(frame.light) }?;
    let count = frame.instance_count.into();
    let instances = unsafe { structures_of(frame.instances, count, "instances") }?;
    let maps = unsafe { structures_of(frame.maps, frame.map_count.into(), "maps") }?;
    let [x, y, z] = [0, 3, 6].map(|at| [0, 1, 2].map(|row| frame.normal_to_world[at + row]));
    let (callback, user) = (frame.draw, frame.draw_user);
    let projections = frames.effect.projections();
    let map = frames.effect.plan().map;
    let mut draw = |drawn: DrawnView| {
        let view = hs_vk_view {
            r#type: hs_vk_view::TYPE,
            size: size_of::<hs_vk_view>() as u32,
            next: std::ptr::null(),
            command_buffer: commands,
            projections,
            offset: drawn.offset,
            index: drawn.index,
            map,
        };
        if let Some(callback) = callback {
            // SAFETY: the caller's function with the caller's pointer.
            unsafe { callback(&view, user) };
        }
    };
    let mut input = FrameInput {
        serial: frame.serial,
        slot: frame.slot as usize,
        light,
        world_from_clip: columns(&frame.world_from_clip),
        normal_to_world: [x, y, z],
        normal_encoding: frames.normals,
        depth_empty: frame.depth_empty,
        background: frame.background,
        position_error: frame.position_error,
        instances: &mut instances.iter().map(instance_of),
        near: frame.near_distance,
        maps: &mut maps.iter().map(|map| GivenMap {
            clip_from_world: columns(&map.clip_from_world),
            depth_empty: map.depth_empty,
        }),
        draw: callback.is_some().then_some(&mut draw),
    };
    // SAFETY: the caller's promise.
    unsafe { frames.effect.record(commands, &mut input) }?;
    Ok(())
}

fn columns(matrix: &[f32; 16]) -> [[f32; 4]; 4] {
    [0, 4, 8, 12].map(|at| [0, 1, 2, 3].map(|row| matrix[at + row]))
}

fn instance_of(given: &hs_vk_instance) -> MeshInstance {
    MeshInstance {
        mesh: given.mesh as usize,
        transform: [0, 4, 8].map(|at| [0, 1, 2, 3].map(|column| given.transform[at + column])),
    }
}

/// What is not prepared cannot be recorded.
pub fn not_ready() -> Fault {
    Fault::new(
        HS_NOT_READY,
        "nothing is prepared yet; call hs_vk_effect_prepare first",
    )
}
