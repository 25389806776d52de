//! What a well-formed glTF means.

mod support;

use std::path::Path;

use glam::{DVec3, Vec2};
use halfshade::scene::LightShape;
use halfshade::scene::gltf::{LoadOptions, parse};
use halfshade::shot::{Overrides, Shot};
use serde_json::json;
use support::*;

const A: [f64; 3] = [0.0, 0.0, 0.0];
const B: [f64; 3] = [1.0, 0.0, 0.0];
const C: [f64; 3] = [0.0, 1.0, 0.0];
const D: [f64; 3] = [1.0, 1.0, 0.0];

#[test]
fn plain_triangles_from_gltf_and_glb() {
    let gltf = Gltf::triangle();
    let scene = gltf.load().unwrap();
    assert_eq!(corners(&scene), [[A, B, C]]);
    assert_eq!((scene.opaque_count, scene.has_masked()), (1, false));
    assert_eq!(
        scene.texcoords.len() + scene.textures.len() + scene.notes.len(),
        0
    );
    let path = std::path::Path::new("test.glb");
    let glb = parse(path, &gltf.to_glb(), &LoadOptions::default()).unwrap();
    assert_eq!(corners(&glb), [[A, B, C]]);
}

#[test]
fn strips_and_fans_keep_their_winding() {
    let strip = square(json!({"mode": 5})).load().unwrap();
    assert_eq!(corners(&strip), [[A, B, C], [B, D, C]]);
    let fan = square(json!({"mode": 6})).load().unwrap();
    assert_eq!(corners(&fan), [[B, C, A], [C, D, A]]);
}

#[test]
fn indices_of_every_width() {
    let order = [0u8, 1, 3];
    for (component, bytes) in [
        (U8, order.to_vec()),
        (
            U16,
            order
                .iter()
                .flat_map(|&i| u16::from(i).to_le_bytes())
                .collect(),
        ),
        (
            U32,
            order
                .iter()
                .flat_map(|&i| u32::from(i).to_le_bytes())
                .collect(),
        ),
    ] {
        let mut gltf = Gltf::new();
        let position = gltf.positions(&SQUARE);
        let indices = gltf.accessor(&bytes, component, "SCALAR", 3);
        add_primitive(&mut gltf, position, json!({"indices": indices}));
        let scene = gltf.load().unwrap();
        assert_eq!(corners(&scene), [[A, B, D]]);
        assert_eq!(
            scene.positions.len(),
            3,
            "vertices that no triangle names are left out"
        );
    }
}

#[test]
fn sparse_accessors_with_and_without_a_base() {
    for with_base in [true, false] {
        let mut gltf = Gltf::new();
        let base = gltf.positions(&[[0.0; 3], [9.0; 3], [0.0, 1.0, 0.0]]);
        let indices = gltf.view(&[1, 2]);
        let values = gltf.view(&bytes_of(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0]));
        let accessor = &mut gltf.json["accessors"][base];
        accessor["sparse"] = json!({
            "count": 2, "indices": {"bufferView": indices, "componentType": U8},
            "values": {"bufferView": values},
        });
        if !with_base {
            accessor.as_object_mut().unwrap().remove("bufferView");
        }
        add_primitive(&mut gltf, base, json!({}));
        assert_eq!(corners(&gltf.load().unwrap()), [[A, B, C]]);
    }
}

#[test]
fn interleaved_buffers() {
    let mut gltf = Gltf::new();
    let texture = gltf.texture(&png(1, 1, &[[255; 4]]));
    let rows = [
        0., 0., 0., 0.25, 0.5, 1., 0., 0., 1., 0., 0., 1., 0., 0., 1.,
    ];
    let view = gltf.view(&bytes_of(&rows));
    gltf.json["bufferViews"][view]["byteStride"] = 20.into();
    let mut accessor = |kind: &str, offset: usize| {
        gltf.push(
            "accessors",
            json!({"bufferView": view, "byteOffset": offset, "componentType": F32, "type": kind, "count": 3}),
        )
    };
    let (position, texcoord) = (accessor("VEC3", 0), accessor("VEC2", 12));
    let material = textured(&mut gltf, texture, json!({}));
    let primitive = json!({"attributes": {"TEXCOORD_0": texcoord}, "material": material});
    add_primitive(&mut gltf, position, primitive);
    let scene = gltf.load().unwrap();
    assert_eq!(corners(&scene), [[A, B, C]]);
    assert_eq!(scene.texcoords, [Vec2::new(0.25, 0.5), Vec2::X, Vec2::Y]);
}

