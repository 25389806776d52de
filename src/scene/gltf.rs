//! glTF 2.0 (.gltf and .glb) → [`Scene`].
//!
//! Files may be malformed or hostile: every reference and range is checked before use, paths out of
//! the file's folder are refused unless allowed, and [`Limits`] bound memory and time.
//!
//! Triangles without area are left out, for they neither show nor cast a shadow.

use std::path::Path;

use super::document::{Document, label};
use super::emitters::Emitters;
use super::geometry::Geometry;
use super::material::Materials;
use super::notes::Notes;
use super::tree::walk;
use super::triangles::sorted;
use super::{Scene, file};
use crate::Result;

/// How to read a glTF file.
#[derive(Debug, Clone, Default)]
pub struct LoadOptions {
    /// Which scene of the file, counted from 0. None: its default scene, else its first.
    pub scene: Option<usize>,
    /// [scene units] ≥ 0. Point and spot lights become discs of this radius. None: they are left out.
    pub punctual_radius: Option<f64>,
    /// The file may name files outside of its own folder, be it by `..`, by a link, by an absolute path
    /// or by a `file:` URL.
    pub outside_paths: bool,
    /// The caller has lights of its own: nothing is noted about those of the file.
    pub own_lights: bool,
    pub limits: Limits,
}

/// What a file may ask for at most, however small it is itself.
#[derive(Debug, Clone)]
pub struct Limits {
    /// Triangles, every instance of a mesh counted. Default: 2²⁶ (about 4 GiB).
    pub max_triangles: usize,
    /// Primitives, every instance of a mesh counted: empty ones take time too. Default: 2²².
    pub max_primitives: usize,
    /// [texel] Width and height of a texture. Default: 16384.
    pub max_texture_side: u32,
    /// [texel] All textures together, 4 bytes each. Default: 2²⁸ (1 GiB).
    pub max_texels: u64,
    /// What the scene takes in memory, per byte of its files, beyond the first 256 MiB: compressed images and
    /// instances let a small file ask for much. Default: 256.
    pub max_expansion: u64,
}

/// [byte] What any scene may take, however small its files are.
const FREE_BYTES: u64 = 256 << 20;

/// What a scene may still take in memory, in proportion to the files that it is read from.
pub(super) struct Budget {
    expansion: u64,
    left: u64,
}

impl Budget {
    pub fn new(limits: &Limits) -> Self {
        Self {
            expansion: limits.max_expansion,
            left: FREE_BYTES,
        }
    }

    /// Grants what a file of this many bytes may expand to.
    pub fn earn(&mut self, file_bytes: usize) {
        let earned = self.expansion.saturating_mul(file_bytes as u64);
        self.left = self.left.saturating_add(earned);
    }

    /// Whether there is room for this many bytes, which are taken then.
    pub fn spend(&mut self, bytes: u64) -> bool {
        let rest = self.left.checked_sub(bytes);
        self.left = rest.unwrap_or(self.left);
        rest.is_some()
    }
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            max_triangles: 1 << 26,
            max_primitives: 1 << 22,
            max_texture_side: 16384,
            max_texels: 1 << 28,
            max_expansion: 256,
        }
    }
}

/// Reads one scene of a .gltf or .glb and the files beside it that it refers to.
///
/// # Errors
/// When a file cannot be read, is malformed, requires an unknown extension or exceeds a limit; the
/// message names the file and the object in it.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Scene> {
    let mut scene = parse(path, &file::read(path)?, options)?;
    scene.files.push(path.into());
    Ok(scene)
}

/// As [`load`], from bytes that were read from `path` before.
///
/// # Errors
/// As [`load`].
pub fn parse(path: &Path, bytes: &[u8], options: &LoadOptions) -> Result<Scene> {
    let document = Document::parse(path, bytes, options)?;
    let mut notes = Notes::default();
    let mut geometry = Geometry::new(&options.limits);
    let placed = walk(&document, options.scene)?;
    for place in &placed {
        let node = document.get(place.node, "node", "the node tree")?;
        if node.skin.is_some() {
            let name = label("node", place.node.value(), node.name.as_deref());
            notes.add("skins are ignored; the mesh keeps its bind pose", &name);
        }
        if let Some(mesh) = node.mesh {
            geometry.add(&document, mesh, &place.world, &mut notes)?;
        }
    }
    let mut scene = assemble(&document, geometry, &options.limits, &mut notes)?;
    let emitters = Emitters::new(&document, options.punctual_radius, &scene)?;
    let mut light_notes = Notes::default();
    for place in &placed {
        let light = emitters.light(place, &mut light_notes)?;
        scene.lights.extend(light);
        scene.cameras.extend(emitters.camera(place, &mut notes)?);
    }
    if !options.own_lights {
        notes.append(light_notes);
    }
    let ignored = document.ignored_extensions();
    if !ignored.is_empty() {
        notes.add(
            "not supported and ignored",
            &format!("extensions {}", ignored.join(", ")),
        );
    }
    scene.files = document.files();
    scene.notes = notes.into_sentences();
    if emitters.radius_is_idle() && !options.own_lights {
        let note = "--radius is ignored, for the scene has no point or spot light.";
        scene.notes.push(note.into());
    }
    Ok(scene)
}

/// Gives the triangles their materials.
fn assemble<'a>(
    document: &'a Document<'a>,
    geometry: Geometry,
    limits: &Limits,
    notes: &mut Notes,
) -> Result<Scene> {
    let mut materials = Materials::new(document, limits);
    let mut triangles = geometry.triangles.into_iter().zip(geometry.materials);
    let sorted = sorted(&geometry.positions, &mut triangles, |material| {
        materials.fate(material, notes)
    })?;
    Ok(Scene {
        positions: geometry.positions,
        texcoords: match materials.textures.is_empty() {
            true => Vec::new(),
            false => geometry.texcoords,
        },
        triangles: sorted.triangles,
        triangle_materials: sorted.materials,
        opaque_count: sorted.opaque_count,
        materials: materials.list,
        textures: materials.textures,
        ..Scene::default()
    })
}
