//! A bumpy sheet as glTF, plain and compressed.

use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, Mesh, MeshEncoder,
    PointAttribute, PointIndex,
};
use meshoptimizer_rs::codec::{self, ExpMode, IndexEncoding, VertexEncoding};
use meshoptimizer_rs::{Limits, Workspace};
use serde_json::{Value, json};

use super::{F32, Gltf, U32, bytes_of};

/// [vertex] Along a side.
const SIDE: u32 = 9;
/// Its side in scene units; heights are within 0.25 of 0.
pub const SIZE: f32 = 2.0;

fn positions() -> Vec<[f32; 3]> {
    let place = |i: u32| SIZE * i as f32 / (SIDE - 1) as f32;
    let point = |x: u32, z: u32| {
        let height = 0.25 * (1.7 * x as f32).sin() * (2.3 * z as f32).cos();
        [place(x), height, place(z)]
    };
    let rows = (0..SIDE).flat_map(|z| (0..SIDE).map(move |x| (x, z)));
    rows.map(|(x, z)| point(x, z)).collect()
}

fn texcoords() -> Vec<[f32; 2]> {
    let positions = positions().into_iter();
    positions.map(|[x, _, z]| [x / SIZE, z / SIZE]).collect()
}

fn triangles() -> Vec<[u32; 3]> {
    let quad = |x: u32, z: u32| {
        let first = z * SIDE + x;
        let [a, b, c, d] = [first, first + 1, first + SIDE, first + SIDE + 1];
        [[a, c, b], [b, c, d]]
    };
    let cells = (0..SIDE - 1).flat_map(|z| (0..SIDE - 1).map(move |x| (x, z)));
    cells.flat_map(|(x, z)| quad(x, z)).collect()
}

fn little_endian(indices: &[[u32; 3]]) -> Vec<u8> {
    let indices = indices.as_flattened().iter();
    indices.flat_map(|index| index.to_le_bytes()).collect()
}

/// Its accessors, in a file that nothing compresses.
pub fn plain() -> Gltf {
    let mut gltf = Gltf::new();
    let position = gltf.positions(&positions());
    let texcoord = gltf.texcoords(&texcoords());
    let triangles = triangles();
    let indices = gltf.accessor(
        &little_endian(&triangles),
        U32,
        "SCALAR",
        3 * triangles.len(),
    );
    let attributes = json!({"POSITION": position, "TEXCOORD_0": texcoord});
    gltf.mesh(json!({"attributes": attributes, "indices": indices}));
    gltf
}

/// How meshoptimizer compresses.
#[derive(Debug, Clone, Copy)]
pub struct Meshopt {
    pub extension: &'static str,
    /// Of the streams of vertices and of indices.
    pub versions: [u8; 2],
    /// `TRIANGLES` or `INDICES`.
    pub indices: &'static str,
    /// [bit] Of the mantissas of positions that are filtered.
    pub exponential: Option<u32>,
}

impl Meshopt {
    pub const USUAL: Self = Self {
        extension: "EXT_meshopt_compression",
        versions: [0, 1],
        indices: "TRIANGLES",
        exponential: None,
    };

