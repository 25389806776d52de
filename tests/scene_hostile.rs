//! Malformed and hostile glTF: one clear error, no panic, no hang, no allocation out of proportion.

mod support;

use std::path::Path;
use std::time::{Duration, Instant};

use halfshade::scene::gltf::{Limits, LoadOptions, load, parse};
use serde_json::json;
use support::*;

fn error_of(bytes: &[u8]) -> String {
    let loaded = parse(Path::new("test.glb"), bytes, &LoadOptions::default());
    loaded.expect_err("this file must be refused").to_string()
}

#[test]
fn files_that_are_no_gltf() {
    assert!(error_of(b"{").contains("is not a glTF file"));
    for (bytes, what) in [
        (&b""[..], "is empty"),
        (b"solid cube", "STL"),
        (b"\xff\xfe{\0", "UTF-16"),
        (b"\xef\xbb\xbf <!DOCTYPE HTML>", "a web page"),
        (b"<HTML lang=en>", "a web page"),
        (
            b"version https://git-lfs.github.com/spec/v1\noid sha256:0\n",
            "git lfs pull",
        ),
        (b"Kaydara FBX Binary  \0", "FBX"),
        (b"#usda 1.0\n", "USD"),
        (b"PXR-USDC\0", "USD"),
        (b"# Blender 4.2\nmtllib cube.mtl\no Cube\n", "Wavefront OBJ"),
        (b"v 0 0 0\nv 1 0 0\n", "Wavefront OBJ"),
        (b"PK\x03\x04", "zip"),
        (
            br#"{"asset": {"version": "1.0"}, "scenes": {"s": {}}}"#,
            "only 2.x",
        ),
        (b"glTF\x01\0\0\0\x14\0\0\0", "version 1"),
    ] {
        let message = error_of(bytes);
        assert!(message.contains(what), "{what}: {message}");
    }
    assert!(error_of(br#"{"asset": {"version": "2.0"}}"#).contains("no scene 0"));
    let folder = tempfile::tempdir().unwrap();
    assert!(load(folder.path(), &LoadOptions::default()).is_err());
    assert!(load(&folder.path().join("none.glb"), &LoadOptions::default()).is_err());
    assert!(load(Path::new("/dev/zero"), &LoadOptions::default()).is_err());
}

#[test]
fn truncated_glbs() {
    let glb = Gltf::triangle().to_glb();
    for length in 0..glb.len() {
        let message = error_of(&glb[..length]);
        assert!(message.starts_with("test.glb: "), "{length}: {message}");
    }
}

#[test]
fn paths_stay_in_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).unwrap();
    let mut gltf = Gltf::triangle();
    std::fs::write(folder.path().join("data.bin"), &gltf.bytes).unwrap();
    std::os::unix::fs::symlink("../data.bin", inner.join("link.bin")).unwrap();
    let path = inner.join("scene.gltf");
    let absolute = folder.path().join("data.bin").display().to_string();
    for uri in [
        "../data.bin",
        "./../data.bin",
        "a/../../data.bin",
        "%2e%2e/data.bin",
        "..%2fdata.bin",
        "%2E%2E%2Fdata.bin",
        "..\\data.bin",
        "%2e%2e%5Cdata.bin",
        "%2Fetc/hostname",
        "//host/data.bin",
        "file:///etc/hostname",
        "https://example.com/data.bin",
        "C:/data.bin",
        "link.bin",
        "",
        "..",
        "%00",
        "%ff",
        &absolute,
    ] {
        gltf.json["buffers"][0]["uri"] = uri.into();
        std::fs::write(&path, serde_json::to_vec(&gltf.json).unwrap()).unwrap();
        let message = load(&path, &LoadOptions::default())
            .unwrap_err()
            .to_string();
        assert!(message.contains("refuses to read"), "{uri:?}: {message}");
    }
    // Encoded twice, it is an odd name in the same folder.
    let mut load_uri = |uri: &str, outside_paths| {
        gltf.json["buffers"][0]["uri"] = uri.into();
        std::fs::write(&path, serde_json::to_vec(&gltf.json).unwrap()).unwrap();
        let options = LoadOptions {
            outside_paths,
            ..LoadOptions::default()
        };
        load(&path, &options).map_err(|error| error.to_string())
    };
    let message = load_uri("%252e%252e%252fdata.bin", false).unwrap_err();
    assert!(message.contains("No such file"), "{message}");
    // Where it is allowed, files may lie anywhere on this machine, and nowhere else.
    let url = format!("file://{absolute}");
    for uri in [
        "../data.bin",
        "%2e%2e/data.bin",
        "link.bin",
        &absolute,
        &url,
    ] {
        let message = load_uri(uri, false).unwrap_err();
        assert!(message.contains("--allow-outside-paths"), "{message}");
        assert_eq!(load_uri(uri, true).unwrap().triangles.len(), 1, "{uri:?}");
    }
    for uri in [
        "https://example.com/data.bin",
        "file://host/data.bin",
        "C:/data.bin",
        "..",
        "%00",
    ] {
        let message = load_uri(uri, true).unwrap_err();
        assert!(
            message.contains("names no file on this machine"),
            "{uri:?}: {message}"
        );
    }
}

