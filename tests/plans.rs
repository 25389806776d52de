//! Plans as text, against `tests/plans/*.txt`. `UPDATE_GOLDENS=1 cargo test --test plans` rewrites them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DVec3, Vec3, Vec4};
use halfshade::gpu::Limits;
use halfshade::plan::{Outputs, plan, suited_exposure};
use halfshade::scene::{AreaLight, Camera, LightShape, Material, Scene};
use halfshade::shot::{Overrides, Shot};
use halfshade::technique::{Evaluate, Settings, Technique};

/// Of no device, so that the plans depend on none.
const LIMITS: Limits = Limits {
    image_side: 16384,
    image_layers: 2048,
    image_bytes: 1 << 31,
    buffer_bytes: 1 << 27,
    memory_bytes: 1 << 33,
    allowed_bytes: u64::MAX,
    storage_alignment: 16,
    adds_floats: true,
    is_cpu: true,
    loop_turns: 60000,
};

const EVERYTHING: Outputs = Outputs { picture: true };

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn scene(name: &str) -> Shot {
    let path = root().join(format!("scenes/{name}.json"));
    Shot::load(&path, &Overrides::default()).expect("a committed scene")
}

fn with(mut shot: Shot, change: impl FnOnce(&mut Settings)) -> Shot {
    change(&mut shot.settings);
    shot
}

