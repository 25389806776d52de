//! Where vertices stand: instances, skins, morph targets, quantized numbers, hidden nodes.

mod support;

use halfshade::scene::gltf::{Limits, LoadOptions};
use serde_json::{Value, json};
use support::*;

const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// A node of one triangle, with further properties of its mesh's primitive.
fn triangle_with(primitive: Value) -> Gltf {
    let mut gltf = Gltf::new();
    let position = gltf.positions(&SQUARE[..3]);
    add_primitive(&mut gltf, position, primitive);
    gltf
}

fn instanced(translations: &[[f32; 3]], scales: &[[f32; 3]]) -> Gltf {
    let mut gltf = triangle_with(json!({}));
    let rows = |gltf: &mut Gltf, rows: &[[f32; 3]]| {
        gltf.accessor(&bytes_of(rows.as_flattened()), F32, "VEC3", rows.len())
    };
    let (translation, scale) = (rows(&mut gltf, translations), rows(&mut gltf, scales));
    gltf.json["nodes"][0]["extensions"][INSTANCING] =
        json!({"attributes": {"TRANSLATION": translation, "SCALE": scale, "_ID": 77}});
    gltf.json["extensionsUsed"] = json!([INSTANCING]);
    gltf.json["extensionsRequired"] = json!([INSTANCING]);
    gltf
}

#[test]
fn instances_are_copies_to_the_bit() {
    let translations = [[0.25, 1.0, 2.0], [-3.0, 0.1, 0.0], [7.0, 0.0, 1e-3]];
    let scales = [[1.0, 0.5, 2.0], [-1.0, 1.0, 1.0], [0.3, 0.3, 0.3]];
    let mut gltf = instanced(&translations, &scales);
    gltf.json["nodes"][0]["translation"] = json!([10.0, 20.0, 30.0]);
    let mut copies = triangle_with(json!({}));
    copies.json["nodes"][0] = json!({"translation": [10.0, 20.0, 30.0], "children": [1, 2, 3]});
    for (translation, scale) in translations.iter().zip(scales) {
        let node = json!({"mesh": 0, "translation": translation, "scale": scale});
        copies.push("nodes", node);
    }
    let (found, wanted) = (gltf.load().unwrap(), copies.load().unwrap());
    assert_eq!(found.triangles.len(), 3);
    assert_eq!(corners(&found), corners(&wanted));
}

#[test]
fn instances_count_for_the_limits() {
    let gltf = instanced(&[[0.0; 3]; 9], &[[1.0; 3]; 9]);
    let with = |max_triangles, max_primitives| LoadOptions {
        limits: Limits {
            max_triangles,
            max_primitives,
            ..Limits::default()
        },
        ..LoadOptions::default()
    };
    assert!(gltf.load_with(&with(9, 9)).is_ok());
    for options in [with(8, 9), with(9, 8)] {
        let message = gltf.load_with(&options).unwrap_err().to_string();
        assert!(message.contains("exceeds the limit on"), "{message}");
    }
    // An accessor without bytes holds any number of zeros.
    let mut endless = instanced(&[[0.0; 3]], &[[1.0; 3]]);
    let accessors = endless.json["accessors"].as_array_mut().unwrap();
    for accessor in &mut accessors[1..] {
        accessor["count"] = (1u64 << 40).into();
        accessor.as_object_mut().unwrap().remove("bufferView");
    }
    assert!(endless.error().contains("--max-primitives"));
    let mut broken = instanced(&[[0.0; 3]], &[[1.0; 3]]);
    broken.json["nodes"][0]["extensions"][INSTANCING] = json!({"attributes": 7});
    assert!(broken.error().contains(INSTANCING));
}

/// A triangle whose corners belong to joints 0, 1 and half to each.
fn skinned() -> Gltf {
    let mut gltf = Gltf::new();
    let joints = gltf.accessor(&[0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0], U8, "VEC4", 3);
    let shares: [[f32; 4]; 3] = [
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.5, 0.5, 0.0, 0.0],
    ];
    let weights = gltf.accessor(&bytes_of(shares.as_flattened()), F32, "VEC4", 3);
    let attributes = json!({"JOINTS_0": joints, "WEIGHTS_0": weights});
    let position = gltf.positions(&SQUARE[..3]);
    add_primitive(&mut gltf, position, json!({"attributes": attributes}));
    gltf.node(json!({"translation": [1.0, 0.0, 0.0], "scale": [2.0, 2.0, 2.0]}));
    gltf.node(json!({"translation": [0.0, 0.0, 4.0]}));
    gltf.json["skins"] = json!([{"joints": [1, 2]}]);
    gltf.json["nodes"][0]["skin"] = 0.into();
    gltf
}

