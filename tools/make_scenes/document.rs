//! A glTF 2.0 file under construction.

use glam::{DQuat, DVec2, DVec3};
use serde_json::{Map, Value, json};

use halfshade::scene::Shape;

/// glTF's number for each index type.
#[derive(Clone, Copy)]
pub enum Index {
    U8 = 5121,
    U16 = 5123,
    U32 = 5125,
}

/// glTF's number for each way to read triangles from a list of points.
#[derive(Clone, Copy)]
pub enum Mode {
    Triangles = 4,
    Strip = 5,
    Fan = 6,
}

/// glTF's number for f32 components.
const F32: u32 = 5126;
/// glTF's targets of buffer views.
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

/// The arrays of the file by name, and the buffer that they refer to.
#[derive(Default)]
pub struct Document {
    json: Map<String, Value>,
    bin: Vec<u8>,
    area_lights: Vec<Value>,
}

impl Document {
    /// Appends to one of the file's arrays; returns the index.
    fn push(&mut self, array: &str, value: Value) -> usize {
        let entry = self.json.entry(array).or_insert_with(|| json!([]));
        let list = entry.as_array_mut().expect("every entry is an array");
        list.push(value);
        list.len() - 1
    }

    pub fn camera(&mut self, camera: Value) -> usize {
        self.push("cameras", camera)
    }

    pub fn node(&mut self, node: Value) -> usize {
        self.push("nodes", node)
    }

    /// The first scene is the one that is shown.
    pub fn scene(&mut self, name: &str, nodes: &[usize]) {
        self.push("scenes", json!({ "name": name, "nodes": nodes }));
    }

    /// A rough, two-sided surface of this linear colour.
    pub fn material(&mut self, name: &str, rgb: [f64; 3]) -> usize {
        let [r, g, b] = rgb;
        self.raw_material(json!({
            "name": name, "doubleSided": true,
            "pbrMetallicRoughness": {
                "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0,
            },
        }))
    }

    pub fn raw_material(&mut self, material: Value) -> usize {
        self.push("materials", material)
    }

    /// A texture of the PNG file, bilinear and clamped to its edge.
    pub fn texture(&mut self, png: &[u8]) -> usize {
        let view = self.view(png, json!({}));
        let source = self.push(
            "images",
            json!({ "bufferView": view, "mimeType": "image/png" }),
        );
        let sampler = self.push(
            "samplers",
            json!({ "magFilter": 9729, "minFilter": 9729, "wrapS": 33071, "wrapT": 33071 }),
        );
        self.push("textures", json!({ "source": source, "sampler": sampler }))
    }

    /// A node with an EXT_lights_area light.
    pub fn area_light(&mut self, center: DVec3, rotation: DQuat, light: Value) -> usize {
        self.area_lights.push(light);
        self.node(json!({
            "name": "light", "translation": center.to_array(), "rotation": rotation.to_array(),
            "extensions": { "EXT_lights_area": { "light": self.area_lights.len() - 1 } },
        }))
    }

    pub fn mesh(&mut self, name: &str, primitives: &[Value]) -> usize {
        self.push("meshes", json!({ "name": name, "primitives": primitives }))
    }

    /// A primitive of indexed triangles.
    pub fn indexed(&mut self, shape: &Shape, index: Index, material: usize) -> Value {
        let position = self.positions(&shape.positions);
        let indices = self.indices(shape, index);
        primitive(position, indices, material)
    }

    /// A primitive without indices.
    pub fn unindexed(&mut self, points: &[DVec3], mode: Mode, material: usize) -> Value {
        let position = self.positions(points);
        json!({
            "attributes": { "POSITION": position }, "mode": mode as u32, "material": material,
        })
    }

    pub fn indices(&mut self, shape: &Shape, index: Index) -> usize {
        let flat = shape.triangles.iter().flatten();
        let count = flat.clone().count();
        let bytes: Vec<u8> = match index {
            Index::U8 => flat.map(|&i| i as u8).collect(),
            Index::U16 => flat.flat_map(|&i| (i as u16).to_le_bytes()).collect(),
            Index::U32 => flat.flat_map(|&i| i.to_le_bytes()).collect(),
        };
        let view = self.view(&bytes, json!({ "target": INDICES }));
        self.push(
            "accessors",
            json!({
                "bufferView": view, "componentType": index as u32, "count": count, "type": "SCALAR",
            }),
        )
    }

    pub fn positions(&mut self, points: &[DVec3]) -> usize {
        let bytes: Vec<u8> = points.iter().flat_map(|&p| position_bytes(p)).collect();
        // The stride must be said for views that several accessors read, as a sparse one does.
        let view = self.view(&bytes, json!({ "target": VERTICES, "byteStride": 12 }));
        self.position_accessor(points, json!({ "bufferView": view }))
    }

    /// Positions as the accessor `base` has them, except for the last ones: a sparse accessor.
    pub fn positions_but_last(&mut self, base: usize, points: &[DVec3], changed: usize) -> usize {
        let first = points.len() - changed;
        let indices: Vec<u8> = (first..points.len()).map(|i| i as u8).collect();
        let indices = self.view(&indices, json!({}));
        let values: Vec<u8> = points[first..]
            .iter()
            .flat_map(|&p| position_bytes(p))
            .collect();
        let values = self.view(&values, json!({}));
        let view = self.json["accessors"][base]["bufferView"].clone();
        let sparse = json!({
            "count": changed,
            "indices": { "bufferView": indices, "componentType": Index::U8 as u32 },
            "values": { "bufferView": values },
        });
        self.position_accessor(points, json!({ "bufferView": view, "sparse": sparse }))
    }