/// A square floor, seen from above, and a square light.
fn floor(light_height: f64, light_v: DVec3) -> Shot {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let scene = Scene {
        positions: corners.map(|(x, z)| DVec3::new(x, 0.0, z)).to_vec(),
        triangles: vec![[0, 2, 1], [0, 3, 2]],
        triangle_materials: vec![0, 0],
        opaque_count: 2,
        materials: vec![Material {
            name: "floor".into(),
            base_color: Vec4::ONE,
            texture: None,
            alpha_cutoff: None,
            double_sided: true,
        }],
        ..Scene::default()
    };
    Shot {
        scene: Arc::new(scene),
        camera: Camera {
            name: "camera".into(),
            eye: DVec3::new(0.0, 3.0, 3.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            vfov_deg: 45.0,
            aspect: None,
            ortho_height: None,
            near: None,
        },
        width: 64,
        height: 48,
        lights: vec![AreaLight {
            name: "light 0".into(),
            center: DVec3::new(0.0, light_height, 0.0),
            shape: LightShape::Rect {
                u: DVec3::new(0.25, 0.0, 0.0),
                v: light_v,
            },
            color: Vec3::ONE,
            intensity: None,
            beam: None,
        }],
        settings: Settings::default(),
        budget_map: None,
        physical: false,
        notes: Vec::new(),
    }
}

/// Compares with `tests/plans/{name}.txt`, or writes it.
fn check(name: &str, shot: &Shot, outputs: Outputs, retained: bool) {
    let mut planned = plan(shot, outputs, &LIMITS).expect("a shot that can be planned");
    if retained {
        planned = planned.retaining();
    }
    let text = planned.to_string();
    let file = root().join(format!("tests/plans/{name}.txt"));
    if std::env::var_os("UPDATE_GOLDENS").is_some() {
        write(&file, &text);
    }
    let golden = std::fs::read_to_string(&file).unwrap_or_default();
    assert!(
        text == golden,
        "the plan differs from {}; if it should, run UPDATE_GOLDENS=1 cargo test --test plans\n{text}",
        file.display()
    );
}

fn write(file: &Path, text: &str) {
    std::fs::write(file, text).expect("the goldens can be written");
}

#[test]
fn every_scene_at_the_defaults() {
    for name in [
        "colonnade",
        "grid",
        "hexagon",
        "knot",
        "plate",
        "staircase",
        "tree",
    ] {
        check(name, &scene(name), EVERYTHING, false);
    }
}

#[test]
fn visibility_alone_needs_no_shading() {
    let outputs = Outputs { picture: false };
    check("tree-visibility-only", &scene("tree"), outputs, false);
}

#[test]
fn a_light_without_extent_casts_a_hard_shadow() {
    let mut shot = scene("plate");
    let nothing = DVec3::ZERO;
    shot.lights[0].shape = LightShape::Rect {
        u: nothing,
        v: nothing,
    };
    check("plate-point", &shot, EVERYTHING, false);
}

#[test]
fn settings_change_what_runs() {
    let plate = || scene("plate");
    let one_view = with(plate(), |settings| settings.split = 1);
    check("plate-split-1", &one_view, EVERYTHING, false);
    let pixels = with(plate(), |settings| settings.packet = (1, 1));
    check("plate-packet-1x1", &pixels, EVERYTHING, false);
}

/// White at the camera's target has radiance 1 from a sphere in nit, from a sun in lux, and from both together; lights in no unit are shown as
/// they are.
#[test]
fn lights_in_physical_units_are_exposed_for() {
    let mut shot = scene("plate");
    let light = |shape, intensity| AreaLight {
        name: String::new(),
        center: DVec3::new(1.0, 5.0, 2.0),
        shape,
        color: Vec3::ONE,
        intensity: Some(intensity),
        beam: None,
    };
    let sphere = light(LightShape::Sphere { radius: 0.25 }, 1000.0);
    let direction = DVec3::new(0.3, -1.0, 0.0);
    let angle_deg = 0.533;
    let sun = light(
        LightShape::Sun {
            direction,
            angle_deg,
        },
        1e5,
    );
    let way = sphere.center - shot.camera.target;
    let of_sphere = 1000.0 * 0.25 * 0.25 / way.length_squared();
    let of_sun = 1e5 / std::f64::consts::PI;
    for (lights, radiance) in [
        (vec![sphere.clone()], of_sphere),
        (vec![sun.clone()], of_sun),
        (vec![sphere, sun], of_sphere + of_sun),
    ] {
        shot.lights = lights;
        shot.physical = false;
        assert_eq!(suited_exposure(&shot), 1.0);
        shot.physical = true;
        // The sun's disc is flat: tan² and not sin² of its angle; and f32.
        let shown = f64::from(suited_exposure(&shot)) * radiance;
        assert!((shown - 1.0).abs() < 3e-5, "{shown}");
    }
}

/// What a view alone is too small for is done for several at once, of several faces and of sub-lights that a rim cuts or does not; on a
/// CPU view by view, and where layers are peeled.
#[test]
fn a_gpu_looks_at_several_views_at_once() {
    let gpu = Limits {
        is_cpu: false,
        loop_turns: Limits::ENDLESS_LOOPS,
        ..LIMITS
    };
    let planned = |name, limits: &Limits| {
        let plan = plan(&scene(name), EVERYTHING, limits).expect("a plan");
        (
            plan.views_at_once,
            plan.steps().count(),
            plan.memory_bytes(),
        )
    };
    for (name, views, steps) in [("knot", 6, 43), ("colonnade", 8, 67)] {
        let (one, all_steps, one_bytes) = planned(name, &LIMITS);
        let (several, fewer_steps, bytes) = planned(name, &gpu);
        assert_eq!((one, several), (1, views), "{name}");
        assert!(
            all_steps > 4 * fewer_steps && fewer_steps <= steps,
            "{name}: {fewer_steps} steps"
        );
        assert!(bytes <= one_bytes + (64 << 20), "{name}: {bytes} bytes");
    }
    let peeled = with(scene("plate"), |settings| {
        settings.technique = Technique::DepthPeeling;
        settings.layers = 4;
        settings.views_at_once = Some(4);
    });
    let plan = plan(&peeled, EVERYTHING, &gpu).expect("a plan");
    assert_eq!(plan.views_at_once, 1);
    assert!(
        plan.notes
            .iter()
            .any(|note| note.contains("--views-at-once"))
    );
}

/// Local packets leave nothing over where a driver lets loops run.
#[test]
fn what_drivers_leave_over_is_planned_for_such_drivers_alone() {
    let shot = scene("plate");
    let endless = Limits {
        loop_turns: Limits::ENDLESS_LOOPS,
        ..LIMITS
    };
    let passes = |limits: &Limits| -> Vec<&'static str> {
        let plan = plan(&shot, EVERYTHING, limits).expect("a plan");
        plan.passes().into_iter().map(|(name, _)| name).collect()
    };
    let pixels = |limits| passes(limits).contains(&"pixel_visibility");
    assert!(pixels(&LIMITS) && !pixels(&endless));
}

