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

/// A kind of texture that is not read: one without another image is as one that is missing.
struct Unread {
    extension: &'static str,
    /// [byte] Where in files of the kind stands which signature.
    signature: Option<(usize, &'static [u8])>,
    /// What it is, and what to do about it.
    advice: &'static str,
}

const UNREAD: [Unread; 4] = [
    Unread {
        extension: "KHR_texture_basisu",
        signature: Some((0, b"\xabKTX 20\xbb")),
        advice: "is in KTX2; `gltf-transform ktxdecompress` makes PNG of it",
    },
    Unread {
        extension: "EXT_texture_avif",
        signature: Some((4, b"ftypavif")),
        advice: "is in AVIF; convert it to PNG",
    },
    Unread {
        extension: "MSFT_texture_dds",
        signature: Some((0, b"DDS ")),
        advice: "is in DDS; convert it to PNG",
    },
    Unread {
        extension: "KHR_texture_procedurals",
        signature: None,
        advice: "is a procedure; bake it into a PNG",
    },
];

/// What a texture with these extensions and no other image is, and what to do about it.
pub(super) fn unread_texture<'a>(
    mut extensions: impl Iterator<Item = &'a String>,
) -> Option<&'static str> {
    extensions.find_map(|name| {
        let kind = UNREAD.iter().find(|kind| kind.extension == name)?;
        Some(kind.advice)
    })
}

/// What an image is that no decoder is for, and what to do about it.
pub(super) fn unread_image(bytes: &[u8]) -> Option<&'static str> {
    let is = |kind: &&Unread| {
        kind.signature
            .is_some_and(|(at, with)| bytes.get(at..).is_some_and(|rest| rest.starts_with(with)))
    };
    UNREAD.iter().find(is).map(|kind| kind.advice)
}

/// Whether the loader does what the extension says.
pub(super) fn is_known(name: &str) -> bool {
    KNOWN.contains(&name)
}

/// Whether a file may require it: the loader knows it, no shadow depends on it, or it can do without.
pub(super) fn may_be_required(name: &str) -> bool {
    is_known(name)
        || UNREAD.iter().any(|kind| kind.extension == name)
        || HARMLESS.iter().any(|&start| name.starts_with(start))
}
