//! The flags of commands that read scenes: what a file may ask for.

use halfshade::scene::gltf::{Blend, Limits};
use halfshade::shot::Overrides;

use super::parse_size;

/// How to read a shot and its scene.
#[derive(Debug, clap::Args)]
pub struct LoadArgs {
    /// Size of the image in pixels, each side 1 to 32768 [default: the shot's]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<(u32, u32)>,
    /// Let a glTF name files outside of its folder, and file: URLs
    #[arg(long)]
    allow_outside_paths: bool,
    /// What surfaces of alphaMode BLEND are: opaque (but where alpha is 0), left out, or cut at their alphaCutoff
    #[arg(long, value_name = "RULE", value_enum, default_value_t)]
    blend: Blend,
    /// Take materials as opaque whose texture decides where light passes and cannot be read
    #[arg(long)]
    allow_missing: bool,
    /// Most triangles of a scene, every instance of a mesh counted
    #[arg(long, value_name = "N", default_value_t = Limits::default().max_triangles)]
    max_triangles: usize,
    /// Most primitives of a scene, every instance of a mesh counted
    #[arg(long, value_name = "N", default_value_t = Limits::default().max_primitives)]
    max_primitives: usize,
    /// Largest width and height of a texture in texels
    #[arg(long, value_name = "TEXELS", default_value_t = Limits::default().max_texture_side)]
    max_texture_side: u32,
    /// Most texels of all textures together, 4 bytes each
    #[arg(long, value_name = "TEXELS", default_value_t = Limits::default().max_texels)]
    max_texels: u64,
    /// Most bytes that a scene takes per byte of its files, beyond 256 MiB: compressed images and instances expand
    #[arg(long, value_name = "FACTOR", default_value_t = Limits::default().max_expansion)]
    max_expansion: u64,
}

impl LoadArgs {
    pub fn overrides(&self) -> Overrides {
        Overrides {
            size: self.size,
            outside_paths: self.allow_outside_paths,
            blend: self.blend,
            allow_missing: self.allow_missing,
            limits: Limits {
                max_triangles: self.max_triangles,
                max_primitives: self.max_primitives,
                max_texture_side: self.max_texture_side,
                max_texels: self.max_texels,
                max_expansion: self.max_expansion,
            },
            ..Overrides::default()
        }
    }
}
