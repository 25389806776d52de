//! One primitive of a mesh, opened for reading: its triangles, and where their vertices stand in a pose.

use glam::{DAffine3, DVec3, Vec2};
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;

use super::accessor::Accessor;
use super::document::Document;
use super::material::TextureUse;
use super::notes::Notes;
use super::pose::Pose;
use crate::Result;

/// [scene units] Coordinates beyond are refused: the square of a distance must fit into f32.
pub(crate) const MAX_COORDINATE: f64 = 1e18;

/// Components of positions and texture coordinates: integers by KHR_mesh_quantization, floats.
const NUMBERS: [ComponentType; 5] = [
    ComponentType::U8,
    ComponentType::U16,
    ComponentType::I8,
    ComponentType::I16,
    ComponentType::F32,
];

/// Components of indices; joints have the first two.
const INTEGERS: [ComponentType; 3] = [ComponentType::U8, ComponentType::U16, ComponentType::U32];

/// Components of weights.
const SHARES: [ComponentType; 3] = [ComponentType::F32, ComponentType::U8, ComponentType::U16];

/// Sets of four joints that a vertex may have.
const MAX_SETS: u32 = 16;

/// One primitive of triangles, opened for reading.
pub(super) struct Source<'a> {
    name: &'a str,
    mode: Mode,
    pub positions: Accessor<'a>,
    /// Morph targets of a weight that is not 0.
    targets: Vec<(f64, Accessor<'a>)>,
    /// Joints of the skin and their weights, four of each a vertex.
    influences: Vec<(Accessor<'a>, Accessor<'a>)>,
    joints: &'a [DAffine3],
    indices: Option<Accessor<'a>>,
    texcoords: Option<(Accessor<'a>, TextureUse)>,
}

impl<'a> Source<'a> {
    /// None: the primitive holds no triangles, as noted.
    pub fn open(
        document: &'a Document,
        primitive: &Primitive,
        pose: &'a Pose,
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
        let integers_of = |index, shape, components: &[_], what: &str| {
            let what = format!("{what} of {name}");
            Accessor::open_integers(document, index, shape, components, &what)
        };
        let Some(positions) = attribute(Semantic::Positions) else {
            notes.add("a primitive without POSITION is left out", name);
            return Ok(None);
        };
        let numbers = &NUMBERS[if document.is_quantized() { 0 } else { 4 }..];
        let positions = open(positions, Type::Vec3, numbers, "POSITION")?;
        let mut targets = Vec::new();
        let declared = primitive.targets.iter().flatten();
        for (target, &weight) in declared.zip(&pose.weights) {
            if let Some(index) = target.positions.filter(|_| weight != 0.0) {
                let moved = open(index, Type::Vec3, numbers, "a morph target")?;
                targets.push((weight, moved));
            }
        }
        let mut influences = Vec::new();
        let sets = 0..if pose.joints.is_empty() { 0 } else { MAX_SETS };
        for set in sets {
            let pair = attribute(Semantic::Joints(set)).zip(attribute(Semantic::Weights(set)));
            let Some((joints, weights)) = pair else {
                break;
            };
            let joints = integers_of(joints, Type::Vec4, &INTEGERS[..2], "JOINTS")?;
            influences.push((joints, open(weights, Type::Vec4, &SHARES, "WEIGHTS")?));
        }
        let indices = primitive
            .indices
            .map(|index| integers_of(index, Type::Scalar, &INTEGERS, "the indices"))
            .transpose()?;
        let mut texcoords = None;
        if let Some(texture) = TextureUse::of(document, primitive.material, name)? {
            match attribute(Semantic::TexCoords(texture.set)) {
                Some(index) => {
                    let accessor = open(index, Type::Vec2, &NUMBERS, "TEXCOORD")?;
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
            targets,
            influences,
            joints: &pose.joints,
            indices,
            texcoords,
        }))
    }

    fn corner_count(&self) -> usize {
        self.indices
            .as_ref()
            .map_or(self.positions.count, |indices| indices.count)
    }

    pub fn triangle_count(&self) -> usize {
        match self.mode {
            Mode::TriangleStrip | Mode::TriangleFan => self.corner_count().saturating_sub(2),
            _ => self.corner_count() / 3,
        }
    }

    /// The vertices of a triangle, counter-clockwise.
    pub fn corners(&self, document: &Document, triangle: usize) -> Result<[usize; 3]> {
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

    /// How many things beside its place move a vertex.
    pub fn deformers(&self) -> usize {
        self.targets.len() + 4 * self.influences.len()
    }

    /// Mesh space to world space at a vertex: of the instance at `place`, or by its joints.
    fn world(&self, place: &DAffine3, vertex: usize) -> DAffine3 {
        if self.joints.is_empty() {
            return *place;
        }
        let mut sum = DAffine3::ZERO;
        let mut weights = 0.0;
        for (joints, shares) in &self.influences {
            if vertex >= joints.count.min(shares.count) {
                break;
            }
            let (joints, shares) = (joints.indices::<4>(vertex), shares.floats::<4>(vertex));
            for (joint, share) in joints.into_iter().zip(shares.map(f64::from)) {
                let Some(matrix) = self.joints.get(joint as usize).filter(|_| share > 0.0) else {
                    continue;
                };
                sum.matrix3 += matrix.matrix3 * share;
                sum.translation += matrix.translation * share;
                weights += share;
            }
        }
        if weights == 0.0 {
            return self.joints[0];
        }
        DAffine3 {
            matrix3: sum.matrix3 * weights.recip(),
            translation: sum.translation / weights,
        }
    }

    /// Whether triangles turn their other side outwards there.
    pub fn is_mirrored(&self, place: &DAffine3, vertex: usize) -> bool {
        self.world(place, vertex).matrix3.determinant() < 0.0
    }

    pub fn position(&self, document: &Document, place: &DAffine3, vertex: usize) -> Result<DVec3> {
        let vector = |accessor: &Accessor| {
            let [x, y, z]: [f32; 3] = accessor.floats(vertex);
            DVec3::new(x.into(), y.into(), z.into())
        };
        let mut local = vector(&self.positions);
        for (weight, target) in &self.targets {
            if vertex < target.count {
                local += *weight * vector(target);
            }
        }
        let position = self.world(place, vertex).transform_point3(local);
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

    pub fn texcoord(&self, document: &Document, vertex: usize) -> Result<Vec2> {
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

/// Notes what of a primitive is not read.
pub(super) fn note_ignored(primitive: &Primitive, name: &str, notes: &mut Notes) {
    if primitive
        .attributes
        .contains_key(&Checked::Valid(Semantic::Colors(0)))
    {
        notes.add("vertex colours are ignored", name);
    }
}