#[test]
fn skins_follow_their_joints_alone() {
    let mut gltf = skinned();
    // Joint 0 doubles and moves by 1 along x, joint 1 moves by 4 along z; the third corner takes the mean of both.
    let posed = [[1.0, 0.0, 0.0], [1.0, 0.0, 4.0], [0.5, 1.5, 2.0]];
    assert_eq!(corners(&gltf.load().unwrap()), [posed]);
    gltf.json["nodes"][0]["translation"] = json!([100.0, 0.0, 0.0]);
    assert_eq!(corners(&gltf.load().unwrap()), [posed]);

    // Inverse bind matrices come before the joints.
    let mut inverse = [0.0f32; 32];
    for i in [0, 5, 10, 15] {
        (inverse[i], inverse[16 + i]) = (1.0, 1.0);
    }
    inverse[12] = -1.0;
    let matrices = gltf.accessor(&bytes_of(&inverse), F32, "MAT4", 2);
    gltf.json["skins"][0]["inverseBindMatrices"] = matrices.into();
    let moved = [[-1.0, 0.0, 0.0], [1.0, 0.0, 4.0], [-0.5, 1.5, 2.0]];
    assert_eq!(corners(&gltf.load().unwrap()), [moved]);
}

#[test]
fn malformed_skins_do_no_harm() {
    let mut gltf = skinned();
    gltf.json["skins"][0]["joints"] = json!([1]);
    // Weights of joints that are not there count for nothing.
    assert_eq!(gltf.load().unwrap().triangles.len(), 1);
    gltf.json["skins"][0]["joints"] = json!([77]);
    assert!(gltf.error().contains("node 77, which does not exist"));
    let mut gltf = skinned();
    gltf.json["nodes"][0]["skin"] = 7.into();
    assert!(gltf.error().contains("skin 7, which does not exist"));
    let mut gltf = skinned();
    gltf.json["scenes"][0]["nodes"] = json!([0]);
    assert!(noted(
        &gltf.load().unwrap(),
        "a joint is no node of the scene"
    ));
}

#[test]
fn morph_targets_have_the_weights_of_the_node_or_of_the_mesh() {
    let mut gltf = Gltf::new();
    let targets = [[0.0, 0.0, 1.0], [0.0, 0.0, 10.0]]
        .map(|way: [f32; 3]| gltf.accessor(&bytes_of([way; 3].as_flattened()), F32, "VEC3", 3));
    let targets = targets.map(|target| json!({"POSITION": target}));
    let position = gltf.positions(&SQUARE[..3]);
    add_primitive(&mut gltf, position, json!({"targets": targets}));
    let height = |gltf: &Gltf| gltf.load().unwrap().corners(0)[0].z;
    assert_eq!(height(&gltf), 0.0);
    gltf.json["meshes"][0]["weights"] = json!([0.5, 0.25]);
    assert_eq!(height(&gltf), 3.0);
    gltf.json["nodes"][0]["weights"] = json!([2.0]);
    assert_eq!(height(&gltf), 2.0);
    // More weights than targets are of no use.
    gltf.json["nodes"][0]["weights"] = json!([0.0, 1.0, 9.0]);
    assert_eq!(height(&gltf), 10.0);
}

#[test]
fn quantized_positions_are_what_they_stand_for() {
    let quantized = |normalized: bool| {
        let mut gltf = Gltf::new();
        let rows: [i16; 12] = [0, 0, 0, 0, 32767, 0, -32768, 0, 0, -32767, 16384, 0];
        let bytes: Vec<u8> = rows.iter().flat_map(|x| x.to_le_bytes()).collect();
        // Elements of 8 bytes, for vertices are aligned.
        let accessor = gltf.accessor(&bytes, 5122, "VEC3", 3);
        gltf.json["bufferViews"][0]["byteStride"] = 8.into();
        gltf.json["accessors"][accessor]["normalized"] = normalized.into();
        gltf.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        gltf.json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
        add_primitive(&mut gltf, accessor, json!({}));
        gltf
    };
    let found = corners(&quantized(false).load().unwrap());
    assert_eq!(
        found,
        [[[0.0; 3], [32767.0, 0.0, -32768.0], [0.0, -32767.0, 16384.0]]]
    );
    let found = quantized(true).load().unwrap().corners(0);
    assert_eq!(found[1].to_array(), [1.0, 0.0, -1.0]);
    assert_eq!(
        found[2].to_array(),
        [0.0, -1.0, f64::from(16384f32 / 32767f32)]
    );
}

#[test]
fn hidden_nodes_hide_what_is_below_them() {
    let mut gltf = triangle_with(json!({}));
    gltf.json["nodes"][0] = json!({"children": [1]});
    gltf.push("nodes", json!({"mesh": 0}));
    assert_eq!(gltf.load().unwrap().triangles.len(), 1);
    gltf.json["nodes"][0]["extensions"]["KHR_node_visibility"] = json!({"visible": false});
    assert!(gltf.load().unwrap().triangles.is_empty());
    gltf.json["nodes"][0]["extensions"]["KHR_node_visibility"] = json!({"visible": true});
    assert_eq!(gltf.load().unwrap().triangles.len(), 1);
}
