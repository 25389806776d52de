//! Shot files: what they mean and what is refused.

mod support;

use glam::DVec3;
use halfshade::scene::{AreaLight, Beam, LightShape};
use halfshade::shot::{Overrides, Shot};
use halfshade::technique::{Leaf, Mapping, Settings, Technique};
use serde_json::{Value, json};
use support::*;
use tempfile::TempDir;

/// A folder with a scene of one triangle.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    write(&folder, "scene.glb", &Gltf::triangle().to_glb());
    folder
}

fn write(folder: &TempDir, name: &str, bytes: &[u8]) {
    std::fs::write(folder.path().join(name), bytes).unwrap();
}

fn example() -> Value {
    json!({
        "scene": "scene.glb",
        "camera": {"eye": [0, 1, 5], "target": [0, 0, 0], "up": [0, 1, 0], "vfov_deg": 62,
            "width": 320, "height": 200},
        "lights": [
            {"type": "rect", "center": [0, 5.9, 0], "u": [3.2, 0, 0], "v": [0, 0, 0.9]},
            {"type": "disc", "center": [0, 3, 0], "normal": [0, -2, 0], "radius": 0.5},
        ],
    })
}

fn load(json: &Value) -> halfshade::Result<Shot> {
    let folder = folder();
    write(&folder, "shot.json", json.to_string().as_bytes());
    Shot::load(&folder.path().join("shot.json"), &Overrides::default())
}

/// The message for the example after a change.
fn error(change: impl Fn(&mut Value)) -> String {
    let mut json = example();
    change(&mut json);
    load(&json)
        .expect_err("this shot must be refused")
        .to_string()
}

#[test]
fn the_example_means_what_it_says() {
    let shot = load(&example()).unwrap();
    assert_eq!(
        (shot.width, shot.height, shot.scene.triangles.len()),
        (320, 200, 1)
    );
    assert_eq!(
        (shot.camera.eye, shot.camera.vfov_deg),
        (DVec3::new(0.0, 1.0, 5.0), 62.0)
    );
    assert_eq!(shot.settings, Settings::default());
    let [rect, disc] = &shot.lights[..] else {
        panic!("two lights")
    };
    let (u, v, normal) = rect.frame();
    for (got, expected) in [(u, DVec3::X), (v, DVec3::Z), (normal, DVec3::NEG_Y)] {
        assert!(got.distance(expected) < 1e-12);
    }
    assert_eq!((rect.half_size(), rect.is_point()), ((3.2, 0.9), false));
    assert!((rect.area() - 4.0 * 3.2 * 0.9).abs() < 1e-12);
    assert_eq!(
        (disc.frame().2, disc.half_size()),
        (DVec3::NEG_Y, (0.5, 0.5))
    );
    assert!((disc.area() - std::f64::consts::PI * 0.25).abs() < 1e-12);
    assert_eq!((disc.intensity, disc.color), (None, glam::Vec3::ONE));
    assert!(shot.notes.is_empty());
}

#[test]
fn frames_are_orthonormal() {
    for normal in [
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        -DVec3::Z,
        DVec3::new(1.0, -2.0, 3.0),
    ] {
        let light = light(LightShape::Disc {
            normal,
            radius: 1.0,
        });
        let (u, v, n) = light.frame();
        assert!(n.distance(normal.normalize()) < 1e-12);
        assert!(u.cross(v).distance(n) < 1e-12 && u.dot(v).abs() < 1e-12);
    }
    let hard = light(LightShape::Rect {
        u: DVec3::ZERO,
        v: DVec3::ZERO,
    });
    assert!(hard.is_point() && hard.area() == 0.0 && hard.frame().2.is_normalized());
}

fn light(shape: LightShape) -> AreaLight {
    let (center, color) = (DVec3::ZERO, glam::Vec3::ONE);
    AreaLight {
        name: String::new(),
        center,
        shape,
        color,
        intensity: None,
        beam: None,
    }
}

