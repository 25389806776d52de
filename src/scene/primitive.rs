//! One primitive of a mesh, opened for reading: its triangles, and where their vertices stand in a pose.

use glam::{DAffine3, DVec3, Vec2, Vec3, Vec4};
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{self, Index};

use super::accessor::Accessor;
use super::document::Document;
use super::draco::Compressed;
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
    /// With whether they have alpha.
    colors: Option<(Accessor<'a>, bool)>,
}

/// How an accessor is opened that is not compressed.
type Open<'a, 'd> = fn(
    &'a Document<'d>,
    Index<json::Accessor>,
    Type,
    &[ComponentType],
    &str,
) -> Result<Accessor<'a>>;

/// The attributes and indices of a primitive, compressed or not.
struct Attributes<'a, 'd, 'b> {
    document: &'a Document<'d>,
    primitive: &'b Primitive,
    compressed: Option<&'b Compressed<'a>>,
    name: &'b str,
}

impl<'a, 'd> Attributes<'a, 'd, '_> {
    /// Numbers; integers among them must be normalized, but in files that use KHR_mesh_quantization. None: there are none.
    fn numbers(
        &self,
        semantic: Semantic,
        shape: Type,
        components: &[ComponentType],
    ) -> Result<Option<Accessor<'a>>> {
        self.open(semantic, shape, components, Accessor::open)
    }

    /// Integers that stand for themselves. None: there are none.
    fn integers(
        &self,
        semantic: Semantic,
        shape: Type,
        components: &[ComponentType],
    ) -> Result<Option<Accessor<'a>>> {
        self.open(semantic, shape, components, Accessor::open_integers)
    }

    fn open(
        &self,
        semantic: Semantic,
        shape: Type,
        components: &[ComponentType],
        open: Open<'a, 'd>,
    ) -> Result<Option<Accessor<'a>>> {
        let user = format!("{} of {}", semantic.to_string(), self.name);
        let declared = &self.primitive.attributes;
        let Some(&index) = declared.get(&Checked::Valid(semantic.clone())) else {
            return Ok(None);
        };
        let decoded = match self.compressed {
            Some(compressed) => compressed.attribute(self.document, &semantic, self.name)?,
            None => None,
        };
        match decoded {
            Some(attribute) => {
                Accessor::decoded(self.document, index, attribute, shape, components, &user)
            }
            None => open(self.document, index, shape, components, &user),
        }
        .map(Some)
    }

    /// Colours of vertices, and whether they have alpha, which shadows do not ask for.
    fn colors(&self, notes: &mut Notes) -> Result<Option<(Accessor<'a>, bool)>> {
        let semantic = Semantic::Colors(0);
        let declared = &self.primitive.attributes;
        let Some(&index) = declared.get(&Checked::Valid(semantic.clone())) else {
            return Ok(None);
        };
        let json = self.document.get(index, "accessor", self.name)?;
        let has_alpha = json.type_ == Checked::Valid(Type::Vec4);
        if has_alpha {
            notes.add("the alpha of vertex colours is ignored", self.name);
        }
        let shape = if has_alpha { Type::Vec4 } else { Type::Vec3 };
        let colors = self.numbers(semantic, shape, &SHARES)?;
        Ok(colors.map(|colors| (colors, has_alpha)))
    }

    fn indices(&self) -> Result<Option<Accessor<'a>>> {
        if let Some(compressed) = self.compressed {
            return Ok(Some(Accessor::decoded_indices(compressed.mesh)));
        }
        let open = |index| {
            let user = format!("the indices of {}", self.name);
            Accessor::open_integers(self.document, index, Type::Scalar, &INTEGERS, &user)
        };
        self.primitive.indices.map(open).transpose()
    }
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
        let compressed = Compressed::of(document, primitive, name)?;
        let attributes = Attributes {
            document,
            primitive,
            compressed: compressed.as_ref(),
            name,
        };
        let numbers = &NUMBERS[if document.is_quantized() { 0 } else { 4 }..];
        let Some(positions) = attributes.numbers(Semantic::Positions, Type::Vec3, numbers)? else {
            notes.add("a primitive without POSITION is left out", name);
            return Ok(None);
        };
        let mut targets = Vec::new();
        let declared = primitive.targets.iter().flatten();
        for (target, &weight) in declared.zip(&pose.weights) {
            if let Some(index) = target.positions.filter(|_| weight != 0.0) {
                let user = format!("a morph target of {name}");
                let moved = Accessor::open(document, index, Type::Vec3, numbers, &user)?;
                targets.push((weight, moved));
            }
        }
        let mut influences = Vec::new();
        let sets = 0..if pose.joints.is_empty() { 0 } else { MAX_SETS };
        for set in sets {
            let joints = attributes.integers(Semantic::Joints(set), Type::Vec4, &INTEGERS[..2])?;
            let weights = attributes.numbers(Semantic::Weights(set), Type::Vec4, &SHARES)?;
            let Some(pair) = joints.zip(weights) else {
                break;
            };
            influences.push(pair);
        }
        let indices = attributes.indices()?;
        let mut texcoords = None;
        if let Some(texture) = TextureUse::of(document, primitive.material, name)? {
            let semantic = Semantic::TexCoords(texture.set);
            match attributes.numbers(semantic, Type::Vec2, &NUMBERS)? {
                Some(accessor) => texcoords = Some((accessor, texture)),
                None => notes.add(
                    "has no texture coordinates for its texture, whose first texel is taken",
                    name,
                ),
            }
        }
        Ok(Some(Self {
            name,
            // Draco's triangles are listed one by one.
            mode: match compressed {
                Some(_) => Mode::Triangles,
                None => mode,
            },
            positions,
            targets,
            influences,
            joints: &pose.joints,
            indices,
            texcoords,
            colors: attributes.colors(notes)?,
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

    /// [0, 1] Linear RGB of a vertex. None: the primitive has no colours.
    pub fn color(&self, document: &Document, vertex: usize) -> Result<Option<Vec3>> {
        let Some((accessor, has_alpha)) = &self.colors else {
            return Ok(None);
        };
        if vertex >= accessor.count {
            return Err(document.error(format!(
                "{}: vertex {vertex} has no colour, there are only {}",
                self.name, accessor.count
            )));
        }
        let color = match has_alpha {
            true => Vec4::from_array(accessor.floats(vertex)).truncate(),
            false => Vec3::from_array(accessor.floats(vertex)),
        };
        // Written so that NaN becomes black.
        let share = |value: f32| if value > 0.0 { value.min(1.0) } else { 0.0 };
        Ok(Some(Vec3::from(color.to_array().map(share))))
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
