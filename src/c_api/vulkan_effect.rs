//! Effects in a host's frames.

use super::call::call;
use super::call_result::{CallResult, Fault};
use super::check::{flag, input, output, place, structures_of};
use super::context::{CONTEXTS, Held};
use super::convert::{self, choice, reserved};
use super::handles::Registry;
use super::types::*;
use super::vulkan_frame::{Frames, record};
use super::vulkan_frame_types::*;
use super::vulkan_lend::{mesh_of, slot_of};
use super::vulkan_names::*;
use super::vulkan_types::*;
use crate::frame::{Casters, Surface};
use crate::plan::HostFrame;
use crate::render::{DEFAULT_COSTS, Effect};
use crate::shared::{Costs, NORMAL_OCTAHEDRAL, NORMAL_SIGNED, NORMAL_UNSIGNED, Projection};
use crate::technique::{Settings, Technique};

/// All living effects.
pub static EFFECTS: Registry<hs_vk_effect, Held<Frames>> = Registry::new("effect");

/// Creates an effect on the context of hs_vk_context_create. It checks and plans, and takes hardly any memory; that is
/// for hs_vk_effect_prepare. HS_UNSUPPORTED when the device's limits do not allow it. On failure `*effect` is NULL.
///
/// Any thread.
///
/// # Safety
/// `info` points to a structure whose pointers are as it says, `effect` to a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_vk_effect_create(
    context: *mut hs_context,
    info: *const hs_vk_effect_info,
    effect: *mut *mut hs_vk_effect,
) -> hs_result {
    call(|scope| {
        // SAFETY: the caller's promise, here and below.
        let target = unsafe { place(effect, "the pointer to the effect") }?;
        *target = std::ptr::null_mut();
        let context = CONTEXTS.enter(scope, context)?;
        let info = unsafe { input(info) }?;
        reserved(info.reserved)?;
        if context.gpu()?.has_queue() {
            return Err(Fault::new(
                HS_UNSUPPORTED,
                "effects are for a host's device; create the context with hs_vk_context_create",
            ));
        }
        let settings = match info.settings.is_null() {
            true => Settings::usual(Technique::PacketContour),
            false => unsafe { convert::settings(info.settings) }?,
        };
        let all = [Casters::Gathered, Casters::DrawnByHost, Casters::Maps];
        let surfaces = [Surface::Depths, Surface::Positions];
        let host = HostFrame {
            size: (info.width, info.height),
            surface: choice(&surfaces, info.surface, "surface")?,
            light: unsafe { convert::light(info.light) }?,
            settings,
            casters: choice(&all, info.casters, "casters")?,
            side_faces: flag(info.side_faces, "side_faces")?,
            instances: info.instance_max,
            vertices: info.vertex_max,
            triangles: info.triangle_max,
        };
        let encodings = [NORMAL_SIGNED, NORMAL_UNSIGNED, NORMAL_OCTAHEDRAL];
        let or = |given: f32, usual: f32| if given == 0.0 { usual } else { given };
        let costs = Costs {
            edge: or(info.edge_cost, DEFAULT_COSTS.edge),
            visibility: or(info.visibility_cost, DEFAULT_COSTS.visibility),
        };
        let frames = Frames {
            effect: Effect::new(context.gpu()?, host, costs)?,
            normals: choice(&encodings, info.normals, "normals")?,
        };
        *target = EFFECTS.add(Held::new(&context, frames))?;
        Ok(())
    })
}

/// Lets go of an effect and of all that it took; NULL is fine. The host has made sure that the device has finished all
/// frames that were recorded with it. A handle that was destroyed before is ignored.
///
/// Any thread. Other threads' calls on it finish.
#[unsafe(no_mangle)]
pub extern "C" fn hs_vk_effect_destroy(effect: *mut hs_vk_effect) {
    EFFECTS.remove(effect);
}

/// Takes all memory and creates all pipelines for frames with these images and meshes; seconds where the driver has to
/// compile. It may be called again when images or meshes change: what frames before it use stays until
/// hs_vk_effect_collect hears that they have finished. On failure all is as it was before.
///
/// Any thread; calls on one effect wait for one another.
///
/// # Safety
/// `info` points to a structure whose arrays have the stated numbers of elements. Images and buffers are of the
/// context's device, as described, and stay until the next preparation's frames alone are in use or the effect is
/// destroyed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_vk_effect_prepare(
    effect: *mut hs_vk_effect,
    info: *const hs_vk_prepare_info,
) -> hs_result {
    with(effect, |frames| {
        // SAFETY: the caller's promise, here and below.
        let info = unsafe { input(info) }?;
        let slots = unsafe { structures_of(info.slots, info.slot_count, "slots") }?;
        let slots = (slots.iter()).map(|slot| unsafe { slot_of(slot) });
        let slots = slots.collect::<CallResult<Vec<_>>>()?;
        let meshes = unsafe { structures_of(info.meshes, info.mesh_count, "meshes") }?;
        let meshes = meshes.iter().map(mesh_of).collect::<CallResult<Vec<_>>>()?;
        unsafe { frames.effect.prepare(&slots, &meshes) }?;
        Ok(())
    })
}

/// Records a frame into the host's command buffer: barriers, passes, barriers. It submits nothing, waits for nothing,
/// takes no memory and reads nothing back. HS_NOT_READY before hs_vk_effect_prepare. On failure nothing is recorded.
///
/// The command buffer is in the recording state, outside of rendering, of the family that the context was told; bound
/// pipelines, descriptor sets, push constants, viewport and scissor are lost. Frames are submitted to one queue, in the
/// order of recording; a command buffer may be submitted again as long as none with a later frame was.
///
/// Any thread; calls on one effect wait for one another.
///
/// # Safety
/// As above, and `frame` points to a structure whose pointers are as it says. Images and meshes that frames name are
/// as they were described when the commands run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_vk_effect_record(
    effect: *mut hs_vk_effect,
    command_buffer: VkCommandBuffer,
    frame: *const hs_vk_frame,
) -> hs_result {
    with(effect, |frames| {
        // SAFETY: the caller's promise.
        unsafe { record(frames, command_buffer, &input(frame)?) }
    })
}

/// Lets go of what only frames up to `completed_serial`, which the device has finished, have used. A frame that was not
/// recorded yet is refused.
///
/// Any thread; calls on one effect wait for one another.
#[unsafe(no_mangle)]
pub extern "C" fn hs_vk_effect_collect(
    effect: *mut hs_vk_effect,
    completed_serial: u64,
) -> hs_result {
    with(effect, |frames| {
        frames.effect.collect(completed_serial)?;
        Ok(())
    })
}

/// Tells what an effect has.
///
/// Any thread; calls on one effect wait for one another.
///
/// # Safety
/// `state` points to a structure with `type` and `size` set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_vk_effect_describe(
    effect: *mut hs_vk_effect,
    state: *mut hs_vk_effect_state,
) -> hs_result {
    with(effect, |frames| {
        // SAFETY: the caller's promise.
        let target = unsafe { output(state) }?;
        let plan = frames.effect.plan();
        target.memory_bytes = frames.effect.memory_bytes();
        target.projections = frames.effect.projections();
        target.projection_stride = size_of::<Projection>() as u32;
        target.view_count = plan.views().count() as u32;
        target.pass_count = plan.steps().count() as u32;
        target.prepared = u32::from(frames.effect.is_prepared());
        Ok(())
    })
}

/// Runs `work` on an effect.
fn with(effect: *mut hs_vk_effect, work: impl FnOnce(&mut Frames) -> CallResult) -> hs_result {
    call(|scope| EFFECTS.enter(scope, effect)?.with(work))
}
