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
use super::pose::Posing;
use super::tree::walk;
use super::triangles::sorted;
use super::{Scene, file};
use crate::Result;

pub use super::options::{Blend, Limits, LoadOptions};

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
    let placed = walk(&document, options.scene, options.casters.as_deref())?;
    let posing = Posing::new(&document, &placed);
    for place in placed.iter().filter(|place| place.visible) {
        let node = document.get(place.node, "node", "the node tree")?;
        if let Some(mesh) = node.mesh {
            let pose = posing.of(place, geometry.instances_left(), &mut notes)?;
            geometry.add(&document, mesh, &pose, &mut notes)?;
            let count = geometry.triangles.len();
            geometry.casts.resize(count, place.casts);
        }
    }
    let mut scene = assemble(&document, geometry, options, &mut notes)?;
    let emitters = Emitters::new(&document, options, &scene)?;
    let mut light_notes = Notes::default();
    for place in &placed {
        if place.visible {
            let light = emitters.light(place, &mut light_notes)?;
            scene.lights.extend(light);
        }
        scene.cameras.extend(emitters.camera(place, &mut notes)?);
    }
    if !options.own_lights {
        notes.append(light_notes);
    }
    if let Some(animation) = document.root.animations.first() {
        let name = label("animation", 0, animation.name.as_deref());
        notes.add(
            "animations are not played; the scene stands as it is stored",
            &name,
        );
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
    if !options.own_lights {
        scene.notes.extend(emitters.idle_flags());
    }
    Ok(scene)
}

/// Gives the triangles their materials.
fn assemble<'a>(
    document: &'a Document<'a>,
    geometry: Geometry,
    options: &LoadOptions,
    notes: &mut Notes,
) -> Result<Scene> {
    let mut materials = Materials::new(document, options);
    let triangles = geometry.triangles.into_iter().zip(geometry.casts);
    let mut triangles = triangles.zip(geometry.materials);
    let sorted = sorted(&geometry.positions, &mut triangles, |material| {
        materials.fate(material, notes)
    })?;
    Ok(Scene {
        positions: geometry.positions,
        texcoords: match materials.textures.is_empty() {
            true => Vec::new(),
            false => geometry.texcoords,
        },
        colors: geometry.colors,
        triangles: sorted.triangles,
        triangle_materials: sorted.materials,
        opaque_count: sorted.opaque_count,
        casts: sorted.casts,
        materials: materials.list,
        textures: materials.textures,
        ..Scene::default()
    })
}
