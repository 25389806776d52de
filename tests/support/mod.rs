//! Builds small glTF files in memory.
#![allow(dead_code)] // Each test program uses a part of it.

pub mod mutate;

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use halfshade::Result;
use halfshade::scene::Scene;
use halfshade::scene::gltf::{LoadOptions, parse};
use serde_json::{Value, json};

pub const U8: u32 = 5121;
pub const U16: u32 = 5123;
pub const U32: u32 = 5125;
pub const F32: u32 = 5126;

/// A glTF with one scene and one buffer.
#[derive(Clone)]
pub struct Gltf {
    pub json: Value,
    pub bytes: Vec<u8>,
}

impl Gltf {
    pub fn new() -> Self {
        let json = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}],
            "buffers": [{"byteLength": 0}],
        });
        Self {
            json,
            bytes: Vec::new(),
        }
    }

    /// One node with one mesh of one primitive of the triangle (0,0,0) (1,0,0) (0,1,0).
    pub fn triangle() -> Self {
        let mut gltf = Self::new();
        let position = gltf.positions(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        gltf.mesh(json!({"attributes": {"POSITION": position}}));
        gltf
    }

    /// Appends to a top-level list and returns the index.
    pub fn push(&mut self, list: &str, value: Value) -> usize {
        if self.json[list].is_null() {
            self.json[list] = json!([]);
        }
        let list = self.json[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.json["buffers"][0]["byteLength"] = self.bytes.len().into();
        let view = json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()});
        self.push("bufferViews", view)
    }

    pub fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        let accessor =
            json!({"bufferView": view, "componentType": component, "type": kind, "count": count});
        self.push("accessors", accessor)
    }

    pub fn positions(&mut self, positions: &[[f32; 3]]) -> usize {
        self.accessor(
            &bytes_of(positions.as_flattened()),
            F32,
            "VEC3",
            positions.len(),
        )
    }

    pub fn texcoords(&mut self, texcoords: &[[f32; 2]]) -> usize {
        self.accessor(
            &bytes_of(texcoords.as_flattened()),
            F32,
            "VEC2",
            texcoords.len(),
        )
    }

    /// A mesh of one primitive and a node of scene 0 that shows it; returns the mesh.
    pub fn mesh(&mut self, primitive: Value) -> usize {
        let mesh = self.push("meshes", json!({"primitives": [primitive]}));
        self.node(json!({"mesh": mesh}));
        mesh
    }

    /// A node at the root of scene 0.
    pub fn node(&mut self, node: Value) -> usize {
        let node = self.push("nodes", node);
        self.json["scenes"][0]["nodes"]
            .as_array_mut()
            .unwrap()
            .push(node.into());
        node
    }

    /// A texture whose image lies in the buffer.
    pub fn texture(&mut self, png: &[u8]) -> usize {
        let view = self.view(png);
        let image = self.push(
            "images",
            json!({"bufferView": view, "mimeType": "image/png"}),
        );
        self.push("textures", json!({"source": image}))
    }

    /// .gltf text with the buffer in a data URI.
    pub fn to_gltf(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if !self.bytes.is_empty() {
            let data = STANDARD.encode(&self.bytes);
            json["buffers"][0]["uri"] =
                format!("data:application/octet-stream;base64,{data}").into();
        }
        serde_json::to_vec(&json).unwrap()
    }

    pub fn to_glb(&self) -> Vec<u8> {
        let mut json = serde_json::to_vec(&self.json).unwrap();
        json.resize(json.len().next_multiple_of(4), b' ');
        let length = 12 + 8 + json.len() + 8 + self.bytes.len();
        let mut glb = b"glTF".to_vec();
        glb.extend(2u32.to_le_bytes());
        glb.extend((length as u32).to_le_bytes());
        for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &self.bytes)] {
            glb.extend((chunk.len() as u32).to_le_bytes());
            glb.extend(kind);
            glb.extend(chunk);
        }
        glb
    }

    /// Takes a GLB apart. None: it is none, or its chunks are not where they should be.
    pub fn from_glb(glb: &[u8]) -> Option<Self> {
        let length = |at: usize| -> Option<usize> {
            let bytes = glb.get(at..at + 4)?.try_into().ok()?;
            Some(u32::from_le_bytes(bytes) as usize)
        };
        let json_end = 20usize.checked_add(length(12)?)?;
        let bytes_end = (json_end + 8).checked_add(length(json_end)?)?;
        Some(Self {
            json: serde_json::from_slice(glb.get(20..json_end)?).ok()?,
            bytes: glb.get(json_end + 8..bytes_end)?.to_vec(),
        })
    }

    pub fn load(&self) -> Result<Scene> {
        self.load_with(&LoadOptions::default())
    }

    pub fn load_with(&self, options: &LoadOptions) -> Result<Scene> {
        parse(Path::new("test.gltf"), &self.to_gltf(), options)
    }

    /// The message with which loading fails.
    pub fn error(&self) -> String {
        self.load()
            .expect_err("this file must be refused")
            .to_string()
    }
}