#[test]
fn nodes_place_and_instance_meshes() {
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"][0] = json!({"children": [1, 2], "translation": [10.0, 0.0, 0.0]});
    gltf.push(
        "nodes",
        json!({"mesh": 0, "scale": [2.0, 2.0, 2.0], "rotation": [0.0, 0.0, 1.0, 0.0]}),
    );
    let matrix = [
        1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 5., 1.,
    ];
    gltf.push("nodes", json!({"mesh": 0, "matrix": matrix}));
    let scene = gltf.load().unwrap();
    let instances = [
        [[10.0, 0.0, 0.0], [8.0, 0.0, 0.0], [10.0, -2.0, 0.0]],
        [[10.0, 0.0, 5.0], [11.0, 0.0, 5.0], [10.0, 1.0, 5.0]],
    ];
    assert_eq!(corners(&scene), instances);
}

/// Who is whose parent, and how nodes are called, is nobody's business but the file's.
#[test]
fn nodes_may_be_renamed_and_given_other_parents() {
    let (translation, rotation, scale) =
        ([10.0, -3.0, 0.7], [0.1, -0.7, 0.1, 0.7], [2.0, 0.3, 5.0]);
    let mut whole = Gltf::triangle();
    whole.json["nodes"][0] = json!({
        "mesh": 0, "translation": translation, "rotation": rotation, "scale": scale,
    });
    let expected = whole.load().unwrap();

    let mut renamed = whole.clone();
    renamed.json["nodes"][0]["name"] = json!("another");
    renamed.json["meshes"][0]["name"] = json!("one more");
    assert_eq!(corners(&renamed.load().unwrap()), corners(&expected));

    // Below two nodes that do nothing, and taken apart into three.
    let mut below = whole.clone();
    let below_it = below.push("nodes", json!({"children": [0]}));
    let root = below.push("nodes", json!({"name": "root", "children": [below_it]}));
    below.json["scenes"][0]["nodes"] = json!([root]);
    assert_eq!(corners(&below.load().unwrap()), corners(&expected));

    let mut apart = whole.clone();
    apart.json["nodes"] = json!([
        {"translation": translation, "children": [1]},
        {"rotation": rotation, "children": [2]},
        {"mesh": 0, "scale": scale},
    ]);
    assert_eq!(corners(&apart.load().unwrap()), corners(&expected));
}

#[test]
fn negative_determinants_flip_the_winding() {
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"][0]["scale"] = json!([1.0, 1.0, -1.0]);
    assert_eq!(corners(&gltf.load().unwrap()), [[A, C, B]]);
    gltf.json["nodes"][0]["scale"] = json!([1.0, -1.0, -1.0]);
    assert_eq!(corners(&gltf.load().unwrap())[0][1], B);
}

#[test]
fn distant_scenes_keep_their_precision() {
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"][0]["translation"] = json!([1e9 + 0.125, 0.0, 0.0]);
    let scene = gltf.load().unwrap();
    assert_eq!(corners(&scene)[0][0][0], 1e9 + 0.125);
}

#[test]
fn one_of_several_scenes() {
    let mut gltf = Gltf::triangle();
    gltf.push("nodes", json!({"mesh": 0, "translation": [5.0, 0.0, 0.0]}));
    gltf.push("scenes", json!({"nodes": [1]}));
    let with = |scene| LoadOptions {
        scene,
        ..LoadOptions::default()
    };
    let x = |gltf: &Gltf, scene| corners(&gltf.load_with(&with(scene)).unwrap())[0][0][0];
    assert_eq!(
        (x(&gltf, None), x(&gltf, Some(0)), x(&gltf, Some(1))),
        (0.0, 0.0, 5.0)
    );
    gltf.json["scene"] = 1.into();
    assert_eq!(x(&gltf, None), 5.0);
    assert!(
        gltf.load_with(&with(Some(2)))
            .unwrap_err()
            .to_string()
            .contains("no scene 2")
    );
}

#[test]
fn what_is_no_surface_is_left_out_and_noted() {
    for mode in [0, 1, 2, 3] {
        let scene = square(json!({"mode": mode})).load().unwrap();
        assert!(scene.triangles.is_empty() && noted(&scene, "points and lines"));
    }
    let mut gltf = Gltf::new();
    let position = gltf.positions(&[
        [0.0; 3],
        [1.0; 3],
        [2.0; 3],
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
    ]);
    add_primitive(&mut gltf, position, json!({}));
    assert_eq!(
        corners(&gltf.load().unwrap()),
        [[A, B, C]],
        "no area, no triangle"
    );
}