#[test]
fn a_single_light_and_optional_values() {
    let mut json = example();
    json["light"] = json["lights"][1].take();
    json.as_object_mut().unwrap().remove("lights");
    json["light"]["color"] = json!([1, 0.5, 0]);
    json["light"]["intensity"] = 3.into();
    json["camera"].as_object_mut().unwrap().remove("up");
    let shot = load(&json).unwrap();
    assert_eq!(shot.lights[0].color.to_array(), [1.0, 0.5, 0.0]);
    assert_eq!(shot.lights[0].intensity, Some(3.0));
    assert_eq!(shot.camera.up, DVec3::Y);
    assert!(error(|json| json["light"] = json["lights"][0].clone()).contains("give one of them"));
}

#[test]
fn casters_are_named() {
    let mut json = example();
    json["casters"] = json!([]);
    let shot = load(&json).unwrap();
    assert!(shot.notes.is_empty() && !shot.scene.casts(0));
    assert!(load(&example()).unwrap().scene.casts(0));
    assert!(error(|json| json["casters"] = json!(["horse"])).contains("\"horse\""));
    assert!(error(|json| json["casters"] = "horse".into()).contains("is not a shot file"));
}

#[test]
fn unknown_keys_are_noted() {
    let mut json = example();
    json["name"] = "courtyard".into();
    json["what"] = json!({"deep": [1, 2]});
    json["camera"]["lens"] = 35.into();
    json["lights"][1]["samples"] = 64.into();
    json["lights"][0]["texture"] = "window.png".into();
    let notes = load(&json).unwrap().notes;
    // A name and what it is are for people.
    assert_eq!(notes.len(), 3, "{notes:?}");
    for key in [
        "\"camera.lens\"",
        "\"lights.1.samples\"",
        "Light 0: textures",
    ] {
        assert!(
            notes.iter().any(|note| note.contains(key)),
            "{key} in {notes:?}"
        );
    }
}

#[test]
fn nonsense_is_refused() {
    assert!(error(|json| json["camera"]["target"] = json!([0, 1, 5])).contains("same point"));
    assert!(error(|json| json["camera"]["up"] = json!([0, 1, 5])).contains("parallel"));
    assert!(error(|json| json["camera"]["up"] = json!([0, 0, 0])).contains("no length"));
    assert!(error(|json| json["camera"]["eye"] = json!([0, 1e300, 5])).contains("beyond"));
    for angle in [0, 180, -5] {
        assert!(error(|json| json["camera"]["vfov_deg"] = angle.into()).contains("field of view"));
    }
    for size in [0, 32769] {
        assert!(error(|json| json["camera"]["width"] = size.into()).contains("pixels wide"));
    }
    assert!(error(|json| json["camera"]["ortho_height"] = 2.into()).contains("either"));
    assert!(error(|json| json["camera"]["vfov_deg"] = Value::Null).contains("either"));
    let parallel = |height: f64| {
        error(|json| {
            json["camera"]["vfov_deg"] = Value::Null;
            json["camera"]["ortho_height"] = height.into();
        })
    };
    assert!(parallel(0.0).contains("ortho_height must be more than 0"));
    assert!(parallel(-1.0).contains("ortho_height must be more than 0"));
    assert!(error(|json| json["lights"][0]["u"] = json!([3, 0, 0.01])).contains("perpendicular"));
    assert!(error(|json| json["lights"][0]["u"] = json!([0, 0, 0])).contains("a line"));
    assert!(error(|json| json["lights"][0]["u"] = Value::Null).contains("lacks \"u\""));
    assert!(error(|json| json["lights"][1]["radius"] = (-1).into()).contains("radius"));
    assert!(error(|json| json["lights"][1]["normal"] = json!([0, 0, 0])).contains("no length"));
    assert!(error(|json| json["lights"][1]["color"] = json!([0, -1, 0])).contains("color"));
    assert!(error(|json| json["lights"][1]["intensity"] = 1e39.into()).contains("intensity"));
    assert!(error(|json| json["lights"][1]["type"] = "cube".into()).contains("cube"));
    assert!(error(|json| json["lights"] = json!([])).contains("brings no area light"));
    assert!(error(|json| json["scene"] = "none.glb".into()).contains("none.glb"));
    assert!(error(|json| json["scene"] = 3.into()).contains("is not a shot file"));
    let folder = folder();
    for text in [
        "",
        "{",
        "[]",
        "{} x",
        r#"{"scene": NaN}"#,
        r#"{"scene": "scene.glb"} x"#,
    ] {
        write(&folder, "shot.json", text.as_bytes());
        let error =
            Shot::load(&folder.path().join("shot.json"), &Overrides::default()).unwrap_err();
        assert!(error.to_string().contains("is not a shot file"), "{error}");
    }
}

