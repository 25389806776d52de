//! Files as tools write them, and what shadows can do without.

mod support;

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use halfshade::Result;
use halfshade::scene::Scene;
use halfshade::scene::gltf::{Blend, LoadOptions, parse};
use serde_json::{Value, json};
use support::*;

fn load(bytes: &[u8]) -> Result<Scene> {
    parse(Path::new("test.glb"), bytes, &LoadOptions::default())
}

fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let length = (data.len() as u32).to_le_bytes();
    [&length, &kind[..], data].concat()
}

fn glb(length: u32, chunks: &[Vec<u8>]) -> Vec<u8> {
    let header = [&b"glTF\x02\0\0\0"[..], &length.to_le_bytes()].concat();
    [header, chunks.concat()].concat()
}

#[test]
fn containers_that_are_not_quite_tidy() {
    let gltf = Gltf::triangle();
    let text = serde_json::to_vec(&gltf.json).unwrap();
    let json = |text: &[u8]| chunk(b"JSON", text);
    let binary = chunk(b"BIN\0", &gltf.bytes);
    let other = chunk(b"What", b"ever");
    let mut padded = text.clone();
    padded.extend([0; 3]);
    let marked = [b"\xef\xbb\xbf", &text[..]].concat();
    for (what, bytes) in [
        ("the length is 0", glb(0, &[json(&text), binary.clone()])),
        (
            "the length is too large",
            glb(1 << 30, &[json(&text), binary.clone()]),
        ),
        (
            "zeros after the text",
            glb(0, &[json(&padded), binary.clone()]),
        ),
        (
            "a byte-order mark",
            glb(0, &[json(&marked), binary.clone()]),
        ),
        (
            "a chunk between",
            glb(0, &[json(&text), other.clone(), binary.clone()]),
        ),
        (
            "a chunk before",
            glb(0, &[other.clone(), json(&text), binary.clone()]),
        ),
        (
            "bytes behind",
            glb(0, &[json(&text), binary.clone(), b"garbage".to_vec()]),
        ),
    ] {
        let scene = load(&bytes).unwrap_or_else(|e| panic!("{what}: {e}"));
        assert_eq!(scene.triangles.len(), 1, "{what}");
    }
    let cut = glb(0, &[json(&text), binary[..binary.len() - 4].to_vec()]);
    assert!(
        load(&cut)
            .unwrap_err()
            .to_string()
            .contains("instead of 36")
    );
    let none = glb(0, &[other, binary]);
    assert!(load(&none).unwrap_err().to_string().contains("no JSON"));
    assert_eq!(
        load(&[b"\xef\xbb\xbf", &gltf.to_gltf()[..]].concat())
            .unwrap()
            .triangles
            .len(),
        1
    );
}

#[test]
fn data_uris_as_tools_write_them() {
    let mut gltf = Gltf::triangle();
    let text: Value = serde_json::from_slice(&gltf.to_gltf()).unwrap();
    let uri = text["buffers"][0]["uri"].as_str().unwrap();
    let digits = uri.split_once(',').unwrap().1.to_owned();
    let broken_lines: String = digits
        .as_bytes()
        .chunks(7)
        .map(|line| format!("{}\r\n", String::from_utf8_lossy(line)))
        .collect();
    let percents: String = gltf
        .bytes
        .iter()
        .map(|byte| format!("%{byte:02X}"))
        .collect();
    gltf.json["buffers"] = json!([{"byteLength": gltf.bytes.len()}]);
    for uri in [
        format!("data:;base64,{digits}"),
        format!("DATA:application/octet-stream;BASE64,{digits}"),
        format!(
            "data:application/gltf-buffer;charset=x;base64,{}",
            digits.trim_end_matches('=')
        ),
        format!("data:application/octet-stream;base64,{broken_lines}"),
        format!(
            "data:;base64,{}",
            digits.replace('+', "-").replace('/', "_")
        ),
        format!("data:;base64,{}", digits.replace('=', "%3D")),
        format!("data:application/octet-stream,{percents}"),
    ] {
        gltf.json["buffers"][0]["uri"] = uri.clone().into();
        let bytes = serde_json::to_vec(&gltf.json).unwrap();
        let scene = load(&bytes).unwrap_or_else(|e| panic!("{uri}: {e}"));
        assert_eq!(scene.triangles.len(), 1);
    }
}

