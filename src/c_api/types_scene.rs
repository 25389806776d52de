//! The types and constants of `halfshade.h`: scenes, cameras and lights.

use std::ffi::c_void;

use super::structure::structures;
use super::types_context::*;

/// `texture` of a material without one.
pub const HS_NO_TEXTURE: u32 = 0xffff_ffff;

/// A surface: diffuse colour and, where it has holes, the alpha below which light passes.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_material {
    /// HS_TYPE_MATERIAL
    pub r#type: u32,
    /// sizeof(hs_material)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// [0, 1] Linear RGB and alpha, multiplied with the texture.
    pub base_color: [f32; 4],
    /// [0, 1] Texels whose alpha is below let light through; 0 = opaque everywhere.
    pub alpha_cutoff: f32,
    /// 1 = the camera sees both sides, 0 = the front alone. Both cast shadows.
    pub double_sided: u32,
    /// Index of the scene's texture, or HS_NO_TEXTURE.
    pub texture: u32,
    /// 0
    pub reserved: u32,
}

/// `wrap` of a texture: it repeats.
pub const HS_WRAP_REPEAT: u32 = 0;
/// `wrap` of a texture: it repeats, every second time mirrored.
pub const HS_WRAP_MIRROR: u32 = 1;
/// `wrap` of a texture: its border goes on.
pub const HS_WRAP_CLAMP: u32 = 2;

/// A base-colour texture: sRGB colour and linear alpha, 8 bits each.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_texture {
    /// HS_TYPE_TEXTURE
    pub r#type: u32,
    /// sizeof(hs_texture)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// width * height * 4 bytes, RGBA, the top row first. Copied during the call.
    pub rgba: *const u8,
    /// [texel] [1, 16384]
    pub width: u32,
    /// [texel] [1, 16384]
    pub height: u32,
    /// HS_WRAP_... of u and of v.
    pub wrap: [u32; 2],
    /// 1 = bilinear between texel centres, 0 = the nearest texel.
    pub linear: u32,
    /// 0
    pub reserved: u32,
}

/// Triangles, and what they are made of. All arrays are copied during the call.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_scene_info {
    /// HS_TYPE_SCENE_INFO
    pub r#type: u32,
    /// sizeof(hs_scene_info)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// [scene units] x, y, z of each vertex, relative to `origin`. Finite, at most 1e18.
    pub positions: *const f32,
    /// u, v of each vertex, in widths and heights of the texture, v downwards. NULL: no textures.
    pub texcoords: *const f32,
    /// Vertices, at most 2^32 - 1.
    pub vertex_count: u64,
    /// Three vertices for each triangle, counter-clockwise seen from the front. NULL: 0, 1, 2, ...
    pub indices: *const u32,
    /// Triangles, at most 2^26. Those without area are left out.
    pub triangle_count: u64,
    /// For each triangle the index of its material. NULL: all have the first one.
    pub triangle_materials: *const u32,
    /// NULL when there are none: then all surfaces are white, opaque and seen from both sides.
    pub materials: *const hs_material,
    /// Elements of `materials`.
    pub material_count: u64,
    /// NULL when there are none.
    pub textures: *const hs_texture,
    /// Elements of `textures`.
    pub texture_count: u64,
    /// [scene units] What `positions` are relative to, so that single precision suffices far from zero.
    pub origin: [f64; 3],
}

/// What a scene holds.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_scene_counts {
    /// HS_TYPE_SCENE_COUNTS
    pub r#type: u32,
    /// sizeof(hs_scene_counts)
    pub size: u32,
    /// NULL
    pub next: *mut c_void,
    /// Vertices.
    pub vertices: u64,
    /// Triangles with an area.
    pub triangles: u64,
    /// Those of them that are alpha-masked.
    pub masked_triangles: u64,
    /// Lights that the file brings.
    pub lights: u64,
    /// Cameras that the file brings.
    pub cameras: u64,
    /// [scene units] Lower corner of the bounding box.
    pub lower: [f64; 3],
    /// [scene units] Upper corner of the bounding box.
    pub upper: [f64; 3],
}