#[test]
fn numbers_that_json_cannot_hold_are_refused_too() {
    let good = load(&example()).unwrap();
    let changes: [fn(&mut Shot); 6] = [
        |shot| shot.camera.eye.x = f64::NAN,
        |shot| shot.camera.up.y = f64::INFINITY,
        |shot| shot.camera.vfov_deg = f64::NAN,
        |shot| shot.lights[0].center.z = f64::NAN,
        |shot| shot.lights[0].intensity = Some(f32::NAN),
        |shot| {
            shot.lights[1].shape = LightShape::Disc {
                normal: DVec3::Y,
                radius: f64::NAN,
            }
        },
    ];
    good.validate().unwrap();
    for change in changes {
        let mut shot = good.clone();
        change(&mut shot);
        assert!(shot.validate().is_err());
    }
}

#[test]
fn lights_without_extent_are_hard() {
    let mut json = example();
    json["lights"] = json!([
        {"type": "disc", "center": [0, 3, 0], "radius": 0},
        {"type": "rect", "center": [0, 3, 0], "u": [0, 0, 0], "v": [0, 0, 0]},
    ]);
    let lights = load(&json).unwrap().lights;
    assert!(lights.iter().all(AreaLight::is_point));
    assert!(lights.iter().all(AreaLight::is_point_without_direction));
    json["lights"][0]["normal"] = json!([0, -2, 0]);
    let lights = load(&json).unwrap().lights;
    assert!(lights[0].is_point() && !lights[0].is_point_without_direction());
}

#[test]
fn suns_and_spheres() {
    let mut json = example();
    json["lights"] = json!([
        {"type": "sun", "direction": [0, -2, 0]},
        {"type": "sphere", "center": [0, 3, 0], "radius": 0.5},
    ]);
    let lights = load(&json).unwrap().lights;
    let direction = DVec3::new(0.0, -2.0, 0.0);
    let shape = LightShape::Sun {
        direction,
        angle_deg: 0.533,
    };
    assert_eq!(lights[0].shape, shape);
    assert_eq!(lights[1].shape, LightShape::Sphere { radius: 0.5 });
    let refused = |index: usize, key: &str, value: serde_json::Value| {
        let mut json = json.clone();
        json["lights"][index][key] = value;
        load(&json).unwrap_err().to_string()
    };
    assert!(refused(0, "direction", json!([0, 0, 0])).contains("direction"));
    assert!(refused(0, "angle_deg", json!(180)).contains("less than 180"));
    assert!(refused(1, "radius", json!(-1)).contains("radius"));
    assert!(refused(1, "center", json!(null)).contains("center"));
    json["lights"] = json!([{"type": "sun"}]);
    assert!(load(&json).unwrap_err().to_string().contains("direction"));
}

#[test]
fn polygons() {
    let mut json = example();
    // Counter-clockwise from below.
    let corners = json!([[0, 3, 0], [2, 3, 0], [2, 3, 1], [0, 3, 1]]);
    json["lights"] = json!([{"type": "polygon", "corners": corners}]);
    let light = &load(&json).unwrap().lights[0];
    let (_, _, normal) = light.frame();
    assert!(light.center.distance(DVec3::new(1.0, 3.0, 0.5)) < 1e-14);
    assert!(normal.distance(DVec3::NEG_Y) < 1e-14 && (light.area() - 2.0).abs() < 1e-14);
    let refused = |corners: serde_json::Value| {
        let mut json = json.clone();
        json["lights"][0]["corners"] = corners;
        load(&json).unwrap_err().to_string()
    };
    assert!(refused(json!(null)).contains("light 0 lacks \"corners\""));
    assert!(
        refused(json!([[0, 3, 0], [2, 3, 0]]))
            .contains("light 0: a polygon has 3 to 16 corners, not 2")
    );
    assert!(refused(json!([[0, 3, 0], [1e19, 3, 0], [2, 3, 1]])).contains("corner 1"));
    json["lights"][0]["cone_deg"] = json!([10, 20]);
    assert!(
        load(&json)
            .unwrap_err()
            .to_string()
            .contains("a cone is for discs and spheres")
    );
}