#[test]
fn names_with_the_separators_of_windows() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("buffers")).unwrap();
    let mut gltf = Gltf::triangle();
    std::fs::write(folder.path().join("buffers/a b.bin"), &gltf.bytes).unwrap();
    gltf.json["buffers"] = json!([{"byteLength": gltf.bytes.len(), "uri": "buffers\\a%20b.bin"}]);
    let path = folder.path().join("test.gltf");
    let bytes = |gltf: &Gltf| serde_json::to_vec(&gltf.json).unwrap();
    assert!(parse(&path, &bytes(&gltf), &LoadOptions::default()).is_ok());
    gltf.json["buffers"][0]["uri"] = "..\\secret.bin".into();
    let message = parse(&path, &bytes(&gltf), &LoadOptions::default())
        .unwrap_err()
        .to_string();
    assert!(message.contains("refuses to read"), "{message}");
    gltf.json["buffers"][0]["uri"] = "gone.bin".into();
    let message = parse(&path, &bytes(&gltf), &LoadOptions::default())
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("test.gltf: buffer 0: ") && message.contains("gone.bin"),
        "{message}"
    );
}

#[test]
fn what_shadows_do_not_need_may_be_required() {
    for name in [
        "KHR_materials_unlit",
        "KHR_materials_variants",
        "KHR_animation_pointer",
        "KHR_texture_basisu",
    ] {
        let mut gltf = Gltf::triangle();
        gltf.json["extensionsRequired"] = json!([name]);
        gltf.json["extensionsUsed"] = json!([name]);
        assert!(noted(&gltf.load().unwrap(), name), "{name}");
    }
}

/// A triangle of a material in this alpha mode, with an image.
fn surface(image: Value, material: Value) -> Gltf {
    let mut gltf = Gltf::new();
    gltf.push("images", image);
    gltf.push("textures", json!({"source": 0}));
    let index = textured(&mut gltf, 0, json!({}));
    for (key, value) in material.as_object().unwrap() {
        gltf.json["materials"][index][key] = value.clone();
    }
    add_textured_triangle(&mut gltf, index);
    gltf
}

#[test]
fn textures_that_cannot_be_read() {
    let picture = encode(2, 2, &[[9, 8, 7, 255]; 4], image::ImageFormat::WebP);
    let inline = |bytes: &[u8]| format!("data:;base64,{}", STANDARD.encode(bytes));
    let cut = inline(&picture[..picture.len() - 9]);
    for (image, what) in [
        (json!({"uri": "gone.png"}), "gone.png"),
        (
            json!({"uri": "https://example.org/wood.png"}),
            "example.org",
        ),
        (
            json!({"uri": "data:image/gif;base64,R0lGODlhAQABAAAAACw="}),
            "not in PNG, JPEG or WebP",
        ),
        (
            json!({"uri": inline(b"\xabKTX 20\xbb\r\n\x1a\n")}),
            "image 0: is in KTX2; `gltf-transform ktxdecompress`",
        ),
        (
            json!({"uri": inline(b"\0\0\0\x1cftypavif\0\0\0\0")}),
            "image 0: is in AVIF",
        ),
        (json!({"uri": cut}), "cannot be decoded"),
    ] {
        let scene = surface(image.clone(), json!({})).load().unwrap();
        assert!(
            noted(&scene, what) && noted(&scene, "flat colour"),
            "{:?}",
            scene.notes
        );
        let masked = surface(image, json!({"alphaMode": "MASK"}));
        let message = masked.error();
        assert!(
            message.contains(what) && message.contains("--allow-missing"),
            "{message}"
        );
        let options = LoadOptions {
            allow_missing: true,
            ..LoadOptions::default()
        };
        let scene = masked.load_with(&options).unwrap();
        assert_eq!((scene.opaque_count, scene.triangles.len()), (1, 1));
        assert!(noted(&scene, "--allow-missing"), "{:?}", scene.notes);
    }
    let scene = surface(json!({"uri": inline(&picture)}), json!({}))
        .load()
        .unwrap();
    assert_eq!(scene.textures.len(), 1, "{:?}", scene.notes);
}

#[test]
fn textures_whose_only_image_is_an_extensions() {
    let load = |texture: Value, mode| {
        let image = png(1, 1, &[[9, 8, 7, 0]]);
        let uri = format!("data:;base64,{}", STANDARD.encode(image));
        let mut gltf = surface(json!({"uri": uri}), json!({"alphaMode": mode}));
        gltf.json["textures"][0] = texture;
        gltf
    };
    let basis = json!({"KHR_texture_basisu": {"source": 0}});
    let alone = json!({"name": "wood", "extensions": basis});
    let advice = "texture 0 (\"wood\"): is in KTX2; `gltf-transform ktxdecompress`";
    let scene = load(alone.clone(), "OPAQUE").load().unwrap();
    assert!(noted(&scene, advice), "{:?}", scene.notes);
    let message = load(alone, "MASK").error();
    assert!(
        message.contains(advice) && message.contains("--allow-missing"),
        "{message}"
    );
    let scene = load(json!({"source": 0, "extensions": basis}), "MASK")
        .load()
        .unwrap();
    assert_eq!(scene.textures.len(), 1, "{:?}", scene.notes);
}

