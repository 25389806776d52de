//! The types and constants of `halfshade_vulkan.h`: what a host lends, and its frames.

use std::ffi::c_void;

use super::structure::structures;
use super::types::*;
use super::vulkan_names::*;
use super::vulkan_types::*;

/// An image of the host's, one layer of one level, and how the library finds and leaves it when the commands run. The
/// library emits both barriers. An image of one queue family, or one that is shared.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_vk_image {
    /// HS_TYPE_VK_IMAGE
    pub r#type: u32,
    /// sizeof(hs_vk_image)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// Image, 2D, of one sample.
    pub image: VkImage,
    /// Its format; of a depth format the depth is read.
    pub format: VkFormat,
    /// [texel] Of the level.
    pub width: u32,
    /// [texel] Of the level.
    pub height: u32,
    /// What it was created with; see hs_vk_requirements.
    pub usage: VkImageUsageFlags,
    /// Array layer.
    pub layer: u32,
    /// Mip level.
    pub level: u32,
    /// Layout before. That of a visibility image does not matter, for what it held is lost.
    pub current_layout: VkImageLayout,
    /// Layout afterwards; VK_IMAGE_LAYOUT_UNDEFINED = the layout, stage and access before.
    pub final_layout: VkImageLayout,
    /// Stages that wrote or read it last.
    pub current_stage: VkPipelineStageFlags2,
    /// Their accesses.
    pub current_access: VkAccessFlags2,
    /// Stages that use it next.
    pub final_stage: VkPipelineStageFlags2,
    /// Their accesses.
    pub final_access: VkAccessFlags2,
}

/// The images of frames that are recorded with the same slot: as many slots as the host has sets of images.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_vk_slot {
    /// HS_TYPE_VK_SLOT
    pub r#type: u32,
    /// sizeof(hs_vk_slot)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// Depths or positions, a format that can be sampled.
    pub surface: *const hs_vk_image,
    /// Normals of the visible side, of any length but 0 (0 = no surface), a format that can be sampled. Those of the
    /// surface itself, not of a normal map: what is below their plane casts no shadow.
    pub normal: *const hs_vk_image,
    /// The result, a colour format that can be drawn to, the same in all slots: 1 lit ... 0 umbra in all channels.
    pub visibility: *const hs_vk_image,
    /// HS_VK_CASTERS_MAPS: for each view its shadow map, of `map` x `map` texels of the settings.
    pub maps: *const hs_vk_image,
    /// Elements of `maps`: the number of views, or 0.
    pub map_count: u64,
}

/// A mesh of triangles in buffers of the host's. Alpha masks are not looked at; draw such casters by a callback.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_vk_mesh {
    /// HS_TYPE_VK_MESH
    pub r#type: u32,
    /// sizeof(hs_vk_mesh)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// Positions: x, y, z as 32-bit floats, finite.
    pub vertices: VkBuffer,
    /// [byte] Of the first position; a multiple of 4.
    pub vertex_offset: VkDeviceSize,
    /// [byte] From one position to the next, 12 or more; a multiple of 4.
    pub vertex_stride: u32,
    /// Vertices; an index that is out of range is taken for the last.
    pub vertex_count: u32,
    /// Three for each triangle; VK_NULL_HANDLE: 0, 1, 2, ... The buffer ends at a multiple of 4 bytes.
    pub indices: VkBuffer,
    /// [byte] Of the first index; a multiple of its size.
    pub index_offset: VkDeviceSize,
    /// VK_INDEX_TYPE_UINT16 or VK_INDEX_TYPE_UINT32.
    pub index_type: VkIndexType,
    /// Triangles.
    pub triangle_count: u32,
}

/// What an effect's frames are recorded with.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_vk_prepare_info {
    /// HS_TYPE_VK_PREPARE_INFO
    pub r#type: u32,
    /// sizeof(hs_vk_prepare_info)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// Sets of images.
    pub slots: *const hs_vk_slot,
    /// [1, 64] Elements of `slots`.
    pub slot_count: u64,
    /// HS_VK_CASTERS_MESHES: all meshes that frames name.
    pub meshes: *const hs_vk_mesh,
    /// [0, 65536] Elements of `meshes`.
    pub mesh_count: u64,
}

/// A mesh at a place.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_vk_instance {
    /// HS_TYPE_VK_INSTANCE
    pub r#type: u32,
    /// sizeof(hs_vk_instance)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// Index of the prepared mesh.
    pub mesh: u32,
    /// 0
    pub reserved: u32,
    /// From the mesh to the world: three rows of four, as in VkTransformMatrixKHR.
    pub transform: [f32; 12],
}

/// A shadow map that the host has drawn.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_vk_map {
    /// HS_TYPE_VK_MAP
    pub r#type: u32,
    /// sizeof(hs_vk_map)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// The perspective matrix that it was drawn with, by columns, from the centre of the view's part of the light.
    pub clip_from_world: [f32; 16],
    /// The depth where there is no caster: what the map was cleared to.
    pub depth_empty: f32,
    /// 0
    pub reserved: u32,
}