#[test]
fn a_budget_plans_coarser_levels_and_two_of_each_visibility() {
    let limited = with(scene("plate"), |settings| {
        settings.split = 1;
        settings.budget = Some(12);
        settings.budget_falloff = 0.5;
    });
    check("plate-budget", &limited, EVERYTHING, false);
}

#[test]
fn pixels_that_are_not_evaluated_are_joined_after_each_view() {
    let quarter = with(scene("plate"), |settings| {
        settings.split = 1;
        settings.evaluate = Evaluate::Quarter;
    });
    check("plate-quarter", &quarter, EVERYTHING, false);
    let budgeted = with(quarter, |settings| settings.budget = Some(12));
    let all = with(budgeted.clone(), |settings| {
        settings.evaluate = Evaluate::Full;
    });
    let text = |shot: &Shot| plan(shot, EVERYTHING, &LIMITS).expect("a plan").to_string();
    assert_eq!(text(&budgeted), text(&all));
}

#[test]
fn samples_of_a_pixel_are_planned_for_pictures_alone() {
    let four = with(scene("plate"), |settings| {
        settings.split = 1;
        settings.multisample = 4;
    });
    check("plate-multisample", &four, EVERYTHING, false);
    let planned = plan(&four, Outputs { picture: false }, &LIMITS).expect("a plan");
    assert!(
        planned
            .omissions
            .iter()
            .any(|left| left.what == "samples of a pixel")
    );
    let one = with(four, |settings| settings.multisample = 1);
    let single = plan(&one, Outputs { picture: false }, &LIMITS).expect("a plan");
    assert_eq!(planned.memory_bytes(), single.memory_bytes());
}

#[test]
fn every_technique_at_its_usual_settings() {
    for &technique in Technique::ALL {
        let usual = Settings::usual(technique);
        let shot = with(scene("plate"), |settings| *settings = usual);
        check(&format!("plate-{technique}"), &shot, EVERYTHING, false);
    }
}

#[test]
fn a_map_is_kept_while_nothing_changes() {
    // Only a light with a single view keeps one.
    let shot = with(scene("knot"), |settings| settings.split = 1);
    check("knot-retained", &shot, EVERYTHING, true);
}

#[test]
fn a_floor_alone_has_no_shadow() {
    let shot = floor(2.0, DVec3::new(0.0, 0.0, 0.25));
    check("floor", &shot, EVERYTHING, false);
}

#[test]
fn a_floor_lit_from_behind_is_dark() {
    // Below the floor, and it shines up.
    let shot = floor(-2.0, DVec3::new(0.0, 0.0, -0.25));
    check("floor-from-behind", &shot, EVERYTHING, false);
}

#[test]
fn limits_are_told_with_the_knob_to_turn() {
    let limits = Limits {
        image_side: 256,
        ..LIMITS
    };
    let error = plan(&scene("plate"), EVERYTHING, &limits).unwrap_err();
    assert!(error.to_string().contains("--map"), "{error}");
    for (limits, source) in [
        (
            Limits {
                memory_bytes: 1 << 20,
                ..LIMITS
            },
            "the device has 1.0 MiB; choose a smaller --map or --size, or --mssm-bits 16",
        ),
        (
            Limits {
                allowed_bytes: 1 << 20,
                ..LIMITS
            },
            "--max-memory allows 1.0 MiB; choose a smaller --map or --size, or --mssm-bits 16, or raise --max-memory",
        ),
    ] {
        let error = plan(&scene("plate"), EVERYTHING, &limits).unwrap_err();
        assert!(error.to_string().contains(source), "{error}");
    }
    // Exactly what it takes is enough, and a byte less is not.
    let peak = plan(&scene("plate"), EVERYTHING, &LIMITS)
        .unwrap()
        .peak_bytes();
    for (allowed_bytes, fits) in [(peak, true), (peak - 1, false)] {
        let limits = Limits {
            allowed_bytes,
            ..LIMITS
        };
        assert_eq!(plan(&scene("plate"), EVERYTHING, &limits).is_ok(), fits);
    }
}