#[test]
fn cones_of_light() {
    let mut json = example();
    json["lights"] = json!([
        {"type": "disc", "center": [0, 3, 0], "normal": [0, -2, 0], "radius": 0.5, "cone_deg": [10, 30]},
        {"type": "sphere", "center": [0, 3, 0], "radius": 0.5, "direction": [1, 0, 0], "cone_deg": [0, 90]},
        {"type": "sphere", "center": [0, 3, 0], "radius": 0.5},
    ]);
    let lights = load(&json).unwrap().lights;
    let beam = |direction, inner_deg, outer_deg| {
        Some(Beam {
            direction,
            inner_deg,
            outer_deg,
        })
    };
    let beams: Vec<_> = lights.iter().map(|light| light.beam).collect();
    let down = DVec3::new(0.0, -2.0, 0.0);
    assert_eq!(
        beams,
        [beam(down, 10.0, 30.0), beam(DVec3::X, 0.0, 90.0), None]
    );
    let refused = |light: serde_json::Value| {
        let mut json = json.clone();
        json["lights"] = json!([light]);
        load(&json).unwrap_err().to_string()
    };
    for angles in [
        json!([30, 10]),
        json!([0, 0]),
        json!([-1, 10]),
        json!([0, 181]),
    ] {
        let mut light = json["lights"][0].clone();
        light["cone_deg"] = angles;
        assert!(refused(light).contains("angles of its cone"));
    }
    let sun = json!({"type": "sun", "direction": [0, -1, 0], "cone_deg": [10, 30]});
    assert!(refused(sun).contains("a cone is for discs and spheres"));
}

#[test]
fn empty_scenes_are_refused() {
    let folder = folder();
    write(&folder, "scene.glb", &Gltf::new().to_glb());
    write(&folder, "shot.json", example().to_string().as_bytes());
    let error = Shot::load(&folder.path().join("shot.json"), &Overrides::default()).unwrap_err();
    assert!(error.to_string().contains("holds no triangles"));
}

/// A glTF that brings two cameras and a point light.
fn complete_gltf() -> Gltf {
    let mut gltf = Gltf::triangle();
    for aspect in [1.5, 0.5] {
        let lens = json!({"yfov": 1.0, "znear": 0.1, "aspectRatio": aspect});
        let camera = gltf.push(
            "cameras",
            json!({"type": "perspective", "perspective": lens}),
        );
        gltf.node(json!({"camera": camera, "translation": [0, 0, 5]}));
    }
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = json!([{"type": "point"}]);
    let light = json!({"KHR_lights_punctual": {"light": 0}});
    gltf.node(json!({"extensions": light, "translation": [0, 4, 0]}));
    gltf
}

#[test]
fn gltf_files_bring_their_own_camera_and_light() {
    let folder = folder();
    let gltf = complete_gltf();
    write(&folder, "all.gltf", &gltf.to_gltf());
    write(&folder, "glb-without-extension", &gltf.to_glb());
    write(&folder, "gltf-without-extension", &gltf.to_gltf());
    let load = |name: &str, overrides: &Overrides| Shot::load(&folder.path().join(name), overrides);
    let mut overrides = Overrides {
        radius: Some(0.5),
        ..Overrides::default()
    };
    for name in [
        "all.gltf",
        "glb-without-extension",
        "gltf-without-extension",
    ] {
        let shot = load(name, &overrides).unwrap();
        assert_eq!((shot.width, shot.height, shot.lights.len()), (768, 512, 1));
        assert_eq!(shot.lights[0].half_size(), (0.5, 0.5));
    }
    overrides.camera_index = Some(1);
    assert_eq!(load("all.gltf", &overrides).unwrap().width, 256);
    overrides.size = Some((64, 32));
    let shot = load("all.gltf", &overrides).unwrap();
    assert_eq!((shot.width, shot.height), (64, 32));
    overrides.camera_index = Some(2);
    assert!(
        load("all.gltf", &overrides)
            .unwrap_err()
            .to_string()
            .contains("no camera 2")
    );
    let message = load("all.gltf", &Overrides::default())
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("--radius") && message.contains("write a shot file"),
        "{message}"
    );
    let message = load("scene.glb", &Overrides::default())
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("no camera") && message.contains("write a shot file"),
        "{message}"
    );
    overrides = Overrides {
        radius: Some(-1.0),
        ..Overrides::default()
    };
    assert!(
        load("all.gltf", &overrides)
            .unwrap_err()
            .to_string()
            .contains("radius")
    );
    overrides = Overrides {
        scene_index: Some(4),
        ..Overrides::default()
    };
    assert!(
        load("all.gltf", &overrides)
            .unwrap_err()
            .to_string()
            .contains("no scene 4")
    );
}

