//! What the engine needs of a device, checked one by one and reported by name.

use ash::vk;

use super::host_device::{Enabled, HostDevice};
use crate::error::{Error, Result};

/// What a device allows, as far as the engine's sizes depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// [texel] Largest side of an image.
    pub image_side: u32,
    /// [layer] Most layers of an image.
    pub image_layers: u32,
    /// [byte] Largest image (asked for the hierarchy's kind).
    pub image_bytes: u64,
    /// [byte] Largest storage buffer that a shader can see.
    pub buffer_bytes: u64,
    /// [byte] Memory of the largest device-local heap.
    pub memory_bytes: u64,
    /// [byte] Memory that a frame may take, however much there is.
    pub allowed_bytes: u64,
    /// [byte] What offsets of storage buffers are multiples of.
    pub storage_alignment: u64,
    /// Whether draws into R32_SFLOAT can add up.
    pub adds_floats: bool,
    /// Shaders run on the CPU.
    pub is_cpu: bool,
    /// [turn] Loop turns after which the driver ends all loops of an invocation, whatever their conditions.
    pub loop_turns: u32,
}

impl Limits {
    /// [turn] Where a driver leaves loops alone.
    pub const ENDLESS_LOOPS: u32 = u32::MAX;

    /// [byte] That a frame can take.
    pub fn bytes_max(&self) -> u64 {
        self.memory_bytes.min(self.allowed_bytes)
    }
}

/// [turn] lavapipe allows 65535 in sum over all loops and over the lanes of a vector, which wait for one another; the
/// passes count only those of their large loops. Where the pixels of packets disagree in most cells, up to twice as many
/// turns are taken as are counted: 60000 lost edges there, 30000 loses none.
const LAVAPIPE_LOOP_TURNS: u32 = 30000;

/// The features that are enabled: all of these are required.
#[derive(Default)]
pub struct Features {
    pub core: vk::PhysicalDeviceFeatures,
    pub v12: vk::PhysicalDeviceVulkan12Features<'static>,
    pub v13: vk::PhysicalDeviceVulkan13Features<'static>,
}

impl Features {
    /// What the engine uses, and nothing else.
    pub fn required() -> Self {
        Self {
            core: vk::PhysicalDeviceFeatures {
                shader_storage_image_extended_formats: vk::TRUE,
                ..Default::default()
            },
            v12: vk::PhysicalDeviceVulkan12Features::default().scalar_block_layout(true),
            v13: vk::PhysicalDeviceVulkan13Features::default()
                .dynamic_rendering(true)
                .synchronization2(true)
                .maintenance4(true),
        }
    }
}

/// Formats and how each is used.
pub const FORMATS: [(vk::Format, vk::FormatFeatureFlags, &str); 5] = [
    (
        vk::Format::D32_SFLOAT,
        vk::FormatFeatureFlags::from_raw(
            vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT.as_raw()
                | vk::FormatFeatureFlags::SAMPLED_IMAGE.as_raw(),
        ),
        "D32_SFLOAT as a sampled depth attachment",
    ),
    (
        vk::Format::R32G32_SFLOAT,
        vk::FormatFeatureFlags::from_raw(
            vk::FormatFeatureFlags::STORAGE_IMAGE.as_raw()
                | vk::FormatFeatureFlags::SAMPLED_IMAGE.as_raw(),
        ),
        "R32G32_SFLOAT as a sampled storage image",
    ),
    (
        vk::Format::R16G16_SFLOAT,
        vk::FormatFeatureFlags::from_raw(
            vk::FormatFeatureFlags::STORAGE_IMAGE.as_raw()
                | vk::FormatFeatureFlags::SAMPLED_IMAGE.as_raw(),
        ),
        "R16G16_SFLOAT as a sampled storage image",
    ),
    (
        vk::Format::R32G32B32A32_SFLOAT,
        vk::FormatFeatureFlags::from_raw(
            vk::FormatFeatureFlags::COLOR_ATTACHMENT.as_raw()
                | vk::FormatFeatureFlags::STORAGE_IMAGE.as_raw()
                | vk::FormatFeatureFlags::SAMPLED_IMAGE.as_raw(),
        ),
        "R32G32B32A32_SFLOAT as a sampled colour attachment and storage image",
    ),
    (
        vk::Format::R8G8B8A8_UNORM,
        vk::FormatFeatureFlags::from_raw(
            vk::FormatFeatureFlags::COLOR_ATTACHMENT.as_raw()
                | vk::FormatFeatureFlags::SAMPLED_IMAGE.as_raw(),
        ),
        "R8G8B8A8_UNORM as a sampled colour attachment",
    ),
];

/// [descriptor] Storage buffers that the largest pass binds.
const STORAGE_BUFFERS: u32 = 13;
/// [invocation] Largest work group.
const GROUP_INVOCATIONS: u32 = 64;

