//! Mesh instances, flattened into one list of triangles.

use std::collections::HashMap;

use glam::{DAffine3, DVec3, Vec2, Vec3};
use gltf::json::{Index, Material, Mesh};

use super::document::{Document, label};
use super::notes::Notes;
use super::options::Limits;
use super::pose::Pose;
use super::primitive::Source;
use crate::Result;

/// [byte] What the loader takes for a triangle with vertices of its own.
const TRIANGLE_BYTES: u64 = 128;
/// [byte] A primitive takes no memory but time, as much as some triangles do.
const PRIMITIVE_BYTES: u64 = 1024;

/// All triangles of a scene, in world space and f64.
pub(super) struct Geometry {
    pub positions: Vec<DVec3>,
    /// One per position; zero where the material has no texture.
    pub texcoords: Vec<Vec2>,
    /// One per position; none where no primitive has colours.
    pub colors: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// One per triangle; None = glTF's default material.
    pub materials: Vec<Option<Index<Material>>>,
    /// One per triangle: whether it casts shadows.
    pub casts: Vec<bool>,
    /// How many more triangles and primitives may be read, so that neither memory nor time run away.
    triangles_left: usize,
    primitives_left: usize,
}

impl Geometry {
    pub fn new(limits: &Limits) -> Self {
        Self {
            positions: Vec::new(),
            texcoords: Vec::new(),
            colors: Vec::new(),
            triangles: Vec::new(),
            materials: Vec::new(),
            casts: Vec::new(),
            // Vertices, at most three per triangle, are numbered with 32 bits.
            triangles_left: limits.max_triangles.min(u32::MAX as usize / 3),
            primitives_left: limits.max_primitives,
        }
    }

    /// How many more instances of meshes there may be.
    pub fn instances_left(&self) -> usize {
        self.primitives_left
    }

    /// Adds all instances of a mesh.
    ///
    /// # Errors
    /// When the mesh is malformed, or holds more triangles than the limit leaves.
    pub fn add(
        &mut self,
        document: &Document,
        mesh: Index<Mesh>,
        pose: &Pose,
        notes: &mut Notes,
    ) -> Result<()> {
        for place in &pose.places {
            self.add_instance(document, mesh, pose, place, notes)?;
        }
        Ok(())
    }

    fn add_instance(
        &mut self,
        document: &Document,
        mesh: Index<Mesh>,
        pose: &Pose,
        place: &DAffine3,
        notes: &mut Notes,
    ) -> Result<()> {
        let json = document.get(mesh, "mesh", "the node tree")?;
        let name = label("mesh", mesh.value(), json.name.as_deref());
        let spend = |left: &mut usize, count, what| {
            *left = left.checked_sub(count).ok_or_else(|| {
                document.error(format!(
                    "{name}: the scene exceeds the limit on {what} (instances counted); raise --max-{what}"
                ))
            })?;
            Ok(())
        };
        let count = json.primitives.len().max(1);
        spend(&mut self.primitives_left, count, "primitives")?;
        document.spend(count as u64 * PRIMITIVE_BYTES, &name)?;
        for primitive in &json.primitives {
            let Some(source) = Source::open(document, primitive, pose, &name, notes)? else {
                continue;
            };
            let count = source.triangle_count();
            spend(&mut self.triangles_left, count, "triangles")?;
            // Targets and joints take no memory but time.
            let work = TRIANGLE_BYTES.saturating_mul(1 + source.deformers() as u64);
            document.spend((count as u64).saturating_mul(work), &name)?;
            self.add_primitive(document, &source, place, primitive.material)?;
        }
        Ok(())
    }

    fn add_primitive(
        &mut self,
        document: &Document,
        source: &Source,
        place: &DAffine3,
        material: Option<Index<Material>>,
    ) -> Result<()> {
        let mut renumbered = Renumbered::new(source);
        for triangle in 0..source.triangle_count() {
            let mut corners = source.corners(document, triangle)?;
            if source.is_mirrored(place, corners[0]) {
                corners.swap(1, 2);
            }
            let mut points = [DVec3::ZERO; 3];
            for (point, &vertex) in points.iter_mut().zip(&corners) {
                *point = match renumbered.get(vertex) {
                    Some(known) => self.positions[known as usize],
                    None => source.position(document, place, vertex)?,
                };
            }
            // Left out here already, so that memory stays in proportion to the file: an accessor
            // without bytes holds any number of zeros.
            if double_area(points) == 0.0 {
                continue;
            }
            let mut indices = [0; 3];
            for i in 0..3 {
                indices[i] = match renumbered.get(corners[i]) {
                    Some(known) => known,
                    None => {
                        let new = self.positions.len() as u32;
                        self.positions.push(points[i]);
                        self.texcoords.push(source.texcoord(document, corners[i])?);
                        self.paint(new, source.color(document, corners[i])?);
                        renumbered.insert(corners[i], new);
                        new
                    }
                };
            }
            self.triangles.push(indices);
            self.materials.push(material);
        }
        Ok(())
    }
}

impl Geometry {
    /// Gives a vertex its colour, if any vertex has one: those without are white.
    fn paint(&mut self, vertex: u32, color: Option<Vec3>) {
        if color.is_some() || !self.colors.is_empty() {
            self.colors.resize(vertex as usize, Vec3::ONE);
            self.colors.push(color.unwrap_or(Vec3::ONE));
        }
    }
}

/// [scene units²] Twice the area of a triangle.
pub(super) fn double_area([a, b, c]: [DVec3; 3]) -> f64 {
    (b - a).cross(c - a).length()
}

/// Which vertex of the scene a vertex of the primitive became. (Primitives often use a small part of a
/// large shared accessor, so only the vertices that a triangle names are taken over.)
enum Renumbered {
    /// The new number plus one; 0 = none yet, so that untouched parts cost no memory.
    Dense(Vec<u32>),
    Sparse(HashMap<usize, u32>),
}

impl Renumbered {
    fn new(source: &Source) -> Self {
        let vertices = source.positions.count;
        if vertices / 3 <= source.triangle_count() {
            Self::Dense(vec![0; vertices])
        } else {
            Self::Sparse(HashMap::new())
        }
    }

    fn get(&self, vertex: usize) -> Option<u32> {
        match self {
            Self::Dense(table) => table[vertex].checked_sub(1),
            Self::Sparse(table) => table.get(&vertex).copied(),
        }
    }

    fn insert(&mut self, vertex: usize, new: u32) {
        match self {
            Self::Dense(table) => table[vertex] = new + 1,
            Self::Sparse(table) => {
                table.insert(vertex, new);
            }
        }
    }
}