#[test]
fn a_shot_file_takes_what_it_lacks_from_its_scene() {
    let folder = folder();
    write(&folder, "scene.glb", &complete_gltf().to_glb());
    write(&folder, "shot.json", br#"{"scene": "scene.glb"}"#);
    let overrides = Overrides {
        radius: Some(0.5),
        ..Overrides::default()
    };
    let shot = Shot::load(&folder.path().join("shot.json"), &overrides).unwrap();
    assert_eq!((shot.width, shot.lights.len()), (768, 1));
    assert!(Shot::load(&folder.path().join("absent.json"), &overrides).is_err());
}

#[test]
fn settings_have_ranges() {
    let default = Settings::default();
    default.validate().unwrap();
    type Change = fn(&mut Settings);
    let changes: [(&str, Change); 8] = [
        ("packet", |settings| settings.packet = (0, 4)),
        ("packet", |settings| settings.packet = (4, 9)),
        ("split", |settings| settings.split = 0),
        ("split", |settings| settings.split = 17),
        ("16 to 8192", |settings| settings.map = 15),
        ("16 to 8192", |settings| settings.map = 8193),
        ("bias", |settings| settings.bias = Some(-0.1)),
        ("bias", |settings| settings.bias = Some(f32::NAN)),
    ];
    for (word, change) in changes {
        let mut settings = default.clone();
        change(&mut settings);
        assert!(settings.validate().unwrap_err().to_string().contains(word));
    }
}

#[test]
fn names_are_the_same_everywhere() {
    fn check<T>(all: &[T])
    where
        T: std::str::FromStr<Err = halfshade::Error>
            + ToString
            + serde::Serialize
            + PartialEq
            + Copy,
    {
        for &value in all {
            assert_eq!(serde_json::to_value(value).unwrap(), value.to_string());
            assert!(value.to_string().parse::<T>().unwrap() == value);
        }
        let error = "nonsense".parse::<T>().err().unwrap().to_string();
        assert!(
            all.iter().all(|value| error.contains(&value.to_string())),
            "{error}"
        );
    }
    check(Leaf::ALL);
    check(Mapping::ALL);
    check(Technique::ALL);
    assert_eq!(Technique::PacketContour.to_string(), "packet-contour");
}

#[test]
fn a_budget_map_is_an_image_of_shares() {
    let mut json = example();
    json["budget_map"] = "maps/shares.png".into();
    let folder = folder();
    std::fs::create_dir(folder.path().join("maps")).unwrap();
    write(&folder, "shot.json", json.to_string().as_bytes());
    let texels = [[255; 4], [0, 0, 0, 255], [51, 51, 51, 255]];
    write(&folder, "maps/shares.png", &png(3, 1, &texels));
    let file = folder.path().join("shot.json");
    let shares = |shot: Shot| shot.budget_map.unwrap().data.clone();
    let shot = Shot::load(&file, &Overrides::default()).unwrap();
    assert!(
        shot.scene
            .files
            .contains(&folder.path().join("maps/shares.png"))
    );
    assert_eq!(shares(shot), [1.0, 0.0, 0.2]);
    // The caller's goes before the file's.
    write(&folder, "other.png", &png(1, 1, &[[255; 4]]));
    let other = |name: &str| Overrides {
        budget_map: Some(folder.path().join(name)),
        ..Overrides::default()
    };
    assert_eq!(
        shares(Shot::load(&file, &other("other.png")).unwrap()),
        [1.0]
    );
    for (name, reason) in [
        ("shot.json", "is not an image of budgets"),
        ("none.png", "none.png"),
    ] {
        let error = Shot::load(&file, &other(name)).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
}
