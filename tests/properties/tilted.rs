//! Surfaces that are tilted against the light: where they come nearer to it than a receiver further down, they are no
//! occluders themselves.

use std::sync::atomic::AtomicBool;

use halfshade::reference::{ReferenceOptions, trace};

use super::*;

/// A plate above a ground that is tilted by so many degrees, under a light straight above, in one view.
fn plate_above(degrees: f64, settings: Settings) -> Shot {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let (down, normal) = (DVec3::new(cos, -sin, 0.0), DVec3::new(sin, cos, 0.0));
    let on = |along: f64, aside: f64| down * along + DVec3::Z * aside;
    let square = |half: f64| {
        [(-half, -half), (-half, half), (half, half), (half, -half)].map(|(x, z)| on(x, z))
    };
    let scene = Triangles::new()
        .polygon(&square(3.0))
        .polygon(&square(0.4).map(|corner| corner + normal * 0.5));
    let light = rectangle_light(DVec3::new(0.0, 6.0, 0.0), DVec2::splat(0.7));
    let eye = camera(normal * 5.0 + down * 2.0, down * 0.7, 50.0);
    shot(scene.build(), eye, light, 64, settings)
}

/// A block whose front is to be looked at, under a light most of which is behind the front's plane, its centre included;
/// a board before the right half hides some of the rest.
fn block_under_a_cut_light(settings: Settings) -> Shot {
    let front = [(0.0, -1.0), (0.0, 1.0), (3.0, 1.0), (3.0, -1.0)];
    let top = [(-2.0, -1.0), (-2.0, 1.0), (0.0, 1.0), (0.0, -1.0)];
    let board = [(0.1, 0.0), (0.1, 1.0), (0.5, 1.0), (0.5, 0.0)];
    let scene = Triangles::new()
        .polygon(&front.map(|(y, z)| DVec3::new(0.0, y, z)))
        .polygon(&top.map(|(x, z)| DVec3::new(x, 3.0, z)))
        .polygon(&board.map(|(x, z)| DVec3::new(x, 3.5, z)));
    let light = rectangle_light(DVec3::new(-0.3, 6.0, 0.0), DVec2::splat(0.7));
    let eye = camera(DVec3::new(5.0, 1.0, 0.0), DVec3::new(0.0, 1.5, 0.0), 40.0);
    shot(scene.build(), eye, light, 64, settings)
}

/// Light below a surface's horizon does not count as hidden: the block hides nothing from its own front, in one view from
/// behind the front's plane as in four, of which two are before it. With the block as an occluder that of one view
/// would be 0.7; the noise of the rays is 0.001.
#[test]
fn a_block_does_not_hide_light_from_its_own_front() {
    with_gpu(|gpu| {
        for split in [1, 2] {
            let shot = block_under_a_cut_light(settings(256, split));
            let options = ReferenceOptions {
                samples: 1024,
                seed: 0,
            };
            let truth = trace(&shot, 0, options, &|_| {}, &AtomicBool::new(false)).expect("rays");
            let image = visibility(gpu, &shot);
            let cut = |pixel: &usize| (0.01..0.99).contains(&truth.facing.data[*pixel]);
            let (mut shaded, mut open, mut errors) = (0, 0, Vec::new());
            for pixel in (0..image.len()).filter(cut) {
                let wanted = truth.visibility.data[pixel];
                errors.push((image[pixel] - wanted).abs());
                open += u32::from(wanted == 1.0);
                shaded += u32::from(wanted < 0.95);
            }
            let mean = errors.iter().sum::<f32>() / errors.len() as f32;
            println!("{split} a side: {open} open, {shaded} shaded, mean error {mean:.4}");
            assert!(open > 100 && shaded > 100);
            assert!(mean < 0.003, "{split} a side: {mean}");
        }
    });
}

/// Its edges are all that is off: within a texel of the map, of which the penumbra has some thirty across. Against the
/// receiver's depth alone the means would be 0.047, 0.10 and 0.13.
#[test]
fn a_tilted_ground_does_not_hide_what_stands_before_it() {
    with_gpu(|gpu| {
        for degrees in [30.0, 60.0, 75.0] {
            let shot = plate_above(degrees, settings(256, 1));
            let options = ReferenceOptions {
                samples: 256,
                seed: 0,
            };
            let truth = trace(&shot, 0, options, &|_| {}, &AtomicBool::new(false)).expect("rays");
            let image = visibility(gpu, &shot);
            let in_shadow = |pixel: &usize| {
                truth.facing.data[*pixel] == 1.0 && truth.visibility.data[*pixel] < 1.0
            };
            let errors: Vec<f32> = (0..image.len())
                .filter(in_shadow)
                .map(|pixel| (image[pixel] - truth.visibility.data[pixel]).abs())
                .filter(|error| error.is_finite())
                .collect();
            let mean = errors.iter().sum::<f32>() / errors.len() as f32;
            println!(
                "{degrees} degrees: mean error {mean:.4} of {} pixels",
                errors.len()
            );
            assert!(errors.len() > 100, "{} pixels in shadow", errors.len());
            assert!(mean < 0.02, "{degrees} degrees: {mean}");
        }
    });
}