    pub fn compress(self) -> Gltf {
        let work = &mut Workspace::new(Limits::default());
        let mut gltf = plain();
        gltf.json["extensionsRequired"] = json!([self.extension]);
        gltf.json["extensionsUsed"] = json!([self.extension]);
        gltf.bytes.clear();
        // What readers without the extension would read.
        let length = gltf.json["buffers"][0]["byteLength"].take();
        gltf.push("buffers", json!({"byteLength": length}));
        let (positions, texcoords, triangles) = (positions(), texcoords(), triangles());
        let count = positions.len();
        let vertices = VertexEncoding::new(self.versions[0], 2).expect("a version");
        let places = match self.exponential {
            None => bytes_of(positions.as_flattened()),
            Some(bits) => {
                let flat = positions.as_flattened();
                codec::encode_filter_exp(count, 12, bits, flat, ExpMode::Separate, work)
                    .expect("filtered")
            }
        };
        let places = codec::encode_vertex_buffer(&places, count, 12, vertices, work);
        let texcoords = bytes_of(texcoords.as_flattened());
        let texcoords = codec::encode_vertex_buffer(&texcoords, count, 8, vertices, work);
        let encoding = IndexEncoding::new(self.versions[1]).expect("a version");
        let flat = triangles.as_flattened();
        let indices = match self.indices {
            "TRIANGLES" => codec::encode_index_buffer_generic(flat, encoding, work),
            _ => codec::encode_index_sequence_generic(flat, encoding, work),
        };
        let filter = self.exponential.map_or("NONE", |_| "EXPONENTIAL");
        let views = [
            (places, 12, count, "ATTRIBUTES", filter),
            (texcoords, 8, count, "ATTRIBUTES", "NONE"),
            (indices, 4, flat.len(), self.indices, "NONE"),
        ];
        for (index, (stream, stride, count, mode, filter)) in views.into_iter().enumerate() {
            let stream = stream.expect("encoded");
            let offset = gltf.bytes.len();
            gltf.bytes.extend(&stream);
            let view = &mut gltf.json["bufferViews"][index];
            view["buffer"] = 1.into();
            view["extensions"] = json!({self.extension: {
                "buffer": 0, "byteOffset": offset, "byteLength": stream.len(), "byteStride": stride,
                "count": count, "mode": mode, "filter": filter,
            }});
        }
        gltf.json["buffers"][0]["byteLength"] = gltf.bytes.len().into();
        gltf
    }
}

/// [bit] Of Draco's positions.
pub const DRACO_BITS: i32 = 14;

/// As Draco compresses it at a level from 0, in sequence, to 10.
pub fn draco(level: i32) -> Gltf {
    let mut mesh = Mesh::new();
    let mut add = |kind, components: u8, values: &[f32]| {
        let mut attribute = PointAttribute::new();
        let count = values.len() / usize::from(components);
        attribute.init(kind, components, DataType::Float32, false, count);
        attribute.buffer_mut().write(0, &bytes_of(values));
        mesh.add_attribute(attribute)
    };
    let position = add(
        GeometryAttributeType::Position,
        3,
        positions().as_flattened(),
    );
    let texcoord = add(
        GeometryAttributeType::TexCoord,
        2,
        texcoords().as_flattened(),
    );
    let triangles = triangles();
    mesh.set_num_faces(triangles.len());
    for (face, corners) in (0..).zip(&triangles) {
        mesh.set_face(FaceIndex(face), corners.map(PointIndex));
    }
    let ids = [position, texcoord].map(|id| mesh.attribute(id).unique_id());
    let mut options = EncoderOptions::new();
    options.set_compression_level(level);
    options.set_attribute_quantization(position, DRACO_BITS);
    options.set_attribute_quantization(texcoord, DRACO_BITS);
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(mesh);
    let mut out = EncoderBuffer::new();
    encoder.encode(&options, &mut out).expect("encoded");
    let mut gltf = Gltf::new();
    let view = gltf.view(out.data());
    let count = positions().len();
    let accessor = |component: u32, kind: &str, count: usize| -> Value {
        json!({"componentType": component, "type": kind, "count": count})
    };
    let position = gltf.push("accessors", accessor(F32, "VEC3", count));
    let texcoord = gltf.push("accessors", accessor(F32, "VEC2", count));
    let indices = gltf.push("accessors", accessor(U32, "SCALAR", 3 * triangles.len()));
    let name = "KHR_draco_mesh_compression";
    gltf.json["extensionsRequired"] = json!([name]);
    gltf.json["extensionsUsed"] = json!([name]);
    gltf.mesh(json!({
        "attributes": {"POSITION": position, "TEXCOORD_0": texcoord}, "indices": indices,
        "extensions": {name: {
            "bufferView": view, "attributes": {"POSITION": ids[0], "TEXCOORD_0": ids[1]},
        }},
    }));
    gltf
}
