//! Scenes from triangles that are in memory, and what they share with those from files.

use glam::{DVec3, Vec2, Vec3};

use super::geometry::double_area;
use super::material::Fate;
use super::primitive::MAX_COORDINATE;
use super::{Material, Scene, Texture};
use crate::{Error, Result};

/// What a scene is made of.
#[derive(Debug, Clone, Default)]
pub struct Triangles {
    /// [scene units, world] What `positions` are relative to; the scene has them in world space.
    pub origin: DVec3,
    /// [scene units]
    pub positions: Vec<Vec3>,
    /// [texture widths, heights] One per position, or none.
    pub texcoords: Vec<Vec2>,
    /// [0, 1] Linear RGB, one per position, or none.
    pub colors: Vec<Vec3>,
    /// Three positions per triangle, counter-clockwise seen from the front.
    pub indices: Vec<[u32; 3]>,
    /// One per triangle: index into `materials`.
    pub surfaces: Vec<u32>,
    /// One per triangle, whether it casts shadows, or none: all do.
    pub casts: Vec<bool>,
    /// None at all: white, opaque, seen from both sides.
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
}

impl Scene {
    /// A scene without cameras and lights. Triangles without area are left out.
    ///
    /// # Errors
    /// [`Error::Invalid`] when an index is out of range, a number is not finite or out of range, or the lists do
    /// not fit to one another.
    pub fn from_triangles(mut given: Triangles) -> Result<Self> {
        if given.materials.is_empty() {
            given.materials.push(Material::plain());
        }
        given.validate().map_err(Error::Invalid)?;
        let positions: Vec<DVec3> = (given.positions.iter())
            .map(|position| given.origin + position.as_dvec3())
            .collect();
        let surfaces = given.surfaces.iter();
        let fates = surfaces.map(
            |&index| match given.materials[index as usize].alpha_cutoff {
                Some(_) => Fate::Masked(index),
                None => Fate::Opaque(index),
            },
        );
        let casts = given.casts.iter().copied().chain(std::iter::repeat(true));
        let mut fates = given.indices.iter().copied().zip(casts).zip(fates);
        let sorted = sorted(&positions, &mut fates, Ok)?;
        Ok(Self {
            positions,
            texcoords: match given.textures.is_empty() {
                true => Vec::new(),
                false => given.texcoords,
            },
            colors: given.colors,
            triangles: sorted.triangles,
            triangle_materials: sorted.materials,
            opaque_count: sorted.opaque_count,
            casts: sorted.casts,
            materials: given.materials,
            textures: given.textures,
            ..Self::default()
        })
    }
}

impl Material {
    /// White, opaque, seen from both sides.
    fn plain() -> Self {
        Self {
            name: String::new(),
            base_color: glam::Vec4::ONE,
            texture: None,
            alpha_cutoff: None,
            double_sided: true,
        }
    }

    fn fault(&self, textures: usize) -> Option<&'static str> {
        // Written so that NaN fails them.
        let share = |value: f32| (0.0..=1.0).contains(&value);
        if !self.base_color.to_array().into_iter().all(share) {
            return Some("a base color is not from 0 to 1");
        }
        if !self.alpha_cutoff.is_none_or(share) {
            return Some("an alpha cutoff is not from 0 to 1");
        }
        match self.texture {
            Some(texture) if texture >= textures => Some("it names a texture that is not there"),
            _ => None,
        }
    }
}

impl Triangles {
    fn validate(&self) -> Result<(), String> {
        let sane = |v: DVec3| v.is_finite() && v.abs().max_element() <= MAX_COORDINATE;
        if !sane(self.origin) {
            return Err("the origin is not finite or beyond 1e18".into());
        }
        let vertices = self.positions.len();
        if u32::try_from(vertices).is_err() {
            return Err(format!(
                "{vertices} vertices are more than 32 bits can number"
            ));
        }
        if let Some(vertex) = self.positions.iter().position(|p| !sane(p.as_dvec3())) {
            return Err(format!("vertex {vertex} is not finite or beyond 1e18"));
        }
        let textured = self
            .materials
            .iter()
            .any(|material| material.texture.is_some());
        let texcoords = self.texcoords.len();
        if texcoords != vertices && (texcoords > 0 || textured) {
            return Err(format!(
                "{vertices} vertices have {texcoords} texture coordinates"
            ));
        }
        let colors = self.colors.len();
        if colors != vertices && colors > 0 {
            return Err(format!("{vertices} vertices have {colors} colours"));
        }
        let shares = |color: &Vec3| {
            color
                .to_array()
                .iter()
                .all(|share| (0.0..=1.0).contains(share))
        };
        if !self.colors.iter().all(shares) {
            return Err("a vertex's colour is not from 0 to 1".into());
        }
        if !self.texcoords.iter().all(|texcoord| texcoord.is_finite()) {
            return Err("a texture coordinate is not finite".into());
        }
        for (triangle, corners) in self.indices.iter().enumerate() {
            if let Some(corner) = corners.iter().find(|&&corner| corner as usize >= vertices) {
                return Err(format!(
                    "triangle {triangle} has the index {corner}, and there are {vertices} vertices"
                ));
            }
        }
        let materials = self.materials.len();
        if self.surfaces.len() != self.indices.len() {
            return Err("there must be one material index for each triangle".into());
        }
        if !self.casts.is_empty() && self.casts.len() != self.indices.len() {
            return Err(
                "there must be a word on each triangle whether it casts shadows, or on none".into(),
            );
        }
        if let Some(surface) = self
            .surfaces
            .iter()
            .find(|&&surface| surface as usize >= materials)
        {
            return Err(format!(
                "a triangle has the material {surface}, and there are {materials}"
            ));
        }
        for (index, material) in self.materials.iter().enumerate() {
            if let Some(fault) = material.fault(self.textures.len()) {
                return Err(format!("material {index}: {fault}"));
            }
        }
        Ok(())
    }
}

/// Triangles in the order of [`Scene::triangles`].
pub(super) struct Sorted {
    pub triangles: Vec<[u32; 3]>,
    pub materials: Vec<u32>,
    pub opaque_count: usize,
    /// As [`Scene::casts`].
    pub casts: Vec<bool>,
}

/// Leaves out triangles that have no area, and puts opaque ones first. With each comes whether it casts shadows.
///
/// # Errors
/// Those of `fate`.
pub(super) fn sorted<T>(
    positions: &[DVec3],
    triangles: &mut dyn Iterator<Item = (([u32; 3], bool), T)>,
    mut fate: impl FnMut(T) -> Result<Fate>,
) -> Result<Sorted> {
    let (mut opaque, mut masked) = (Vec::new(), Vec::new());
    for ((triangle, casts), surface) in triangles {
        if double_area(triangle.map(|i| positions[i as usize])) == 0.0 {
            continue;
        }
        match fate(surface)? {
            Fate::Opaque(index) => opaque.push((triangle, (index, casts))),
            Fate::Masked(index) => masked.push((triangle, (index, casts))),
            Fate::LeftOut => {}
        }
    }
    let opaque_count = opaque.len();
    let (triangles, rest): (_, Vec<_>) = opaque.into_iter().chain(masked).unzip();
    let (materials, casts): (_, Vec<bool>) = rest.into_iter().unzip();
    Ok(Sorted {
        triangles,
        materials,
        opaque_count,
        casts: match casts.contains(&false) {
            true => casts,
            false => Vec::new(),
        },
    })
}