/// A view whose casters the host draws.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_vk_view {
    /// HS_TYPE_VK_VIEW
    pub r#type: u32,
    /// sizeof(hs_vk_view)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// To record the draws into. Dynamic rendering has begun: no colours, depth of the format in hs_vk_requirements,
    /// cleared to 0, one sample. Viewport and scissor are set; pipelines that have them fixed must keep a border of
    /// one texel free.
    pub command_buffer: VkCommandBuffer,
    /// Holds the matrix from the world to clip space that the device has fitted: 16 floats by columns. Reverse-Z without
    /// a far plane, so draw with VK_COMPARE_OP_GREATER. Storage and uniform usage. The same for all frames until the
    /// next hs_vk_effect_prepare; see hs_vk_effect_describe.
    pub projections: VkBuffer,
    /// [byte] Of the matrix: 256 times `index`.
    pub offset: VkDeviceSize,
    /// Of the view.
    pub index: u32,
    /// [texel] Width and height of the map.
    pub map: u32,
}

/// Draws the casters of a view with the host's own pipelines. May bind what it likes, must not end rendering, and may
/// call nothing of this library.
pub type hs_vk_draw = Option<unsafe extern "C" fn(view: *const hs_vk_view, user: *mut c_void)>;

/// A frame.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_vk_frame {
    /// HS_TYPE_VK_FRAME
    pub r#type: u32,
    /// sizeof(hs_vk_frame)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// [1, ...) Not less than that of the frame before; hs_vk_effect_collect is told when it has finished.
    pub serial: u64,
    /// Index of the prepared slot.
    pub slot: u32,
    /// Elements of `instances`.
    pub instance_count: u32,
    /// Where the light stands now; of the shape that the effect was made for. Colour and intensity do not matter.
    pub light: *const hs_light,
    /// HS_VK_CASTERS_MESHES: what casts shadows in this frame.
    pub instances: *const hs_vk_instance,
    /// HS_VK_CASTERS_CALLBACK.
    pub draw: hs_vk_draw,
    /// Passed to `draw`.
    pub draw_user: *mut c_void,
    /// HS_VK_CASTERS_MAPS: how each view's map was drawn.
    pub maps: *const hs_vk_map,
    /// Elements of `maps`.
    pub map_count: u32,
    /// (0, ...) [world] HS_VK_CASTERS_CALLBACK and ..._MAPS: how near to the light's plane casters may be. Nearer ones
    /// cast no shadow; the farther, the better the maps' texels are used.
    pub near_distance: f32,
    /// HS_VK_SURFACE_DEPTH: the inverse of the host's matrix from the world to clip space, by columns.
    pub world_from_clip: [f32; 16],
    /// The matrix from the normals' space to the world, by columns: the identity for normals in the world.
    pub normal_to_world: [f32; 9],
    /// HS_VK_SURFACE_DEPTH: the depth where there is no surface: what the image was cleared to.
    pub depth_empty: f32,
    /// [0, 1] Visibility to be written where there is no surface.
    pub background: f32,
    /// [0, ...) [world] By how much positions of the surface may be off. 0 = as the format of its image says (32-bit
    /// floats: as good as exact; D16 and RGBA16F: far off), with depths from the projection and the distance as well.
    /// What stands less than this above a surface casts no shadow on it: contact shadows begin there.
    pub position_error: f32,
}

/// What an effect has.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_vk_effect_state {
    /// HS_TYPE_VK_EFFECT_STATE
    pub r#type: u32,
    /// sizeof(hs_vk_effect_state)
    pub size: u32,
    /// NULL
    pub next: *mut c_void,
    /// [byte] On the device, that of earlier preparations included which were not collected yet.
    pub memory_bytes: u64,
    /// HS_VK_CASTERS_CALLBACK, once it is prepared: where the views' matrices stand; see hs_vk_view. Else VK_NULL_HANDLE.
    pub projections: VkBuffer,
    /// [byte] From one view's matrix to the next: 256.
    pub projection_stride: u32,
    /// Views: sub-lights, times the faces of each; also the number of maps in a slot.
    pub view_count: u32,
    /// Passes that a frame records.
    pub pass_count: u32,
    /// 1 = prepared.
    pub prepared: u32,
}

structures! {
    hs_vk_image = HS_TYPE_VK_IMAGE,
    hs_vk_slot = HS_TYPE_VK_SLOT,
    hs_vk_mesh = HS_TYPE_VK_MESH,
    hs_vk_prepare_info = HS_TYPE_VK_PREPARE_INFO,
    hs_vk_instance = HS_TYPE_VK_INSTANCE,
    hs_vk_map = HS_TYPE_VK_MAP,
    hs_vk_view = HS_TYPE_VK_VIEW,
    hs_vk_frame = HS_TYPE_VK_FRAME,
    hs_vk_effect_state = HS_TYPE_VK_EFFECT_STATE,
}
