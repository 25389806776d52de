//! What a device is made of.

use ash::{khr, vk};
use gpu_allocator::AllocationSizes;
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};

use super::failed::failed;
use super::requirements::Features;
use crate::error::{Error, Result};

pub(super) fn create_device(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    family: u32,
    costs: bool,
) -> Result<ash::Device> {
    let mut features = Features::required();
    let queues = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(family)
        .queue_priorities(&[1.0])];
    let mut told = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default()
        .pipeline_executable_info(true);
    let extensions = [khr::pipeline_executable_properties::NAME.as_ptr()];
    let mut info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_features(&features.core)
        .push_next(&mut features.v12)
        .push_next(&mut features.v13);
    if costs {
        info = info
            .enabled_extension_names(&extensions)
            .push_next(&mut told);
    }
    // SAFETY: all that `info` points to outlives the call; the features were found to be there.
    unsafe { instance.create_device(physical, &info, None) }.map_err(failed("vkCreateDevice"))
}

/// Whether the driver says what pipelines cost.
pub(super) fn tells_costs(instance: &ash::Instance, physical: vk::PhysicalDevice) -> bool {
    let name = khr::pipeline_executable_properties::NAME;
    // SAFETY: the device is the instance's.
    let extensions = unsafe { instance.enumerate_device_extension_properties(physical) };
    let extensions = extensions.unwrap_or_default();
    let is_it =
        |extension: &vk::ExtensionProperties| extension.extension_name_as_c_str() == Ok(name);
    extensions.iter().any(is_it)
}

pub(super) fn create_allocator(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    device: &ash::Device,
) -> Result<Allocator> {
    Allocator::new(&AllocatorCreateDesc {
        instance: instance.clone(),
        device: device.clone(),
        physical_device: physical,
        debug_settings: Default::default(),
        buffer_device_address: false,
        // A large resource has a block of its own; what small ones share shall not count against a budget.
        allocation_sizes: AllocationSizes::new(16 << 20, 8 << 20),
    })
    .map_err(|error| Error::Memory {
        resource: "the allocator".into(),
        message: error.to_string(),
    })
}

/// The stored pipeline cache, or an empty one; a null handle where even that fails: it is optional.
pub(super) fn create_cache(
    device: &ash::Device,
    file: Option<&std::path::Path>,
    callbacks: Option<&vk::AllocationCallbacks>,
) -> vk::PipelineCache {
    let stored = file
        .and_then(|file| std::fs::read(file).ok())
        .unwrap_or_default();
    // SAFETY: the driver checks the header of the data and ignores what is not its own.
    unsafe {
        device
            .create_pipeline_cache(
                &vk::PipelineCacheCreateInfo::default().initial_data(&stored),
                callbacks,
            )
            .or_else(|_| {
                device.create_pipeline_cache(&vk::PipelineCacheCreateInfo::default(), callbacks)
            })
            .unwrap_or_default()
    }
}

pub(super) fn tick_ns(instance: &ash::Instance, physical: vk::PhysicalDevice, family: u32) -> f64 {
    // SAFETY: plain queries on a device of this instance.
    let (properties, families) = unsafe {
        (
            instance.get_physical_device_properties(physical),
            instance.get_physical_device_queue_family_properties(physical),
        )
    };
    if families[family as usize].timestamp_valid_bits == 0 {
        0.0
    } else {
        properties.limits.timestamp_period.into()
    }
}