pub fn bytes_of(values: &[f32]) -> Vec<u8> {
    values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

/// A PNG of these RGBA texels.
pub fn png(width: u32, height: u32, texels: &[[u8; 4]]) -> Vec<u8> {
    encode(width, height, texels, image::ImageFormat::Png)
}

pub fn encode(width: u32, height: u32, texels: &[[u8; 4]], format: image::ImageFormat) -> Vec<u8> {
    let image = image::RgbaImage::from_raw(width, height, texels.as_flattened().to_vec()).unwrap();
    let mut file = std::io::Cursor::new(Vec::new());
    let image = image::DynamicImage::from(image);
    match format {
        image::ImageFormat::Jpeg => image.to_rgb8().write_to(&mut file, format).unwrap(),
        _ => image.write_to(&mut file, format).unwrap(),
    }
    file.into_inner()
}

/// The corners of all triangles in world space, in order.
pub fn corners(scene: &Scene) -> Vec<[[f64; 3]; 3]> {
    (0..scene.triangles.len())
        .map(|i| scene.corners(i).map(|p| p.to_array()))
        .collect()
}

/// Whether a note of the scene holds this text.
pub fn noted(scene: &Scene, text: &str) -> bool {
    scene.notes.iter().any(|note| note.contains(text))
}

/// A triangle with every kind of object that the loader follows.
pub fn textured_triangle(image: &[u8]) -> Gltf {
    let mut gltf = Gltf::new();
    let texture = gltf.texture(image);
    gltf.push("samplers", json!({"magFilter": 9729}));
    gltf.json["textures"][texture]["sampler"] = 0.into();
    let transform = json!({"offset": [0.5, 0.5], "rotation": 0.5});
    let info = json!({"index": texture, "extensions": {"KHR_texture_transform": transform}});
    gltf.push(
        "materials",
        json!({"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": info}}),
    );
    let position = gltf.positions(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]);
    let texcoord = gltf.texcoords(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]);
    let indices = gltf.accessor(&[0, 1, 2, 3], U8, "SCALAR", 4);
    let (slots, values) = (gltf.view(&[3]), gltf.view(&bytes_of(&[1.0, 2.0, 3.0])));
    gltf.json["accessors"][position]["sparse"] = json!({
        "count": 1, "indices": {"bufferView": slots, "componentType": U8},
        "values": {"bufferView": values},
    });
    let attributes = json!({"POSITION": position, "TEXCOORD_0": texcoord});
    gltf.mesh(json!({"attributes": attributes, "indices": indices, "mode": 5, "material": 0}));
    gltf.json["extensions"]["EXT_lights_area"]["lights"] = json!([{"type": "rect", "size": 2.0}]);
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = json!([{"type": "point"}]);
    gltf.push(
        "cameras",
        json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}),
    );
    gltf.node(json!({"camera": 0, "extensions": {"EXT_lights_area": {"light": 0}}}));
    gltf.node(
        json!({"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
        "extensions": {"KHR_lights_punctual": {"light": 0}}}),
    );
    gltf
}

/// A triangle, lit by an area light, with a camera that sees it.
pub fn lit_triangle() -> Gltf {
    let mut gltf = Gltf::triangle();
    gltf.json["extensions"]["EXT_lights_area"]["lights"] = json!([{"type": "rect", "size": 2.0, "rect": {"aspect": 0.5}}, {"type": "disk", "size": 1.0}]);
    gltf.push(
        "cameras",
        json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1, "aspectRatio": 1.5}}),
    );
    gltf.node(json!({"camera": 0, "translation": [0, 0, 5]}));
    for (light, x) in [(0, -0.5), (1, 0.5)] {
        let area = json!({"EXT_lights_area": {"light": light}});
        gltf.node(
            json!({"translation": [x, 0.5, 3], "rotation": [0, 0, 0, 1], "extensions": area}),
        );
    }
    gltf
}

