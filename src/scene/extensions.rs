//! Extensions of glTF by what they mean to shadows.

/// The extensions whose meaning the loader knows.
const KNOWN: [&str; 10] = [
    "EXT_lights_area",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_transform",
];

/// What no shadow depends on, though a file may require it: how surfaces look, what they are for, how they move.
const HARMLESS: [&str; 12] = [
    "KHR_materials_",
    "EXT_materials_",
    "ADOBE_materials_",
    "KHR_animation_pointer",
    "KHR_xmp",
    "KHR_audio",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_physics_rigid_bodies",
    "EXT_lights_image_based",
    "EXT_lights_ies",
];

/// Formats of textures that are not read: a texture without another image is as one that is missing.
const TEXTURES: [&str; 4] = [
    "KHR_texture_basisu",
    "EXT_texture_avif",
    "MSFT_texture_dds",
    "KHR_texture_procedurals",
];

/// Whether the loader does what the extension says.
pub(super) fn is_known(name: &str) -> bool {
    KNOWN.contains(&name)
}

/// Whether a file may require it: the loader knows it, no shadow depends on it, or it can do without.
pub(super) fn may_be_required(name: &str) -> bool {
    is_known(name)
        || TEXTURES.contains(&name)
        || HARMLESS.iter().any(|&start| name.starts_with(start))
}
