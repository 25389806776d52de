//! Occluders that nearly touch the light: where one is nearer to a sub-light than it is wide, points take its place.

use super::world::{error, traced};
use super::*;

/// [visibility] Mean error that is asked for.
const ERROR: f64 = 0.02;

/// A lamp above a floor, with what stands before it.
fn lamp(before: Triangles, light: AreaLight, settings: Settings) -> Shot {
    let scene = before.floor([-2.0, 2.0], [-2.0, 2.0]).build();
    let eye = camera(DVec3::new(0.3, 1.2, 3.0), DVec3::ZERO, 50.0);
    shot(scene, eye, light, 48, settings)
}

/// Upright slats, `gap` below the light, turned by an angle.
fn louvre(gap: f64, degrees: f64) -> Triangles {
    let turn = DQuat::from_rotation_y(degrees.to_radians());
    let corner = |x: f64, y: f64, z: f64| LIGHT + turn * DVec3::new(x, y - gap, z);
    (0..6).fold(Triangles::new(), |slats, i| {
        let x = 0.2 * f64::from(i) - 0.5;
        slats.polygon(&[
            corner(x, 0.0, -0.5),
            corner(x, 0.0, 0.5),
            corner(x, -0.07, 0.5),
            corner(x, -0.07, -0.5),
        ])
    })
}

fn cover(gap: f64, half: f64) -> Triangles {
    let (x, z) = ([LIGHT.x - 0.6, LIGHT.x + half], [-0.7, 0.6]);
    Triangles::new().plate(LIGHT.y - gap, &rectangle(x, z))
}

fn check(gpu: &Arc<Gpu>, name: &str, before: Triangles, light: AreaLight, map: u32) {
    let settings = Settings {
        map,
        ..Settings::default()
    };
    let shot = lamp(before, light, settings);
    let plan = planned(gpu, &shot);
    assert!(plan.near_count() > 0, "{name}: nothing is near");
    assert!(plan.to_string().contains("contours of"), "{name}");
    let found = error(gpu, &shot, &traced(&shot, 1024));
    assert!(found <= ERROR, "{name}: {found}");
}

#[test]
fn slats_before_a_lamp_are_seen_from_all_of_it() {
    with_gpu(|gpu| {
        for (gap, degrees) in [
            (1e-6, 0.0),
            (0.01, 0.0),
            (0.05, 0.0),
            (0.15, 0.0),
            (0.02, 40.0),
            (0.02, 90.0),
        ] {
            let name = format!("{gap} below, turned by {degrees}");
            let square = rectangle_light(LIGHT, DVec2::splat(0.5));
            check(gpu, &name, louvre(gap, degrees), square, 256);
        }
        check(
            gpu,
            "a disc",
            louvre(0.02, 20.0),
            disc_light(LIGHT, 0.5),
            256,
        );
    });
}

#[test]
fn covers_hide_what_they_cover_however_near_they_are() {
    with_gpu(|gpu| {
        for power in 2..=6 {
            let gap = 10f64.powi(-power);
            for half in [0.6, 0.07] {
                let square = rectangle_light(LIGHT, DVec2::splat(0.5));
                let name = format!("{gap:e} below, up to {half}");
                check(gpu, &name, cover(gap, half), square, 128);
            }
        }
    });
}

/// A panel in the light's plane, be it off by the rounding of f32, is the lamp's own.
#[test]
fn what_touches_the_light_casts_no_shadow() {
    with_gpu(|gpu| {
        for off in [0.0, 1e-7, -1e-7, -1e-3] {
            let light = rectangle_light(LIGHT, DVec2::splat(0.5));
            let shot = lamp(cover(off, 0.6), light, Settings::default());
            let dark = visibility(gpu, &shot);
            let dark = dark.iter().filter(|&&value| value < 1.0).count();
            assert_eq!(dark, 0, "{off:e} before the light");
            let noted = planned(gpu, &shot).notes.join(" ");
            assert_eq!(noted.contains("lamp's own"), off > 0.0, "{noted}");
        }
    });
}

/// Only sub-lights that an occluder is near to give way, and weights add up to the whole light.
#[test]
fn a_rod_is_near_to_a_part_of_the_light() {
    let rod = |x: f64| {
        let z = LIGHT.z;
        let corner = |x, y| DVec3::new(x, y, z);
        Triangles::new().polygon(&[
            corner(x, LIGHT.y - 0.01),
            corner(x + 0.02, LIGHT.y - 0.01),
            corner(x + 0.02, LIGHT.y - 0.5),
            corner(x, LIGHT.y - 0.5),
        ])
    };
    with_gpu(|gpu| {
        let light = rectangle_light(LIGHT, DVec2::splat(0.5));
        let shot = lamp(rod(LIGHT.x + 0.1), light, Settings::default());
        let near = planned(gpu, &shot).near_count();
        assert!((1..8).contains(&near), "{near} sub-lights");
        let found = error(gpu, &shot, &traced(&shot, 1024));
        assert!(found <= 0.5 * ERROR, "{found}");
        let mut plain = shot.clone();
        plain.settings.technique = Technique::Pcss;
        assert!(planned(gpu, &plain).notes[0].contains("pcss errs"));
    });
}