#[test]
fn cameras_of_both_kinds() {
    let mut gltf = Gltf::triangle();
    gltf.push(
        "cameras",
        json!({"type": "perspective", "perspective": {"yfov": 1.0, "aspectRatio": 1.5, "znear": 0.1}}),
    );
    let lens = json!({"xmag": 3.0, "ymag": 2.0, "zfar": 9.0, "znear": 0.5});
    gltf.push(
        "cameras",
        json!({"type": "orthographic", "orthographic": lens}),
    );
    // A quarter turn about y: −Z becomes −X.
    let quarter = std::f64::consts::FRAC_1_SQRT_2;
    gltf.node(json!({
        "camera": 0, "name": "eye", "translation": [5.0, 0.5, 0.0], "scale": [3.0, 3.0, 3.0],
        "rotation": [0.0, quarter, 0.0, quarter],
    }));
    gltf.node(json!({"camera": 1, "scale": [9.0, 9.0, 9.0]}));
    gltf.push("cameras", json!({"type": "orthographic"}));
    gltf.node(json!({"camera": 2}));
    let scene = gltf.load().unwrap();
    let [camera, parallel] = &scene.cameras[..] else {
        panic!("two cameras")
    };
    assert_eq!(
        (parallel.ortho_height, parallel.aspect, parallel.near),
        (Some(4.0), Some(1.5), Some(0.5))
    );
    assert_eq!(
        (camera.name.as_str(), camera.eye),
        ("eye", DVec3::new(5.0, 0.5, 0.0))
    );
    assert!(camera.target.distance(DVec3::new(0.5, 0.5, 0.0)) < 1e-9);
    assert!(camera.up.distance(DVec3::Y) < 1e-9);
    assert!((camera.vfov_deg - 1f64.to_degrees()).abs() < 1e-9);
    assert_eq!(camera.aspect, Some(1.5));
    assert_eq!(camera.ortho_height, None);
    assert!(noted(
        &scene,
        "neither a perspective nor an orthographic one"
    ));
}

#[test]
fn area_lights() {
    let mut gltf = Gltf::triangle();
    gltf.json["extensionsUsed"] = json!(["EXT_lights_area"]);
    gltf.json["extensionsRequired"] = json!(["EXT_lights_area"]);
    gltf.json["extensions"]["EXT_lights_area"]["lights"] = json!([
        {"type": "rect", "name": "panel", "size": 2.0, "rect": {"aspect": 3.0}, "intensity": 7.5},
        {"type": "disk", "size": 4.0, "color": [1.0, 0.5, 0.25]},
        {"type": "sphere"},
    ]);
    let light = |index| json!({"EXT_lights_area": {"light": index}});
    gltf.node(
        json!({"extensions": light(0), "translation": [0.0, 0.0, 9.0], "scale": [1.0, -2.0, 1.0]}),
    );
    gltf.node(json!({"extensions": light(1), "rotation": [1.0, 0.0, 0.0, 0.0]}));
    gltf.node(json!({"extensions": light(2)}));
    let scene = gltf.load().unwrap();
    let [panel, disk] = &scene.lights[..] else {
        panic!("two lights")
    };
    assert_eq!((panel.name.as_str(), panel.intensity), ("panel", Some(7.5)));
    assert_eq!(panel.center, DVec3::new(0.0, 0.0, 9.0));
    assert_eq!(panel.half_size(), (6.0, 2.0));
    assert_eq!(panel.frame().2, DVec3::NEG_Z);
    assert_eq!(
        disk.shape,
        LightShape::Disc {
            normal: DVec3::Z,
            radius: 2.0
        }
    );
    assert_eq!(
        (disk.color.to_array(), disk.intensity),
        ([1.0, 0.5, 0.25], None)
    );
    assert!(noted(&scene, "neither rect nor disk"));
    gltf.node(json!({"extensions": light(3)}));
    assert!(gltf.error().contains("area light 3, which does not exist"));
}

