//! Materials and textures of a well-formed glTF.

mod support;

use glam::{Vec2, Vec3};
use halfshade::scene::Wrap;
use halfshade::scene::gltf::{LoadOptions, load};
use serde_json::{Value, json};
use support::*;

#[test]
fn texture_coordinates_may_be_normalized_integers() {
    let u16s = [0u16, 65535, 13107, 0, 0, 0]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    for (component, bytes) in [(U8, vec![0, 255, 51, 0, 0, 0]), (U16, u16s)] {
        let mut gltf = Gltf::new();
        let texture = gltf.texture(&png(1, 1, &[[255; 4]]));
        let material = textured(&mut gltf, texture, json!({}));
        let texcoord = gltf.accessor(&bytes, component, "VEC2", 3);
        gltf.json["accessors"][texcoord]["normalized"] = true.into();
        let position = gltf.positions(&SQUARE[..3]);
        let primitive = json!({"attributes": {"TEXCOORD_0": texcoord}, "material": material});
        add_primitive(&mut gltf, position, primitive);
        assert_eq!(
            gltf.load().unwrap().texcoords,
            [Vec2::Y, Vec2::new(0.2, 0.0), Vec2::ZERO]
        );
        gltf.json["accessors"][texcoord]["normalized"] = false.into();
        assert!(gltf.error().contains("TEXCOORD"));
    }
}