/// A skinned, morphing triangle and instances of a quantized one, some of them hidden.
pub fn posed_triangles() -> Gltf {
    let mut gltf = Gltf::new();
    let joints = gltf.accessor(&[0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0], U8, "VEC4", 3);
    let weights = gltf.accessor(&bytes_of(&[0.5; 12]), F32, "VEC4", 3);
    let moved = gltf.positions(&[[0.0, 0.0, 0.5]; 3]);
    let position = gltf.positions(&SQUARE[..3]);
    gltf.mesh(json!({
        "attributes": {"POSITION": position, "JOINTS_0": joints, "WEIGHTS_0": weights},
        "targets": [{"POSITION": moved}],
    }));
    gltf.json["meshes"][0]["weights"] = json!([0.5]);
    gltf.node(json!({"children": [2]}));
    gltf.push("nodes", json!({"translation": [0, 1, 0]}));
    let identity: [f32; 16] = std::array::from_fn(|i| f32::from(u8::from(i % 5 == 0)));
    let inverse = gltf.accessor(&bytes_of(&[identity; 2].concat()), F32, "MAT4", 2);
    gltf.json["skins"] = json!([{"joints": [1, 2], "inverseBindMatrices": inverse}]);
    gltf.json["nodes"][0]["skin"] = 0.into();
    let quantized = gltf.accessor(&[0, 0, 0, 0, 9, 0, 0, 0, 0, 9, 0, 0], U8, "VEC3", 3);
    let view = gltf.json["accessors"][quantized]["bufferView"]
        .as_u64()
        .unwrap() as usize;
    gltf.json["bufferViews"][view]["byteStride"] = 4.into();
    gltf.mesh(json!({"attributes": {"POSITION": quantized}}));
    let translation = gltf.positions(&[[2.0, 0.0, 0.0], [4.0, 0.0, 0.0]]);
    let rotation = gltf.accessor(&bytes_of(&[0.0, 0.0, 0.0, 1.0].repeat(2)), F32, "VEC4", 2);
    let attributes = json!({"TRANSLATION": translation, "ROTATION": rotation});
    gltf.json["nodes"][3]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = attributes;
    gltf.node(json!({"mesh": 1, "extensions": {"KHR_node_visibility": {"visible": false}}}));
    gltf.json["extensionsUsed"] = json!([
        "EXT_mesh_gpu_instancing",
        "KHR_mesh_quantization",
        "KHR_node_visibility"
    ]);
    gltf
}

/// The corners of a unit square, in the order of a strip.
pub const SQUARE: [[f32; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [1.0, 1.0, 0.0],
];

/// A mesh of the square's corners with further properties of the primitive.
pub fn square(primitive: Value) -> Gltf {
    let mut gltf = Gltf::new();
    let position = gltf.positions(&SQUARE);
    add_primitive(&mut gltf, position, primitive);
    gltf
}

/// A mesh of one primitive with these positions.
pub fn add_primitive(gltf: &mut Gltf, position: usize, mut primitive: Value) {
    primitive["attributes"]["POSITION"] = position.into();
    gltf.mesh(primitive);
}

/// A mesh of one triangle with texture coordinates, all 0, of a material.
pub fn add_textured_triangle(gltf: &mut Gltf, material: usize) {
    let texcoord = gltf.texcoords(&[[0.0; 2]; 3]);
    let position = gltf.positions(&SQUARE[..3]);
    let attributes = json!({"TEXCOORD_0": texcoord});
    let primitive = json!({"attributes": attributes, "material": material});
    add_primitive(gltf, position, primitive);
}

/// A material with this base-colour texture and further properties of the texture's use.
pub fn textured(gltf: &mut Gltf, texture: usize, mut info: Value) -> usize {
    info["index"] = texture.into();
    gltf.push(
        "materials",
        json!({"pbrMetallicRoughness": {"baseColorTexture": info}}),
    )
}