/// What a queue family must be able to do.
pub const QUEUE_FLAGS: vk::QueueFlags =
    vk::QueueFlags::from_raw(vk::QueueFlags::GRAPHICS.as_raw() | vk::QueueFlags::COMPUTE.as_raw());

/// A queue family that can do everything, if there is one.
pub fn queue_family(instance: &ash::Instance, device: vk::PhysicalDevice) -> Option<u32> {
    // SAFETY: the device was enumerated from this instance.
    let families = unsafe { instance.get_physical_device_queue_family_properties(device) };
    families
        .iter()
        .position(|family| family.queue_flags.contains(QUEUE_FLAGS))
        .map(|index| index as u32)
}

fn driver_id(instance: &ash::Instance, device: vk::PhysicalDevice) -> vk::DriverId {
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
    // SAFETY: the device was enumerated from this instance, and the chain outlives the call.
    unsafe { instance.get_physical_device_properties2(device, &mut properties) };
    driver.driver_id
}

pub fn limits(instance: &ash::Instance, device: vk::PhysicalDevice) -> Limits {
    // SAFETY: the device was enumerated from this instance.
    let (properties, memory) = unsafe {
        (
            instance.get_physical_device_properties(device),
            instance.get_physical_device_memory_properties(device),
        )
    };
    let driver = driver_id(instance, device);
    let heaps = memory.memory_heaps_as_slice().iter();
    // SAFETY: as above.
    let array = unsafe {
        instance.get_physical_device_image_format_properties(
            device,
            vk::Format::R32G32_SFLOAT,
            vk::ImageType::TYPE_2D,
            vk::ImageTiling::OPTIMAL,
            vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED,
            vk::ImageCreateFlags::empty(),
        )
    };
    Limits {
        image_bytes: array.map(|found| found.max_resource_size).unwrap_or(0),
        image_side: properties.limits.max_image_dimension2_d,
        image_layers: properties.limits.max_image_array_layers,
        buffer_bytes: properties.limits.max_storage_buffer_range.into(),
        memory_bytes: heaps
            .filter(|heap| heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL))
            .map(|heap| heap.size)
            .max()
            .unwrap_or(0),
        allowed_bytes: u64::MAX,
        storage_alignment: properties.limits.min_storage_buffer_offset_alignment.max(1),
        adds_floats: adds_floats(instance, device),
        is_cpu: properties.device_type == vk::PhysicalDeviceType::CPU,
        loop_turns: match driver {
            vk::DriverId::MESA_LLVMPIPE => LAVAPIPE_LOOP_TURNS,
            _ => Limits::ENDLESS_LOOPS,
        },
    }
}

fn adds_floats(instance: &ash::Instance, device: vk::PhysicalDevice) -> bool {
    let format = vk::Format::R32_SFLOAT;
    // SAFETY: the device was enumerated from this instance.
    let found = unsafe { instance.get_physical_device_format_properties(device, format) };
    let needed = vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
    found.optimal_tiling_features.contains(needed)
}

/// The names of everything required that the device lacks; empty = it can run the engine.
pub fn missing(instance: &ash::Instance, device: vk::PhysicalDevice) -> Vec<String> {
    let mut missing = Vec::new();
    // SAFETY: the device was enumerated from this instance.
    let properties = unsafe { instance.get_physical_device_properties(device) };
    if properties.api_version < vk::API_VERSION_1_3 {
        let (major, minor) = (
            vk::api_version_major(properties.api_version),
            vk::api_version_minor(properties.api_version),
        );
        missing.push(format!("Vulkan 1.3 (it has {major}.{minor})"));
        return missing;
    }
    missing_features(instance, device, &mut missing);
    for (format, features, name) in FORMATS {
        // SAFETY: the device was enumerated from this instance.
        let found = unsafe { instance.get_physical_device_format_properties(device, format) };
        if !found.optimal_tiling_features.contains(features) {
            missing.push(name.into());
        }
    }
    missing.extend(missing_subgroup_operations(instance, device));
    let limits = &properties.limits;
    if limits.max_per_stage_descriptor_storage_buffers < STORAGE_BUFFERS {
        missing.push(format!(
            "maxPerStageDescriptorStorageBuffers ≥ {STORAGE_BUFFERS}"
        ));
    }
    if limits.max_compute_work_group_invocations < GROUP_INVOCATIONS {
        missing.push(format!(
            "maxComputeWorkGroupInvocations ≥ {GROUP_INVOCATIONS}"
        ));
    }
    if queue_family(instance, device).is_none() {
        missing.push("a queue family with graphics and compute".into());
    }
    missing
}

/// What compute shaders do with the invocations of a subgroup.
const SUBGROUP_OPERATIONS: [(vk::SubgroupFeatureFlags, &str); 4] = [
    (vk::SubgroupFeatureFlags::ARITHMETIC, "arithmetic"),
    (vk::SubgroupFeatureFlags::VOTE, "vote"),
    (vk::SubgroupFeatureFlags::BALLOT, "ballot"),
    (vk::SubgroupFeatureFlags::SHUFFLE, "shuffle"),
];

