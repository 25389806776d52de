//! A host's device: what it needs, and a context on it.

use std::ffi::{CStr, c_char};

use ash::vk;

use super::call::call;
use super::call_result::{CallResult, Fault};
use super::check::{input, output, place, slice, write_text};
use super::context::CONTEXTS;
use super::context::{Context, Log};
use super::types::*;
use super::vulkan_features::{enabled, require};
use super::vulkan_names::*;
use super::vulkan_types::*;
use crate::gpu::{FORMATS, Gpu, HostDevice, ImageKind, QUEUE_FLAGS, lacking};

/// Names of instance extensions, for C.
struct Names([*const c_char; 1]);

// SAFETY: the names are constants.
unsafe impl Sync for Names {}

static RECOMMENDED: Names = Names([ash::ext::debug_utils::NAME.as_ptr()]);

/// Tells what a device must be and be created with. With `features` not NULL, it also sets the required features in
/// that chain, which must hold VkPhysicalDeviceFeatures2 first and in it VkPhysicalDeviceVulkan12Features and
/// VkPhysicalDeviceVulkan13Features or the structures of the single features; all others stay as they are.
///
/// Any thread. The sentence of a failure is this thread's.
///
/// # Safety
/// The handles are alive and belong together; `features` is NULL or a chain of Vulkan's structures; `requirements`
/// points to a structure with `type` and `size` set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_vk_query_requirements(
    instance: VkInstance,
    physical_device: VkPhysicalDevice,
    get_instance_proc_addr: PFN_vkGetInstanceProcAddr,
    features: *mut VkPhysicalDeviceFeatures2,
    requirements: *mut hs_vk_requirements,
) -> hs_result {
    call(|_| {
        // SAFETY: the caller's promise, here and below.
        let target = unsafe { output(requirements) }?;
        let get_instance_proc_addr =
            check_handles(instance, physical_device, get_instance_proc_addr)?;
        let missing = unsafe { lacking(get_instance_proc_addr, instance, physical_device) }?;
        if !features.is_null() {
            unsafe { require(features) }?;
        }
        target.api_version = vk::API_VERSION_1_3;
        target.queue_flags = QUEUE_FLAGS;
        target.required_extension_count = 0;
        target.recommended_extension_count = RECOMMENDED.0.len() as u32;
        target.recommended_extensions = RECOMMENDED.0.as_ptr();
        for (format, (known, features, _)) in target.formats.iter_mut().zip(FORMATS) {
            (format.format, format.features) = (known, features);
        }
        target.sampled_usage = vk::ImageUsageFlags::SAMPLED;
        target.visibility_usage = vk::ImageUsageFlags::COLOR_ATTACHMENT;
        target.mesh_usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        target.shadow_map_format = ImageKind::Depth.format();
        target.usable = u32::from(missing.is_empty());
        target.reserved = 0;
        write_text(&mut target.missing, &missing.join(", "));
        Ok(())
    })
}

fn check_handles(
    instance: VkInstance,
    physical: VkPhysicalDevice,
    get_instance_proc_addr: PFN_vkGetInstanceProcAddr,
) -> CallResult<vk::PFN_vkGetInstanceProcAddr> {
    match get_instance_proc_addr {
        Some(function)
            if instance != vk::Instance::null() && physical != vk::PhysicalDevice::null() =>
        {
            Ok(function)
        }
        _ => Err(Fault::invalid(
            "instance, physical_device or get_instance_proc_addr is NULL",
        )),
    }
}

/// Creates a context on a host's device, for effects. It has no queue: it submits nothing, and hs_renderer_create on it
/// ends with HS_UNSUPPORTED, while scenes, shots and hs_reference work. HS_UNSUPPORTED when the device lacks something
/// or the host has not enabled it. On failure `*context` is NULL and the sentence is this thread's.
///
/// Any thread; contexts know nothing of each other.
///
/// # Safety
/// `info` points to a structure whose handles are alive, belong together and outlive all that is created in the
/// context; what it says to be enabled is; `context` points to a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hs_vk_context_create(
    info: *const hs_vk_device_info,
    context: *mut *mut hs_context,
) -> hs_result {
    call(|_| {
        // SAFETY: the caller's promise, here and below.
        let target = unsafe { place(context, "the pointer to the context") }?;
        *target = std::ptr::null_mut();
        let info = unsafe { input(info) }?;
        let get_instance_proc_addr = check_handles(
            info.instance,
            info.physical_device,
            info.get_instance_proc_addr,
        )?;
        if info.device == vk::Device::null() {
            return Err(Fault::invalid("device is NULL"));
        }
        let host = HostDevice {
            get_instance_proc_addr,
            instance: info.instance,
            physical: info.physical_device,
            device: info.device,
            api_version: info.api_version,
            debug_utils: unsafe { names(&info, ash::ext::debug_utils::NAME) }?,
            enabled: unsafe { enabled(info.features) }?,
            family: info.queue_family,
            callbacks: unsafe { callbacks(info.allocator) }?,
        };
        let log = Log {
            callback: info.log,
            user: info.log_user,
        };
        let gpu = unsafe { Gpu::adopt(host) }?;
        *target = CONTEXTS.add(Context::new(Some(gpu), log))?;
        Ok(())
    })
}

/// Whether the host has enabled an extension.
///
/// # Safety
/// `extensions` has the stated number of elements, each a text with a NUL at its end.
unsafe fn names(info: &hs_vk_device_info, extension: &CStr) -> CallResult<bool> {
    /// More than any device has.
    const MOST: u64 = 65536;
    if info.extension_count > MOST {
        return Err(Fault::invalid(format!(
            "{} extensions are more than {MOST}",
            info.extension_count
        )));
    }
    // SAFETY: the caller's promise, here and below.
    let list = unsafe { slice(info.extensions, info.extension_count, "extensions") }?;
    if list.iter().any(|name| name.is_null()) {
        return Err(Fault::invalid("the name of an extension is NULL"));
    }
    Ok((list.iter()).any(|name| unsafe { CStr::from_ptr(*name) } == extension))
}

/// A copy of the host's functions; the three that matter are there or none is.
///
/// # Safety
/// `allocator` is NULL or points to Vulkan's structure.
unsafe fn callbacks(
    allocator: *const VkAllocationCallbacks,
) -> CallResult<Option<VkAllocationCallbacks>> {
    if allocator.is_null() {
        return Ok(None);
    }
    if !allocator.is_aligned() {
        return Err(Fault::invalid("allocator is not aligned"));
    }
    // SAFETY: the caller's promise.
    let callbacks = unsafe { *allocator };
    match (
        callbacks.pfn_allocation,
        callbacks.pfn_reallocation,
        callbacks.pfn_free,
    ) {
        (Some(_), Some(_), Some(_)) => Ok(Some(callbacks)),
        _ => Err(Fault::invalid(
            "allocator lacks pfnAllocation, pfnReallocation or pfnFree",
        )),
    }
}
