//! The project's own scenes, made from nothing: every file of `scenes/` as bytes.
//!
//! One file per scene, each with `fn scene() -> (Shot, Document)`. Together they use most of what glTF
//! can say about plain geometry, so that the loader is exercised:
//!
//! | scene | what only it has |
//! |---|---|
//! | `plate` | a separate `.bin`, u8 indices, a triangle strip, a second scene without the plate |
//! | `knot` | a mesh without indices, u16 indices, a disc light |
//! | `colonnade` | 60+ nodes that share meshes, nested transforms, meshes of two materials |
//! | `tree` | alpha masks, an atlas (KHR_texture_transform), interleaved and normalized vertices |
//! | `grid` | a sparse accessor, matrix nodes |
//! | `staircase` | u32 indices, a triangle fan, scaled nodes |
//!
//! Each file also brings its shot's camera and, as EXT_lights_area, its light. The shot `hexagon` shows the knot under a polygon.

mod colonnade;
mod document;
mod grid;
mod hexagon;
mod knot;
mod plate;
mod shot;
mod staircase;
mod tree;

/// A file of `scenes/`.
pub struct File {
    /// Without a folder.
    pub name: String,
    pub bytes: Vec<u8>,
}

/// Every file of `scenes/`, the same bytes on every run.
pub fn files() -> Vec<File> {
    let mut files = Vec::new();
    for (shot, document) in [
        knot::scene(),
        colonnade::scene(),
        tree::scene(),
        grid::scene(),
        staircase::scene(),
    ] {
        let name = format!("{}.glb", shot.name);
        files.push(text(format!("{}.json", shot.name), shot.to_json(&name)));
        files.push(File {
            name,
            bytes: document.into_glb(),
        });
    }
    let (name, shot) = hexagon::shot();
    files.push(text(name, shot));
    let (shot, document) = plate::scene();
    let (json, bin) = document.into_gltf("plate.bin");
    files.push(text("plate.json".into(), shot.to_json("plate.gltf")));
    files.push(text("plate.gltf".into(), json));
    files.push(File {
        name: "plate.bin".into(),
        bytes: bin,
    });
    files
}

fn text(name: String, text: String) -> File {
    File {
        name,
        bytes: text.into_bytes(),
    }
}