#[test]
fn required_extensions_are_named() {
    for name in ["KHR_texture_something", "EXT_something"] {
        let mut gltf = Gltf::triangle();
        gltf.json["extensionsRequired"] = json!([name]);
        assert!(gltf.error().contains(name));
        gltf.json["extensionsRequired"] = json!(["KHR_texture_transform", "KHR_lights_punctual"]);
        gltf.json["extensionsUsed"] = json!([name]);
        assert!(noted(&gltf.load().unwrap(), name));
    }
}

#[test]
fn ranges_are_checked() {
    let good = Gltf::triangle();
    let error = |change: &dyn Fn(&mut serde_json::Value)| {
        let mut gltf = good.clone();
        change(&mut gltf.json);
        gltf.error()
    };
    let message = error(&|json| json["accessors"][0]["count"] = 103.into());
    assert!(
        message.contains("accessor 0: reads 1200 bytes beyond the end of buffer view 0"),
        "{message}"
    );
    let message = error(&|json| json["bufferViews"][0]["byteLength"] = 1000.into());
    assert!(
        message.contains("buffer view 0: 1000 bytes from byte 0 do not fit"),
        "{message}"
    );
    let message = error(&|json| json["buffers"][0]["byteLength"] = 1000.into());
    assert!(
        message.contains("buffer 0: holds 36 bytes instead of 1000"),
        "{message}"
    );
    let message = error(&|json| json["bufferViews"][0]["byteStride"] = u64::MAX.into());
    assert!(message.contains("beyond the end"), "{message}");
    let message = error(&|json| json["bufferViews"][0]["byteStride"] = 4.into());
    assert!(message.contains("wider than the stride"), "{message}");
    for key in ["byteOffset", "count"] {
        let message = error(&|json| json["accessors"][0][key] = u64::MAX.into());
        assert!(message.contains("beyond the end"), "{message}");
    }
    for (list, key) in [("bufferViews", "byteOffset"), ("bufferViews", "byteLength")] {
        let message = error(&|json| json[list][0][key] = u64::MAX.into());
        assert!(message.contains("do not fit"), "{message}");
    }
    for (list, key, kind) in [
        ("accessors", "bufferView", "buffer view 77"),
        ("bufferViews", "buffer", "buffer 77"),
        ("nodes", "mesh", "mesh 77"),
        ("nodes", "camera", "camera 77"),
    ] {
        let message = error(&|json| json[list][0][key] = 77.into());
        assert!(
            message.contains(&format!("{kind}, which does not exist")),
            "{message}"
        );
    }
    let message = error(&|json| json["meshes"][0]["primitives"][0]["material"] = 77.into());
    assert!(
        message.contains("material 77, which does not exist"),
        "{message}"
    );
    let message = error(&|json| json["accessors"][0]["componentType"] = U16.into());
    assert!(message.contains("must be Vec3 of F32"), "{message}");
    let message = error(&|json| {
        json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
        json["accessors"][0]["componentType"] = 5125.into();
    });
    assert!(message.contains("or I16 or F32"), "{message}");
}

