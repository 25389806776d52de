//! The types and constants of `halfshade_vulkan.h`: devices and effects.

use std::ffi::{c_char, c_void};

use super::structure::structures;
use super::types::*;
use super::vulkan_names::*;

/// `type` of hs_vk_requirements.
pub const HS_TYPE_VK_REQUIREMENTS: u32 = 32;
/// `type` of hs_vk_device_info.
pub const HS_TYPE_VK_DEVICE_INFO: u32 = 33;
/// `type` of hs_vk_effect_info.
pub const HS_TYPE_VK_EFFECT_INFO: u32 = 34;
/// `type` of hs_vk_image.
pub const HS_TYPE_VK_IMAGE: u32 = 35;
/// `type` of hs_vk_slot.
pub const HS_TYPE_VK_SLOT: u32 = 36;
/// `type` of hs_vk_mesh.
pub const HS_TYPE_VK_MESH: u32 = 37;
/// `type` of hs_vk_prepare_info.
pub const HS_TYPE_VK_PREPARE_INFO: u32 = 38;
/// `type` of hs_vk_instance.
pub const HS_TYPE_VK_INSTANCE: u32 = 39;
/// `type` of hs_vk_map.
pub const HS_TYPE_VK_MAP: u32 = 40;
/// `type` of hs_vk_view.
pub const HS_TYPE_VK_VIEW: u32 = 41;
/// `type` of hs_vk_frame.
pub const HS_TYPE_VK_FRAME: u32 = 42;
/// `type` of hs_vk_effect_state.
pub const HS_TYPE_VK_EFFECT_STATE: u32 = 43;

/// Soft shadows of one light at one size and quality, in a host's frames. Opaque.
pub struct hs_vk_effect {
    _private: [u8; 0],
}

/// Elements of `formats` in hs_vk_requirements.
pub const HS_VK_FORMAT_COUNT: u32 = 5;

/// A format that the library's own resources have, optimally tiled.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_vk_format {
    /// Format.
    pub format: VkFormat,
    /// What it must be good for.
    pub features: VkFormatFeatureFlags,
}

/// What a device must be and be created with. Texts are UTF-8 with a NUL at the end.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_vk_requirements {
    /// HS_TYPE_VK_REQUIREMENTS
    pub r#type: u32,
    /// sizeof(hs_vk_requirements)
    pub size: u32,
    /// NULL
    pub next: *mut c_void,
    /// The instance must ask for it and the device have it, or a later one.
    pub api_version: u32,
    /// Required of the queue family that the command buffers are submitted to.
    pub queue_flags: VkQueueFlags,
    /// Device extensions that are required: none, all that is needed is in `api_version`.
    pub required_extension_count: u32,
    /// Instance extensions that are recommended.
    pub recommended_extension_count: u32,
    /// Their names; valid for ever. VK_EXT_debug_utils: names and labels for frame debuggers.
    pub recommended_extensions: *const *const c_char,
    /// Required formats.
    pub formats: [hs_vk_format; 5],
    /// Usage that the host's surface, normal and shadow map images must have.
    pub sampled_usage: VkImageUsageFlags,
    /// Usage that the host's visibility image must have.
    pub visibility_usage: VkImageUsageFlags,
    /// Usage that the host's vertex and index buffers must have, beside what the host itself needs.
    pub mesh_usage: VkBufferUsageFlags,
    /// Format of the shadow maps that a host draws to, for its pipelines.
    pub shadow_map_format: VkFormat,
    /// 1 = the device has all that is required, 0 = it lacks something.
    pub usable: u32,
    /// 0
    pub reserved: u32,
    /// What it lacks, separated by commas.
    pub missing: [c_char; 512],
}