#[test]
fn punctual_lights_need_a_radius() {
    let mut gltf = Gltf::triangle();
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = json!([
        {"type": "point", "intensity": 50.0}, {"type": "spot", "spot": {"innerConeAngle": 0.25}},
        {"type": "directional"},
    ]);
    for light in 0..3 {
        let light = json!({"KHR_lights_punctual": {"light": light}});
        gltf.node(json!({"extensions": light, "translation": [0.5, 0.5, 4.0]}));
    }
    let scene = gltf.load().unwrap();
    let sun = |angle_deg| LightShape::Sun {
        direction: DVec3::NEG_Z,
        angle_deg,
    };
    assert_eq!((scene.lights.len(), scene.lights[0].shape), (1, sun(0.533)));
    assert!(noted(&scene, "pass --radius"));
    gltf.json["nodes"][1]["translation"] = json!([0.5, 4.5, 0.0]);
    let options = LoadOptions {
        punctual_radius: Some(0.25),
        sun_angle_deg: Some(2.0),
        ..LoadOptions::default()
    };
    let scene = gltf.load_with(&options).unwrap();
    let shapes: Vec<_> = scene.lights.iter().map(|light| light.shape).collect();
    let radius = 0.25;
    let sphere = LightShape::Sphere { radius };
    assert_eq!(shapes, [sphere, sphere, sun(2.0)]);
    let beams: Vec<_> = scene.lights.iter().map(|light| light.beam).collect();
    let beam = beams[1].expect("a spot light has a cone");
    assert_eq!(
        (beams[0], beam.direction, beams[2]),
        (None, DVec3::NEG_Z, None)
    );
    let angles = [beam.inner_deg - 0.25f64.to_degrees(), beam.outer_deg - 45.0];
    assert!(angles.iter().all(|off| off.abs() < 1e-5), "{beam:?}");
    // Candela spread over the disc that is seen; lux; 1 where the file says nothing.
    let radiance = |candela: f64| Some((candela / (std::f64::consts::PI * radius * radius)) as f32);
    let intensities: Vec<_> = scene.lights.iter().map(|light| light.intensity).collect();
    assert_eq!(intensities, [radiance(50.0), radiance(1.0), Some(1.0)]);
    let options = LoadOptions {
        punctual_radius: Some(0.0),
        ..LoadOptions::default()
    };
    let lights = gltf.load_with(&options).unwrap().lights;
    assert!(lights[0].is_point_without_direction() && lights[1].is_point_without_direction());
    assert!(lights[0].beam.is_none() && lights[1].beam.is_some());
}

#[test]
fn the_files_that_a_shot_is_read_from_are_known() {
    let folder = tempfile::tempdir().unwrap();
    let mut gltf = Gltf::triangle();
    gltf.json["buffers"][0]["uri"] = "own.bin".into();
    gltf.push(
        "buffers",
        json!({"uri": "data:;base64,AAAA", "byteLength": 3}),
    );
    // What nothing reads may not be there.
    gltf.push("images", json!({"uri": "bumps%20.png"}));
    gltf.push("images", json!({"uri": "https://example.org/far.png"}));
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    write("sub/scene.gltf", gltf.json.to_string().as_bytes());
    write("sub/own.bin", &gltf.bytes);
    let shot = json!({
        "scene": "sub/scene.gltf",
        "camera": {"eye": [0, 1, 5], "target": [0, 0, 0], "vfov_deg": 62},
        "lights": [{"type": "disc", "center": [0, 3, 0], "normal": [0, -1, 0], "radius": 1, "texture": "glow.png"}],
    });
    write("shot.json", shot.to_string().as_bytes());
    let shot = Shot::load(&folder.path().join("shot.json"), &Overrides::default()).unwrap();
    let mut files = shot.scene.files.clone();
    files.sort();
    let expected = [
        "glow.png",
        "shot.json",
        "sub/bumps .png",
        "sub/own.bin",
        "sub/scene.gltf",
    ];
    assert_eq!(files, expected.map(|name| folder.path().join(name)));
    // What was in memory was read from nowhere.
    let bytes = Gltf::triangle().to_glb();
    let scene = parse(Path::new("a.glb"), &bytes, &Default::default());
    assert!(scene.unwrap().files.is_empty());
}

/// Three nodes with a triangle each: a, below it b, and beside them one without a name.
fn family() -> Gltf {
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"][0]["name"] = "a".into();
    let below = gltf.push("nodes", json!({"mesh": 0, "name": "b"}));
    gltf.json["nodes"][0]["children"] = json!([below]);
    gltf.node(json!({"mesh": 0}));
    gltf
}

#[test]
fn nodes_cast_by_name_with_all_below_them() {
    let casts = |names: &[&str]| {
        let casters = Some(names.iter().map(|name| name.to_string()).collect());
        let options = LoadOptions {
            casters,
            ..LoadOptions::default()
        };
        family().load_with(&options).map(|scene| scene.casts)
    };
    assert!(!family().load().unwrap().tells_casters());
    assert_eq!(casts(&[]).unwrap(), [false, false, false]);
    assert_eq!(casts(&["a"]).unwrap(), [true, true, false]);
    assert_eq!(casts(&["b"]).unwrap(), [false, true, false]);
    let message = casts(&["c", "b", ""]).unwrap_err().to_string();
    assert!(message.contains("no node of the name \"c\""), "{message}");
    assert!(!message.contains("\"b\""), "{message}");
}
