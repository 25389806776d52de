//! Primitives that Draco has compressed: KHR_draco_mesh_compression.

use std::collections::HashMap;

use draco_core::{
    DataType, DecodeLimits, DecoderBuffer, DracoError, FaceIndex, Mesh as DracoMesh, MeshDecoder,
    PointAttribute, PointIndex,
};
use gltf::json::accessor::ComponentType;
use gltf::json::mesh::{Primitive, Semantic};
use serde::Deserialize;

use super::document::Document;
use crate::Result;

/// [byte] What a face takes in the decoder's own tables, at most.
const FACE_BYTES: u64 = 64;

/// A primitive's vertices and triangles out of a stream.
pub(super) struct Mesh {
    /// [vertex] Of triangles, 32 bits each.
    pub indices: Vec<u8>,
    /// By the numbers that the extension calls them.
    attributes: HashMap<u32, Attribute>,
}

/// The values of all vertices, one after the other.
pub(super) struct Attribute {
    pub bytes: Vec<u8>,
    /// None: of a type that glTF lacks.
    pub component: Option<ComponentType>,
    pub components: usize,
}

/// A primitive that is compressed.
pub(super) struct Compressed<'a> {
    pub mesh: &'a Mesh,
    numbers: HashMap<String, u32>,
}

/// What the extension says.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Json {
    buffer_view: u32,
    attributes: HashMap<String, u32>,
}

impl<'a> Compressed<'a> {
    /// None: the primitive is not compressed.
    ///
    /// # Errors
    /// When what the extension says or refers to is malformed.
    pub fn of(document: &'a Document, primitive: &Primitive, user: &str) -> Result<Option<Self>> {
        let extensions = primitive.extensions.as_ref();
        let Some(json) = extensions.and_then(|all| all.others.get("KHR_draco_mesh_compression"))
        else {
            return Ok(None);
        };
        let json = Json::deserialize(json)
            .map_err(|e| document.error(format!("{user}: its Draco compression: {e}")))?;
        Ok(Some(Self {
            mesh: document.draco(json.buffer_view, user)?,
            numbers: json.attributes,
        }))
    }

    /// None: the attribute is not compressed.
    ///
    /// # Errors
    /// When the stream does not hold it.
    pub fn attribute(
        &self,
        document: &Document,
        semantic: &Semantic,
        user: &str,
    ) -> Result<Option<&'a Attribute>> {
        let semantic = semantic.to_string();
        let Some(number) = self.numbers.get(&semantic) else {
            return Ok(None);
        };
        let found = self.mesh.attributes.get(number);
        found.map(Some).ok_or_else(|| {
            document.error(format!(
                "{user}: its Draco stream has no attribute {number}, which should be its {semantic}"
            ))
        })
    }
}

impl Mesh {
    /// [byte] Of memory.
    pub fn size(&self) -> u64 {
        let attributes = self.attributes.values();
        let values: usize = attributes.map(|attribute| attribute.bytes.len()).sum();
        (self.indices.len() + values) as u64
    }

    /// Decodes a stream to at most so many bytes.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn decode(stream: &[u8], most: u64) -> std::result::Result<Self, DracoError> {
        let limits = DecodeLimits::default()
            .with_max_faces(most / FACE_BYTES)
            .with_max_points(most / FACE_BYTES)
            .with_max_decoded_bytes(most);
        let mut buffer = DecoderBuffer::new(stream).with_limits(limits);
        let mut mesh = DracoMesh::new();
        MeshDecoder::new().decode(&mut buffer, &mut mesh)?;
        let faces = (0..mesh.num_faces()).flat_map(|face| mesh.face(FaceIndex(face as u32)));
        let indices = faces.flat_map(|point| point.0.to_le_bytes()).collect();
        let count = mesh.num_points();
        let attributes = (0..mesh.num_attributes()).map(|id| {
            let attribute = mesh.try_attribute(id)?;
            Ok((attribute.unique_id(), Attribute::of(attribute, count)?))
        });
        Ok(Self {
            indices,
            attributes: attributes.collect::<std::result::Result<_, DracoError>>()?,
        })
    }
}

impl Attribute {
    fn of(attribute: &PointAttribute, count: usize) -> std::result::Result<Self, DracoError> {
        let components = usize::from(attribute.num_components());
        let element = components * attribute.data_type().byte_length();
        let stride = usize::try_from(attribute.byte_stride()).unwrap_or(element);
        let values = attribute.buffer().data();
        let mut bytes = Vec::with_capacity(count * element);
        for point in 0..count {
            let value = attribute.mapped_index(PointIndex(point as u32)).0 as usize;
            let start = value.saturating_mul(stride);
            let range = start..start.saturating_add(element);
            let value = values.get(range);
            bytes.extend_from_slice(value.ok_or_else(|| {
                DracoError::general(format!("vertex {point} refers to a value that is missing"))
            })?);
        }
        Ok(Self {
            bytes,
            component: component_of(attribute.data_type()),
            components,
        })
    }
}

fn component_of(data: DataType) -> Option<ComponentType> {
    match data {
        DataType::Int8 => Some(ComponentType::I8),
        DataType::Uint8 => Some(ComponentType::U8),
        DataType::Int16 => Some(ComponentType::I16),
        DataType::Uint16 => Some(ComponentType::U16),
        DataType::Uint32 => Some(ComponentType::U32),
        DataType::Float32 => Some(ComponentType::F32),
        _ => None,
    }
}