fn missing_subgroup_operations(
    instance: &ash::Instance,
    device: vk::PhysicalDevice,
) -> impl Iterator<Item = String> {
    let mut subgroups = vk::PhysicalDeviceSubgroupProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut subgroups);
    // SAFETY: the device was enumerated from this instance, and the chain outlives the call.
    unsafe { instance.get_physical_device_properties2(device, &mut properties) };
    let there = match (subgroups.supported_stages).contains(vk::ShaderStageFlags::COMPUTE) {
        true => subgroups.supported_operations,
        false => vk::SubgroupFeatureFlags::empty(),
    };
    let missing = (SUBGROUP_OPERATIONS.into_iter()).filter(move |&(flag, _)| !there.contains(flag));
    missing.map(|(_, name)| format!("subgroup {name} in compute shaders"))
}

/// The names of required features that are off.
fn off(enabled: &Enabled) -> impl Iterator<Item = &'static str> {
    [
        (
            enabled.shader_storage_image_extended_formats,
            "shaderStorageImageExtendedFormats",
        ),
        (enabled.scalar_block_layout, "scalarBlockLayout"),
        (enabled.dynamic_rendering, "dynamicRendering"),
        (enabled.synchronization2, "synchronization2"),
        (enabled.maintenance4, "maintenance4"),
    ]
    .into_iter()
    .filter_map(|(on, name)| (!on).then_some(name))
}

fn missing_features(
    instance: &ash::Instance,
    device: vk::PhysicalDevice,
    missing: &mut Vec<String>,
) {
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut found = vk::PhysicalDeviceFeatures2::default()
        .push_next(&mut v12)
        .push_next(&mut v13);
    // SAFETY: the device was enumerated from this instance, and the chain outlives the call.
    unsafe { instance.get_physical_device_features2(device, &mut found) };
    let core = found.features;
    let there = Enabled {
        shader_storage_image_extended_formats: core.shader_storage_image_extended_formats
            == vk::TRUE,
        scalar_block_layout: v12.scalar_block_layout == vk::TRUE,
        dynamic_rendering: v13.dynamic_rendering == vk::TRUE,
        synchronization2: v13.synchronization2 == vk::TRUE,
        maintenance4: v13.maintenance4 == vk::TRUE,
    };
    missing.extend(off(&there).map(str::to_owned));
}

/// The functions of a host's instance.
///
/// # Errors
/// The instance is too old to ask for what is required.
///
/// # Safety
/// The instance is alive, and the function its own.
pub unsafe fn load_instance(
    get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    instance: vk::Instance,
) -> Result<ash::Instance> {
    // A function that is not there would end the program when it is called.
    for name in [c"vkGetPhysicalDeviceFeatures2", c"vkGetDeviceProcAddr"] {
        // SAFETY: the caller's promise.
        if unsafe { get_instance_proc_addr(instance, name.as_ptr()) }.is_none() {
            return Err(Error::Unsupported(format!(
                "the host's instance has no {}; create it for Vulkan 1.3",
                name.to_string_lossy()
            )));
        }
    }
    let functions = ash::StaticFn {
        get_instance_proc_addr,
    };
    // SAFETY: the caller's promise.
    Ok(unsafe { ash::Instance::load(&functions, instance) })
}

/// The names of everything required that a host's device lacks.
///
/// # Errors
/// The instance is too old to ask for what is required.
///
/// # Safety
/// The handles are alive and belong together.
pub unsafe fn lacking(
    get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    instance: vk::Instance,
    physical: vk::PhysicalDevice,
) -> Result<Vec<String>> {
    // SAFETY: the caller's promise.
    let instance = unsafe { load_instance(get_instance_proc_addr, instance) }?;
    Ok(missing(&instance, physical))
}

/// Whether a host's device can run the engine and was created so that it does.
///
/// # Errors
/// [`Error::Unsupported`] with the names of what is missing.
pub fn check_host(instance: &ash::Instance, host: &HostDevice) -> Result<()> {
    let mut lacking = missing(instance, host.physical);
    if host.api_version < vk::API_VERSION_1_3 {
        lacking.push("Vulkan 1.3 asked for by the instance".into());
    }
    lacking.extend(off(&host.enabled).map(|name| format!("{name} enabled")));
    // SAFETY: the device was enumerated from this instance.
    let families = unsafe { instance.get_physical_device_queue_family_properties(host.physical) };
    let serves = families
        .get(host.family as usize)
        .is_some_and(|family| family.queue_flags.contains(QUEUE_FLAGS));
    if !serves {
        lacking.push("graphics and compute in the queue family".into());
    }
    match lacking.is_empty() {
        true => Ok(()),
        false => Err(Error::Unsupported(format!(
            "the host's device lacks {}",
            lacking.join(", ")
        ))),
    }
}