    /// Positions and f32 texture coordinates in one buffer view: (POSITION, TEXCOORD_0).
    pub fn interleaved(&mut self, points: &[DVec3], uvs: &[DVec2]) -> (usize, usize) {
        let mut bytes = Vec::new();
        for (&p, uv) in points.iter().zip(uvs) {
            bytes.extend(position_bytes(p));
            bytes.extend(uv.to_array().iter().flat_map(|&x| stored(x).to_le_bytes()));
        }
        let view = self.view(&bytes, json!({ "target": VERTICES, "byteStride": 20 }));
        let position = self.position_accessor(points, json!({ "bufferView": view }));
        let uv = json!({
            "bufferView": view, "byteOffset": 12,
            "componentType": F32, "count": uvs.len(), "type": "VEC2",
        });
        (position, self.push("accessors", uv))
    }

    /// Texture coordinates in [0, 1] as normalized u16.
    pub fn normalized_texcoords(&mut self, uvs: &[DVec2]) -> usize {
        let bytes: Vec<u8> = uvs
            .iter()
            .flat_map(|uv| uv.to_array())
            .flat_map(|x| ((x * 65535.0).round() as u16).to_le_bytes())
            .collect();
        let view = self.view(&bytes, json!({ "target": VERTICES }));
        self.push(
            "accessors",
            json!({
                "bufferView": view, "componentType": Index::U16 as u32, "normalized": true,
                "count": uvs.len(), "type": "VEC2",
            }),
        )
    }

    /// Completes an accessor of positions with their type, count and bounds.
    fn position_accessor(&mut self, points: &[DVec3], mut accessor: Value) -> usize {
        let stored = points.iter().map(|p| p.to_array().map(stored));
        let (mut lo, mut hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for p in stored {
            for axis in 0..3 {
                lo[axis] = lo[axis].min(p[axis]);
                hi[axis] = hi[axis].max(p[axis]);
            }
        }
        accessor["componentType"] = json!(F32);
        accessor["type"] = json!("VEC3");
        accessor["count"] = json!(points.len());
        accessor["min"] = json!(lo);
        accessor["max"] = json!(hi);
        self.push("accessors", accessor)
    }

    /// Appends bytes to the buffer, at a multiple of 4; `view` holds the keys that are special to it.
    fn view(&mut self, bytes: &[u8], mut view: Value) -> usize {
        view["buffer"] = json!(0);
        view["byteOffset"] = json!(self.bin.len());
        view["byteLength"] = json!(bytes.len());
        self.bin.extend(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.push("bufferViews", view)
    }

    /// The complete JSON for a buffer at this address (none: the GLB's own), and the buffer.
    fn finish(mut self, uri: Option<&str>) -> (Value, Vec<u8>) {
        let mut buffer = json!({ "byteLength": self.bin.len() });
        if let Some(uri) = uri {
            buffer["uri"] = json!(uri);
        }
        self.push("buffers", buffer);
        let mut used = vec!["EXT_lights_area"];
        let mut json = Value::Object(self.json);
        if json["materials"]
            .to_string()
            .contains("KHR_texture_transform")
        {
            used.push("KHR_texture_transform");
        }
        json["asset"] = json!({ "version": "2.0", "generator": "halfshade make_scenes" });
        json["scene"] = json!(0);
        json["extensionsUsed"] = json!(used);
        json["extensions"] = json!({ "EXT_lights_area": { "lights": self.area_lights } });
        (json, self.bin)
    }

    /// A `.gltf` and its `.bin`, which will be called `uri`.
    pub fn into_gltf(self, uri: &str) -> (String, Vec<u8>) {
        let (json, bin) = self.finish(Some(uri));
        (format!("{json:#}\n"), bin)
    }

    /// A `.glb`: the header, the chunk of JSON padded with spaces, the chunk of the buffer.
    pub fn into_glb(self) -> Vec<u8> {
        let (json, bin) = self.finish(None);
        let mut json = json.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut glb = b"glTF".to_vec();
        let length = 12 + 8 + json.len() + 8 + bin.len();
        glb.extend([2, length as u32].iter().flat_map(|n| n.to_le_bytes()));
        for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &bin)] {
            glb.extend((chunk.len() as u32).to_le_bytes());
            glb.extend(kind);
            glb.extend(chunk);
        }
        glb
    }
}

/// A primitive of indexed triangles of one colour.
pub fn primitive(position: usize, indices: usize, material: usize) -> Value {
    json!({ "attributes": { "POSITION": position }, "indices": indices, "material": material })
}

fn position_bytes(p: DVec3) -> [u8; 12] {
    let [x, y, z] = p.to_array().map(|x| stored(x).to_le_bytes());
    let mut bytes = [0; 12];
    bytes[..4].copy_from_slice(&x);
    bytes[4..8].copy_from_slice(&y);
    bytes[8..].copy_from_slice(&z);
    bytes
}

/// A coordinate as the file holds it: rounded to 2⁻¹⁶, so that the last bit of a platform's sine
/// does not reach the file, and never −0.
fn stored(x: f64) -> f32 {
    ((x * 65536.0).round() / 65536.0 + 0.0) as f32
}