#[test]
fn indices_out_of_range() {
    let mut gltf = Gltf::new();
    let position = gltf.positions(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let indices = gltf.accessor(&[0, 1, 255], U8, "SCALAR", 3);
    gltf.mesh(json!({"attributes": {"POSITION": position}, "indices": indices}));
    assert!(
        gltf.error()
            .contains("mesh 0: the index 255 is out of range, it has 3 vertices")
    );
}

#[test]
fn nodes_must_form_a_tree() {
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"] = json!([{"children": [1]}, {"children": [0]}]);
    assert!(gltf.error().contains("reached twice"));
    gltf.json["nodes"] = json!([{"children": [1, 2]}, {"children": [2]}, {}]);
    assert!(gltf.error().contains("node 2: is reached twice"));
    gltf.json["nodes"] = json!([{"children": [9]}]);
    assert!(gltf.error().contains("node 9, which does not exist"));
}

#[test]
fn deep_trees() {
    let count = 100_000;
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"] = (1..count)
        .map(|child| json!({"children": [child]}))
        .collect();
    gltf.push("nodes", json!({"mesh": 0}));
    assert_eq!(gltf.load().unwrap().triangles.len(), 1);
    let nested = "[".repeat(100_000);
    assert!(error_of(nested.as_bytes()).contains("is not a glTF file"));
}

#[test]
fn positions_must_be_finite() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3e38] {
        let mut gltf = Gltf::new();
        let position = gltf.positions(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, bad, 0.0]]);
        gltf.mesh(json!({"attributes": {"POSITION": position}}));
        gltf.json["meshes"][0]["name"] = "leaf".into();
        let message = gltf.error();
        assert!(message.contains("mesh 0 (\"leaf\"): vertex 2"), "{message}");
    }
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"][0]["scale"] = json!([1e300, 1e300, 1e300]);
    assert!(gltf.error().contains("vertex 1"));
}

#[test]
fn huge_counts_are_refused_quickly() {
    let start = Instant::now();
    // Zeros without a byte behind them, as many as can be counted.
    for count in [1u64 << 40, u64::MAX] {
        let mut gltf = Gltf::triangle();
        gltf.json["accessors"][0] = json!({"componentType": F32, "type": "VEC3", "count": count});
        assert!(
            gltf.error()
                .contains("limit on triangles (instances counted); raise --max-triangles")
        );
    }
    // As many as the limit allows cost time, but no memory.
    let mut gltf = Gltf::triangle();
    gltf.json["accessors"][0] = json!({"componentType": F32, "type": "VEC3", "count": 3 << 21});
    assert!(gltf.load().unwrap().positions.is_empty());
    // Instances multiply: 1000 nodes, each with 100,000 empty primitives.
    let mut gltf = Gltf::new();
    let position = gltf.positions(&[[0.0; 3]]);
    let primitives = vec![json!({"attributes": {"POSITION": position}}); 100_000];
    gltf.push("meshes", json!({"primitives": primitives}));
    for _ in 0..1000 {
        gltf.node(json!({"mesh": 0}));
    }
    let message = gltf.error();
    assert!(message.contains("mesh 0: expands to far more"), "{message}");
    assert!(
        start.elapsed() < Duration::from_secs(20),
        "{:?}",
        start.elapsed()
    );
    // A limit of one's own.
    let limits = Limits {
        max_triangles: 1,
        ..Limits::default()
    };
    let options = LoadOptions {
        limits,
        ..LoadOptions::default()
    };
    let mut gltf = Gltf::triangle();
    assert!(gltf.load_with(&options).is_ok());
    gltf.node(json!({"mesh": 0}));
    assert!(gltf.load_with(&options).is_err());
}

