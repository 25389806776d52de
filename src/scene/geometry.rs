//! Mesh instances, flattened into one list of triangles.

use std::collections::HashMap;

use glam::{DAffine3, DVec3, Vec2};
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Index, Material, Mesh};

use super::accessor::Accessor;
use super::document::{Document, label};
use super::material::TextureUse;
use super::notes::Notes;
use super::options::Limits;
use crate::Result;

/// [scene units] Coordinates beyond are refused: the square of a distance must fit into f32.
pub(crate) const MAX_COORDINATE: f64 = 1e18;

/// [byte] What the loader takes for a triangle with vertices of its own.
const TRIANGLE_BYTES: u64 = 128;
/// [byte] A primitive takes no memory but time, as much as some triangles do.
const PRIMITIVE_BYTES: u64 = 1024;

/// All triangles of a scene, in world space and f64.
pub(super) struct Geometry {
    pub positions: Vec<DVec3>,
    /// One per position; zero where the material has no texture.
    pub texcoords: Vec<Vec2>,
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
            triangles: Vec::new(),
            materials: Vec::new(),
            casts: Vec::new(),
            // Vertices, at most three per triangle, are numbered with 32 bits.
            triangles_left: limits.max_triangles.min(u32::MAX as usize / 3),
            primitives_left: limits.max_primitives,
        }
    }

    /// Adds one instance of a mesh, which casts shadows or not.
    ///
    /// # Errors
    /// When the mesh is malformed, or holds more triangles than the limit leaves.
    pub fn add(
        &mut self,
        document: &Document,
        mesh: Index<Mesh>,
        world: &DAffine3,
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
        let count = json.primitives.len();
        spend(&mut self.primitives_left, count, "primitives")?;
        document.spend(count as u64 * PRIMITIVE_BYTES, &name)?;
        for primitive in &json.primitives {
            note_ignored(primitive, &name, notes);
            let Some(source) = Source::open(document, primitive, &name, notes)? else {
                continue;
            };
            let count = source.triangle_count();
            spend(&mut self.triangles_left, count, "triangles")?;
            document.spend((count as u64).saturating_mul(TRIANGLE_BYTES), &name)?;
            self.add_primitive(document, &source, world, primitive.material)?;
        }
        Ok(())
    }

    fn add_primitive(
        &mut self,
        document: &Document,
        source: &Source,
        world: &DAffine3,
        material: Option<Index<Material>>,
    ) -> Result<()> {
        let mirrored = world.matrix3.determinant() < 0.0;
        let mut renumbered = Renumbered::new(source);
        for triangle in 0..source.triangle_count() {
            let mut corners = source.corners(document, triangle)?;
            if mirrored {
                corners.swap(1, 2);
            }
            let mut points = [DVec3::ZERO; 3];
            for (point, &vertex) in points.iter_mut().zip(&corners) {
                *point = source.position(document, world, vertex)?;
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

/// [scene units²] Twice the area of a triangle.
pub(super) fn double_area([a, b, c]: [DVec3; 3]) -> f64 {
    (b - a).cross(c - a).length()
}

/// One primitive of triangles, opened for reading.
struct Source<'a> {
    name: &'a str,
    mode: Mode,
    positions: Accessor<'a>,
    indices: Option<Accessor<'a>>,
    texcoords: Option<(Accessor<'a>, TextureUse)>,
}

impl<'a> Source<'a> {
    /// None: the primitive holds no triangles, as noted.
    fn open(
        document: &'a Document,
        primitive: &Primitive,
        name: &'a str,
        notes: &mut Notes,
    ) -> Result<Option<Self>> {
        let mode = match primitive.mode {
            Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => {
                mode
            }
            Checked::Valid(_) => {
                notes.add("points and lines are left out", name);
                return Ok(None);
            }
            Checked::Invalid => return Err(document.error(format!("{name}: has an invalid mode"))),
        };
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let open = |index, shape, components: &[_], what: &str| {
            Accessor::open(
                document,
                index,
                shape,
                components,
                &format!("{what} of {name}"),
            )
        };
        let Some(positions) = attribute(Semantic::Positions) else {
            notes.add("a primitive without POSITION is left out", name);
            return Ok(None);
        };
        let positions = open(positions, Type::Vec3, &[ComponentType::F32], "POSITION")?;
        let integers = [ComponentType::U8, ComponentType::U16, ComponentType::U32];
        let indices = primitive
            .indices
            .map(|index| open(index, Type::Scalar, &integers, "the indices"))
            .transpose()?;
        let mut texcoords = None;
        if let Some(texture) = TextureUse::of(document, primitive.material, name)? {
            match attribute(Semantic::TexCoords(texture.set)) {
                Some(index) => {
                    let numbers = [ComponentType::F32, ComponentType::U8, ComponentType::U16];
                    let accessor = open(index, Type::Vec2, &numbers, "TEXCOORD")?;
                    texcoords = Some((accessor, texture));
                }
                None => notes.add(
                    "has no texture coordinates for its texture, whose first texel is taken",
                    name,
                ),
            }
        }
        Ok(Some(Self {
            name,
            mode,
            positions,
            indices,
            texcoords,
        }))
    }

    fn corner_count(&self) -> usize {
        self.indices
            .as_ref()
            .map_or(self.positions.count, |indices| indices.count)
    }

    fn triangle_count(&self) -> usize {
        match self.mode {
            Mode::TriangleStrip | Mode::TriangleFan => self.corner_count().saturating_sub(2),
            _ => self.corner_count() / 3,
        }
    }

    /// The vertices of a triangle, counter-clockwise.
    fn corners(&self, document: &Document, triangle: usize) -> Result<[usize; 3]> {
        let i = triangle;
        let corners = match self.mode {
            Mode::TriangleStrip => [i, i + 1 + i % 2, i + 2 - i % 2],
            Mode::TriangleFan => [i + 1, i + 2, 0],
            _ => [3 * i, 3 * i + 1, 3 * i + 2],
        };
        let Some(indices) = &self.indices else {
            return Ok(corners);
        };
        let vertices = corners.map(|corner| indices.index(corner) as usize);
        let count = self.positions.count;
        match vertices.iter().find(|&&vertex| vertex >= count) {
            None => Ok(vertices),
            Some(vertex) => Err(document.error(format!(
                "{}: the index {vertex} is out of range, it has {count} vertices",
                self.name
            ))),
        }
    }

    fn position(&self, document: &Document, world: &DAffine3, vertex: usize) -> Result<DVec3> {
        let local: [f32; 3] = self.positions.floats(vertex);
        let position = world.transform_point3(DVec3::from_array(local.map(f64::from)));
        // Written so that NaN fails it.
        if position.abs().max_element() <= MAX_COORDINATE && position.is_finite() {
            Ok(position)
        } else {
            Err(document.error(format!(
                "{}: vertex {vertex} has a position that is not finite or beyond {MAX_COORDINATE:e}",
                self.name
            )))
        }
    }

    fn texcoord(&self, document: &Document, vertex: usize) -> Result<Vec2> {
        let Some((accessor, texture)) = &self.texcoords else {
            return Ok(Vec2::ZERO);
        };
        if vertex >= accessor.count {
            return Err(document.error(format!(
                "{}: vertex {vertex} has no texture coordinates, there are only {}",
                self.name, accessor.count
            )));
        }
        let texcoord = texture.transform(Vec2::from_array(accessor.floats(vertex)));
        if texcoord.is_finite() {
            Ok(texcoord)
        } else {
            Err(document.error(format!(
                "{}: vertex {vertex} has texture coordinates that are not finite",
                self.name
            )))
        }
    }
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

fn note_ignored(primitive: &Primitive, name: &str, notes: &mut Notes) {
    if primitive
        .targets
        .as_ref()
        .is_some_and(|targets| !targets.is_empty())
    {
        notes.add(
            "morph targets are ignored; the mesh keeps its base shape",
            name,
        );
    }
    if primitive
        .attributes
        .contains_key(&Checked::Valid(Semantic::Colors(0)))
    {
        notes.add("vertex colours are ignored", name);
    }
}