/// A host's device. What is pointed to is read during the call; the handles must stay alive until the context and all
/// that was created in it are destroyed.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_vk_device_info {
    /// HS_TYPE_VK_DEVICE_INFO
    pub r#type: u32,
    /// sizeof(hs_vk_device_info)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// Instance.
    pub instance: VkInstance,
    /// Physical device.
    pub physical_device: VkPhysicalDevice,
    /// Device.
    pub device: VkDevice,
    /// All of Vulkan is called through it.
    pub get_instance_proc_addr: PFN_vkGetInstanceProcAddr,
    /// What VkApplicationInfo asked for, VK_API_VERSION_1_3 or later.
    pub api_version: u32,
    /// Family of the queue that the command buffers are submitted to.
    pub queue_family: u32,
    /// Names of the enabled extensions, those of the instance and of the device.
    pub extensions: *const *const c_char,
    /// Elements of `extensions`.
    pub extension_count: u64,
    /// The *enabled* features with their chain: VkPhysicalDeviceVulkan12Features and ...13Features, or the structures of
    /// single features.
    pub features: *const VkPhysicalDeviceFeatures2,
    /// For all objects of the library but blocks of device memory; copied, its functions must stay. NULL: Vulkan's own.
    pub allocator: *const VkAllocationCallbacks,
    /// Receives messages; NULL for none.
    pub log: hs_log_callback,
    /// Passed to `log`.
    pub log_user: *mut c_void,
}

/// `casters`: meshes in vertex and index buffers.
pub const HS_VK_CASTERS_MESHES: u32 = 0;
/// `casters`: the host draws them into views that the library sets up.
pub const HS_VK_CASTERS_CALLBACK: u32 = 1;
/// `casters`: shadow maps that the host has already.
pub const HS_VK_CASTERS_MAPS: u32 = 2;
/// `surface`: the depths of the host's own projection.
pub const HS_VK_SURFACE_DEPTH: u32 = 0;
/// `surface`: positions in x, y, z; w is above 0 where there is a surface.
pub const HS_VK_SURFACE_POSITIONS: u32 = 1;
/// `normals`: x, y, z as they are.
pub const HS_VK_NORMALS_SIGNED: u32 = 0;
/// `normals`: x, y, z moved from [-1, 1] to [0, 1].
pub const HS_VK_NORMALS_UNSIGNED: u32 = 1;
/// `normals`: folded to an octahedron, x and y moved from [-1, 1] to [0, 1].
pub const HS_VK_NORMALS_OCTAHEDRAL: u32 = 2;

/// What an effect is made for. "World" is any space that is the same for positions, casters and light; the nearer to
/// zero they stand the better.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_vk_effect_info {
    /// HS_TYPE_VK_EFFECT_INFO
    pub r#type: u32,
    /// sizeof(hs_vk_effect_info)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// [pixel] [1, 32768] Of the surface, normal and visibility images.
    pub width: u32,
    /// [pixel] [1, 32768]
    pub height: u32,
    /// The shape counts: rectangle, disc, or without extent. Where it stands and its size come with each frame.
    pub light: *const hs_light,
    /// NULL: the usual ones of HS_TECHNIQUE_PACKET_CONTOUR.
    pub settings: *const hs_settings,
    /// HS_VK_CASTERS_...
    pub casters: u32,
    /// HS_VK_SURFACE_...
    pub surface: u32,
    /// HS_VK_NORMALS_...
    pub normals: u32,
    /// 1 = each sub-light has four more views, along its plane, for receivers beyond 60 degrees of its axis; 0 = the
    /// one along the axis serves them, with fewer texels. Not with HS_VK_CASTERS_MAPS.
    pub side_faces: u32,
    /// HS_VK_CASTERS_MESHES: most instances in a frame.
    pub instance_max: u32,
    /// HS_VK_CASTERS_MESHES: most vertices in a frame, those of all instances.
    pub vertex_max: u32,
    /// HS_VK_CASTERS_MESHES: most triangles in a frame, those of all instances.
    pub triangle_max: u32,
    /// (0, 1e6] Cost of an edge, in visited nodes [Yang 2009, eq. 6]; 0 = the library's own.
    pub edge_cost: f32,
    /// (0, 1e6] Cost of a visibility, in visited nodes; 0 = the library's own.
    pub visibility_cost: f32,
    /// 0
    pub reserved: u32,
}

structures! {
    hs_vk_requirements = HS_TYPE_VK_REQUIREMENTS,
    hs_vk_device_info = HS_TYPE_VK_DEVICE_INFO,
    hs_vk_effect_info = HS_TYPE_VK_EFFECT_INFO,
}