#[test]
fn textures_have_limits() {
    let mut gltf = textured_triangle(&png(2, 2, &[[255; 4]; 4]));
    let options = |max_texture_side, max_texels| LoadOptions {
        limits: Limits {
            max_texture_side,
            max_texels,
            ..Limits::default()
        },
        ..LoadOptions::default()
    };
    assert!(gltf.load_with(&options(2, 4)).is_ok());
    for options in [options(1, 4), options(2, 3)] {
        let message = gltf.load_with(&options).unwrap_err().to_string();
        assert!(
            message.contains("image 0: its 2×2 texels exceed the limit"),
            "{message}"
        );
    }
    assert!(
        textured_triangle(b"GIF89a-----")
            .error()
            .contains("not in PNG, JPEG or WebP")
    );
    gltf.json["images"][0] = json!({});
    assert!(gltf.error().contains("neither a uri nor a buffer view"));
    gltf.json["images"][0] = json!({"uri": "data:image/png;base64,!!!"});
    assert!(gltf.error().contains("not valid base64"));
}

/// A picture of 2×2 texels that claims to be larger, and is right in everything else.
fn bomb(side: u32) -> Gltf {
    let mut bomb = png(2, 2, &[[255; 4]; 4]);
    bomb[16..20].copy_from_slice(&side.to_be_bytes());
    bomb[20..24].copy_from_slice(&side.to_be_bytes());
    let checksum = crc32fast::hash(&bomb[12..29]);
    bomb[29..33].copy_from_slice(&checksum.to_be_bytes());
    textured_triangle(&bomb)
}

/// Small files that would take a lot of memory are refused, each by a limit that can be raised.
#[test]
fn bombs_are_refused() {
    let wide = Limits {
        max_texture_side: 65535,
        ..Limits::default()
    };
    let many = Limits {
        max_texels: u64::MAX,
        ..wide.clone()
    };
    let trusted = Limits {
        max_expansion: u64::MAX,
        ..many.clone()
    };
    for (side, limits, knob) in [
        (65535, Limits::default(), "--max-texture-side"),
        (65535, wide, "--max-texels"),
        (65535, many, "--max-expansion"),
        (10000, Limits::default(), "--max-expansion"),
    ] {
        let options = LoadOptions {
            limits,
            ..LoadOptions::default()
        };
        let message = bomb(side).load_with(&options).unwrap_err().to_string();
        assert!(message.contains(knob), "{side}: {message}");
    }
    // Where it is trusted, it is found to be no picture of that size.
    let options = LoadOptions {
        limits: trusted,
        ..LoadOptions::default()
    };
    let message = bomb(10000).load_with(&options).unwrap_err().to_string();
    assert!(message.contains("cannot be decoded"), "{message}");
}

/// Instances and files that are named over and over multiply what a small file holds.
#[test]
fn repetition_is_refused() {
    let limits = Limits {
        max_expansion: 1,
        ..Limits::default()
    };
    let options = LoadOptions {
        limits,
        ..LoadOptions::default()
    };
    let mut gltf = Gltf::new();
    let corners: Vec<[f32; 3]> = (0..30_000)
        .map(|i| [i as f32, (i * i % 7) as f32, 0.0])
        .collect();
    let position = gltf.positions(&corners);
    gltf.mesh(json!({"attributes": {"POSITION": position}}));
    for _ in 0..10_000 {
        gltf.node(json!({"mesh": 0}));
    }
    let message = gltf.error();
    assert!(
        message.contains("mesh 0") && message.contains("--max-expansion"),
        "{message}"
    );

    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.bin"), vec![0; 1 << 20]).unwrap();
    let mut gltf = Gltf::triangle();
    for index in 0..300 {
        let buffer = gltf.push(
            "buffers",
            json!({"uri": "./".repeat(index) + "a.bin", "byteLength": 1 << 20}),
        );
        let view = gltf.push("bufferViews", json!({"buffer": buffer, "byteLength": 36}));
        let accessor =
            json!({"bufferView": view, "componentType": F32, "type": "VEC3", "count": 3});
        let position = gltf.push("accessors", accessor);
        gltf.mesh(json!({"attributes": {"POSITION": position}}));
    }
    let path = folder.path().join("scene.gltf");
    std::fs::write(&path, gltf.to_gltf()).unwrap();
    let message = load(&path, &options).unwrap_err().to_string();
    assert!(
        message.contains("buffer ") && message.contains("--max-expansion"),
        "{message}"
    );
}