/// A pinhole camera and the size of its image. Right-handed; the top row of an image is the first.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_camera {
    /// HS_TYPE_CAMERA
    pub r#type: u32,
    /// sizeof(hs_camera)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// [scene units]
    pub eye: [f64; 3],
    /// [scene units]
    pub target: [f64; 3],
    /// Any length but 0, not along the view direction.
    pub up: [f64; 3],
    /// [degree] (0, 180) Vertical field of view, top to bottom.
    pub vfov_deg: f64,
    /// [pixel] [1, 32768]
    pub width: u32,
    /// [pixel] [1, 32768]
    pub height: u32,
}

/// `shape` of a light: a rectangle.
pub const HS_LIGHT_RECT: u32 = 0;
/// `shape` of a light: a disc.
pub const HS_LIGHT_DISC: u32 = 1;
/// `shape` of a light: a sphere, which shines to all sides.
pub const HS_LIGHT_SPHERE: u32 = 2;
/// `shape` of a light: a sun, light from infinity.
pub const HS_LIGHT_SUN: u32 = 3;
/// `shape` of a light: a convex polygon, whose corners an hs_polygon in `next` gives.
pub const HS_LIGHT_POLYGON: u32 = 4;

/// A light of constant radiance; flat ones are one-sided. Without extent it is a point and its shadow is hard; a disc with a normal is
/// the limit of small discs then, and other points shine to all sides alike.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_light {
    /// HS_TYPE_LIGHT
    pub r#type: u32,
    /// sizeof(hs_light)
    pub size: u32,
    /// NULL; the hs_polygon of HS_LIGHT_POLYGON.
    pub next: *const c_void,
    /// [scene units] Of a sun or a polygon without meaning.
    pub center: [f64; 3],
    /// [scene units] Half-axis of a rectangle.
    pub u: [f64; 3],
    /// [scene units] Half-axis of a rectangle, perpendicular to `u`; it shines along u x v.
    pub v: [f64; 3],
    /// Along which a disc or a sun shines; any length but 0, unless it is a disc whose radius is 0.
    pub normal: [f64; 3],
    /// [scene units] Of a disc or a sphere. [degree] [0, 180) Of a sun: its angular diameter.
    pub radius: f64,
    /// [0, ...) Linear RGB.
    pub color: [f32; 3],
    /// [radiance] Of a light without extent: radiant intensity; of a sun: irradiance of a surface that faces it. Below 0: such that a white surface at the camera's target
    /// that faces the light has radiance 1.
    pub intensity: f32,
    /// HS_LIGHT_...
    pub shape: u32,
    /// 0
    pub reserved: u32,
    /// [degree] Inner and outer angle of the cone around `normal` that the shine of a disc or a sphere is kept in, 0 <= inner <= outer
    /// <= 180; 0 and 0: it is kept in none.
    pub cone_deg: [f64; 2],
}

/// The corners of a light that is a polygon, chained to hs_light.next. Read during the call.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_polygon {
    /// HS_TYPE_POLYGON
    pub r#type: u32,
    /// sizeof(hs_polygon)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// [scene units] x, y, z of each corner. In one plane and convex; the light shines to the side from which they run
    /// counter-clockwise.
    pub corners: *const f64,
    /// [3, 16]
    pub corner_count: u64,
}

structures! {
    hs_scene_info = HS_TYPE_SCENE_INFO,
    hs_material = HS_TYPE_MATERIAL,
    hs_texture = HS_TYPE_TEXTURE,
    hs_scene_counts = HS_TYPE_SCENE_COUNTS,
    hs_camera = HS_TYPE_CAMERA,
    hs_light = HS_TYPE_LIGHT,
    hs_polygon = HS_TYPE_POLYGON,
}