/// A row of two texels, out of a palette of as many colours.
fn palette_png(colors: [[u8; 3]; 2], alphas: [u8; 2]) -> Vec<u8> {
    let chunk = |kind: &[u8; 4], data: &[u8]| {
        let body = [&kind[..], data].concat();
        let checksum = crc32fast::hash(&body).to_be_bytes();
        [&(data.len() as u32).to_be_bytes(), &body[..], &checksum].concat()
    };
    // No filter, and the texels; stored, not deflated; with the checksum of zlib.
    let row = [0, 0, 1];
    let (low, high) = row.iter().fold((1, 0), |(low, high), &byte| {
        (low + u32::from(byte), high + low + u32::from(byte))
    });
    let stored = [0x78, 1, 1, 3, 0, !3, !0];
    let zlib = [&stored[..], &row, &(high << 16 | low).to_be_bytes()].concat();
    [
        b"\x89PNG\r\n\x1a\n".to_vec(),
        chunk(b"IHDR", &[0, 0, 0, 2, 0, 0, 0, 1, 8, 3, 0, 0, 0]),
        chunk(b"PLTE", colors.as_flattened()),
        chunk(b"tRNS", &alphas),
        chunk(b"IDAT", &zlib),
        chunk(b"IEND", &[]),
    ]
    .concat()
}

#[test]
fn textures_of_other_depths() {
    let texels = |picture: &[u8]| {
        let uri = format!("data:image/png;base64,{}", STANDARD.encode(picture));
        let scene = surface(json!({"uri": uri}), json!({"alphaMode": "MASK"}))
            .load()
            .unwrap();
        assert!(scene.materials[0].alpha_cutoff.is_some());
        scene.textures[0].rgba.clone()
    };
    let palette = palette_png([[200, 100, 50], [10, 20, 30]], [255, 3]);
    assert_eq!(texels(&palette), [200, 100, 50, 255, 10, 20, 30, 3]);
    let deep = vec![0xffff, 200 * 257 + 128, 50 * 257 - 128, 3 * 257];
    let deep = image::ImageBuffer::<image::Rgba<u16>, _>::from_raw(1, 1, deep).unwrap();
    let mut file = std::io::Cursor::new(Vec::new());
    deep.write_to(&mut file, image::ImageFormat::Png).unwrap();
    assert_eq!(texels(&file.into_inner()), [255, 200, 50, 3]);
}

#[test]
fn surfaces_that_blend() {
    let cutoff = |alphas: [u8; 2], factor: f32, blend| {
        let picture = png(2, 1, &alphas.map(|alpha| [9, 9, 9, alpha]));
        let mut gltf = Gltf::new();
        let texture = gltf.texture(&picture);
        let index = textured(&mut gltf, texture, json!({}));
        gltf.json["materials"][index]["alphaMode"] = "BLEND".into();
        gltf.json["materials"][index]["pbrMetallicRoughness"]["baseColorFactor"] =
            json!([1, 1, 1, factor]);
        add_textured_triangle(&mut gltf, index);
        let options = LoadOptions {
            blend,
            ..LoadOptions::default()
        };
        let scene = gltf.load_with(&options).unwrap();
        assert!(!scene.notes.is_empty());
        scene
            .materials
            .first()
            .map(|material| material.alpha_cutoff)
    };
    assert_eq!(cutoff([1, 255], 1.0, Blend::Opaque), Some(None));
    let least = cutoff([0, 255], 1.0, Blend::Opaque).unwrap().unwrap();
    assert!(0.0 < least && least < 1.0 / 255.0);
    assert_eq!(cutoff([0, 255], 0.0, Blend::Opaque), None);
    assert_eq!(cutoff([100, 255], 1.0, Blend::Mask), Some(Some(0.5)));
    assert_eq!(cutoff([200, 255], 1.0, Blend::Mask), Some(None));
    assert_eq!(cutoff([200, 255], 0.4, Blend::Mask), None);
    assert_eq!(cutoff([255, 255], 1.0, Blend::Ignore), None);
}