#[test]
fn texture_transforms_are_baked_in() {
    let mut gltf = Gltf::new();
    let texture = gltf.texture(&png(1, 1, &[[255; 4]]));
    let transform = json!({
        "offset": [0.5, 0.25], "scale": [2.0, 3.0], "texCoord": 1,
        "rotation": std::f32::consts::FRAC_PI_2,
    });
    let info = json!({"texCoord": 0, "extensions": {"KHR_texture_transform": transform}});
    let material = textured(&mut gltf, texture, info);
    let unused = gltf.texcoords(&[[7.0, 7.0]; 3]);
    let texcoord = gltf.texcoords(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let position = gltf.positions(&SQUARE[..3]);
    let attributes = json!({"TEXCOORD_0": unused, "TEXCOORD_1": texcoord});
    add_primitive(
        &mut gltf,
        position,
        json!({"attributes": attributes, "material": material}),
    );
    // A quarter turn counter-clockwise, v pointing down: (1, 0) → (0, -1) and (0, 1) → (1, 0).
    let expected = [
        Vec2::new(0.5, 0.25),
        Vec2::new(0.5, -1.75),
        Vec2::new(3.5, 0.25),
    ];
    for (got, expected) in gltf.load().unwrap().texcoords.iter().zip(expected) {
        assert!(got.distance(expected) < 1e-6, "{got} instead of {expected}");
    }
}

#[test]
fn masked_triangles_come_last() {
    let mut gltf = Gltf::new();
    let texture = gltf.texture(&png(1, 2, &[[9, 8, 7, 0], [1, 2, 3, 255]]));
    let texcoord = gltf.texcoords(&[[0.0; 2]; 3]);
    let mut add = |x: f32, material: Value| {
        let material = gltf.push("materials", material);
        let position = gltf.positions(&[[x, 0.0, 0.0], [x, 1.0, 0.0], [x, 0.0, 1.0]]);
        let attributes = json!({"TEXCOORD_0": texcoord});
        add_primitive(
            &mut gltf,
            position,
            json!({"attributes": attributes, "material": material}),
        );
    };
    let factor = |alpha: f32| json!({"baseColorFactor": [0.5, 0.25, 0.125, alpha]});
    let with_texture = json!({"baseColorTexture": {"index": texture}});
    add(
        0.0,
        json!({"name": "leaf", "alphaMode": "MASK", "pbrMetallicRoughness": with_texture}),
    );
    add(
        1.0,
        json!({"alphaMode": "MASK", "alphaCutoff": 0.3, "pbrMetallicRoughness": factor(0.3)}),
    );
    add(
        2.0,
        json!({"alphaMode": "MASK", "pbrMetallicRoughness": factor(0.4)}),
    );
    add(3.0, json!({"alphaMode": "BLEND", "doubleSided": true}));
    let scene = gltf.load().unwrap();
    let x: Vec<_> = corners(&scene)
        .iter()
        .map(|triangle| triangle[0][0])
        .collect();
    assert_eq!(
        x,
        [1.0, 3.0, 0.0],
        "the second is opaque, the third invisible"
    );
    assert_eq!(scene.opaque_count, 2);
    let materials: Vec<_> = scene
        .triangle_materials
        .iter()
        .map(|&index| &scene.materials[index as usize])
        .collect();
    assert_eq!(materials[0].base_color.to_array(), [0.5, 0.25, 0.125, 0.3]);
    assert_eq!(
        (materials[0].alpha_cutoff, materials[0].double_sided),
        (None, false)
    );
    assert!(materials[1].double_sided);
    assert_eq!(
        (materials[2].name.as_str(), materials[2].alpha_cutoff),
        ("leaf", Some(0.5))
    );
    assert_eq!(materials[2].texture, Some(0));
    assert_eq!(scene.textures[0].rgba, [9, 8, 7, 0, 1, 2, 3, 255]);
    assert!(noted(&scene, "BLEND") && noted(&scene, "below its cutoff"));
}

#[test]
fn only_textures_of_visible_materials_are_read() {
    let mut gltf = Gltf::triangle();
    gltf.push("images", json!({"uri": "missing.png"}));
    gltf.push("textures", json!({"source": 0}));
    let used = textured(&mut gltf, 0, json!({}));
    assert!(gltf.load().unwrap().textures.is_empty());
    gltf.json["meshes"][0]["primitives"][0]["material"] = used.into();
    assert!(noted(&gltf.load().unwrap(), "missing.png"));
}

#[test]
fn images_come_from_files_views_and_data_uris() {
    let folder = tempfile::tempdir().unwrap();
    let texels = [[200, 100, 50, 255]; 64];
    let jpeg = encode(8, 8, &texels, image::ImageFormat::Jpeg);
    std::fs::write(folder.path().join("a b.jpg"), &jpeg).unwrap();
    let mut gltf = Gltf::new();
    gltf.push("images", json!({"uri": "./a%20b.jpg"}));
    let base64 = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg==";
    gltf.push(
        "images",
        json!({"uri": format!("data:image/png;base64,{base64}")}),
    );
    gltf.push(
        "samplers",
        json!({"magFilter": 9728, "wrapS": 33071, "wrapT": 33648}),
    );
    gltf.push("textures", json!({"source": 0}));
    gltf.push("textures", json!({"source": 1, "sampler": 0}));
    for texture in 0..2 {
        let material = textured(&mut gltf, texture, json!({}));
        add_textured_triangle(&mut gltf, material);
    }
    // The buffer is a file of its own too.
    std::fs::write(folder.path().join("data.bin"), &gltf.bytes).unwrap();
    gltf.json["buffers"][0]["uri"] = "data.bin".into();
    let path = folder.path().join("scene.gltf");
    std::fs::write(&path, serde_json::to_vec(&gltf.json).unwrap()).unwrap();
    let scene = load(&path, &LoadOptions::default()).unwrap();
    let [photo, dot] = &scene.textures[..] else {
        panic!("two textures")
    };
    assert_eq!((photo.width, photo.height, photo.linear), (8, 8, true));
    assert_eq!(photo.wrap, [Wrap::Repeat; 2]);
    assert!(photo.rgba[0].abs_diff(200) < 8 && photo.rgba[3] == 255);
    assert_eq!((dot.width, dot.height, dot.linear), (1, 1, false));
    assert_eq!(dot.wrap, [Wrap::Clamp, Wrap::Mirror]);
}

#[test]
fn vertices_have_colours() {
    let half = [0u16, 65535, 13107, 65535].repeat(3);
    let half: Vec<u8> = half.iter().flat_map(|share| share.to_le_bytes()).collect();
    let floats = bytes_of(&[0.25, 0.5, 7.0, -1.0, f32::NAN, 1.0, 0.0, 0.0, 0.0]);
    let mut gltf = Gltf::new();
    for colors in [
        None,
        Some((U16, "VEC4", half)),
        None,
        Some((F32, "VEC3", floats)),
    ] {
        let mut attributes = json!({});
        if let Some((component, kind, bytes)) = colors {
            let color = gltf.accessor(&bytes, component, kind, 3);
            gltf.json["accessors"][color]["normalized"] = (component == U16).into();
            attributes["COLOR_0"] = color.into();
        }
        let position = gltf.positions(&SQUARE[..3]);
        add_primitive(&mut gltf, position, json!({"attributes": attributes}));
    }
    let scene = gltf.load().unwrap();
    let first = [Vec3::ONE; 3];
    let second = [Vec3::new(0.0, 1.0, 0.2); 3];
    let last = [
        Vec3::new(0.25, 0.5, 1.0),
        Vec3::new(0.0, 0.0, 1.0),
        Vec3::ZERO,
    ];
    assert_eq!(scene.colors, [first, second, first, last].concat());
    assert!(noted(&scene, "the alpha of vertex colours is ignored"));
    // An accessor of fewer elements than there are vertices.
    let color = gltf.json["accessors"].as_array().unwrap().len() - 2;
    gltf.json["accessors"][color]["count"] = 2.into();
    assert!(gltf.error().contains("vertex 2 has no colour"));
    assert!(Gltf::triangle().load().unwrap().colors.is_empty());
}
