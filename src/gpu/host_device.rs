//! A device that belongs to a host.

use ash::vk;

/// A host's device, and what the host has enabled on it.
pub struct HostDevice {
    pub get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    pub instance: vk::Instance,
    pub physical: vk::PhysicalDevice,
    pub device: vk::Device,
    /// That of the instance and of the device, whichever is less.
    pub api_version: u32,
    /// Names of the instance's extensions that matter here: VK_EXT_debug_utils, or none.
    pub debug_utils: bool,
    pub enabled: Enabled,
    /// With graphics and compute.
    pub family: u32,
    pub callbacks: Option<vk::AllocationCallbacks<'static>>,
}

/// Required features that a host has enabled.
#[derive(Debug, Clone, Copy, Default)]
pub struct Enabled {
    pub shader_storage_image_extended_formats: bool,
    pub scalar_block_layout: bool,
    pub dynamic_rendering: bool,
    pub synchronization2: bool,
    pub maintenance4: bool,
}
