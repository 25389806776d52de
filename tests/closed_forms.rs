//! Shadows whose exact form is known: a half-plane and a square over a floor, under rectangles and discs.
//!
//! A shadow map knows an edge to within half a texel along each axis, so the engine's shadow must lie
//! between those of the occluder shrunk and grown by some texels. All bounds are in texels of the fitted
//! map, measured where the occluder is.

#[path = "support/closed_form.rs"]
mod closed_form;
#[path = "support/gpu.rs"]
mod support;

use std::sync::Arc;

use closed_form::{HalfPlane, Occluder, disc_visibility, rectangle_visibility};
use glam::{DVec2, DVec3};
use halfshade::gpu::Gpu;
use halfshade::scene::AreaLight;
use halfshade::technique::{Pattern, Settings, Technique};
use support::{Image, Triangles, camera, disc_light, rectangle_light, render, shot, with_gpu};

const LIGHT: DVec3 = DVec3::new(0.1, 3.0, -0.05);
const HALF: DVec2 = DVec2::new(0.75, 0.5);
const RADIUS: f64 = 0.6;
/// [scene units]
const HEIGHT: f64 = 1.5;
/// [texel] The most by which an edge may be off.
const TEXELS_MAX: f64 = 1.5;
/// [visibility] Rounding of the sum of some hundred segments, each of the order of 1.
const ROUNDING: f64 = 1e-5;
/// [visibility] For parts of a disc: linear interpolation in a table of 1024 steps adds (8/1024)² / 8 times
/// the second derivative of the swept area, which is of the order of 1, and kinks at the rim's ends.
const ROUNDING_DISC: f64 = 1e-4;

/// One occluder over a floor, seen from below it.
struct Case {
    occluder: Occluder,
    light: AreaLight,
    /// The exact visibility from a point.
    exact: fn(DVec3, &Occluder) -> f64,
    rounding: f64,
}

impl Case {
    fn rectangle(occluder: Occluder) -> Self {
        Self {
            occluder,
            light: rectangle_light(LIGHT, HALF),
            exact: |from, occluder| rectangle_visibility(from, LIGHT, HALF, occluder),
            rounding: ROUNDING,
        }
    }

    fn disc(occluder: Occluder) -> Self {
        Self {
            occluder,
            light: disc_light(LIGHT, RADIUS),
            exact: |from, occluder| disc_visibility(from, LIGHT, RADIUS, occluder),
            rounding: ROUNDING_DISC,
        }
    }

    fn measure(&self, gpu: &Arc<Gpu>, map: u32, split: u32) -> Measured {
        self.measure_with(
            gpu,
            Settings {
                map,
                split,
                ..Settings::default()
            },
        )
    }

    fn measure_with(&self, gpu: &Arc<Gpu>, settings: Settings) -> Measured {
        let corners = match self.occluder.sides[..] {
            [side] => side.corners(6.0).to_vec(),
            _ => self.occluder.corners(),
        };
        let scene = Triangles::new()
            .floor([-2.5, 2.5], [-2.5, 2.5])
            .plate(HEIGHT, &corners)
            .build();
        let eye = DVec3::new(-3.5, 1.4, 0.4);
        let camera = camera(eye, DVec3::new(0.0, 0.0, 0.1), 42.0);
        let image = render(gpu, &shot(scene, camera, self.light.clone(), 96, settings));
        self.judge(&image)
    }

    fn judge(&self, image: &Image) -> Measured {
        let texel = image
            .fits
            .iter()
            .flat_map(|fit| fit.focal.map(|focal| (LIGHT.y - HEIGHT) / f64::from(focal)))
            .fold(0.0, f64::max);
        let (mut texels, mut squares, mut penumbra) = (0.0f64, 0.0, 0);
        for (&value, position) in image.visibility.iter().zip(&image.positions) {
            let [x, y, z, surface] = position.map(f64::from);
            // The occluder's underside is no business of the light's.
            if surface == 0.0 || y > 1e-3 {
                continue;
            }
            let point = DVec3::new(x, y, z);
            let exact = |shift: f64| (self.exact)(point, &self.occluder.grown(shift * texel));
            let value = f64::from(value);
            let within = |shift: f64| {
                exact(shift) - self.rounding <= value && value <= exact(-shift) + self.rounding
            };
            while !within(texels) {
                texels += 1.0 / 16.0;
                assert!(
                    texels < 16.0,
                    "visibility {value} at {point}, exactly {}",
                    exact(0.0)
                );
            }
            if (1e-6..1.0 - 1e-6).contains(&exact(0.0)) {
                squares += (value - exact(0.0)).powi(2);
                penumbra += 1;
            }
        }
        assert!(penumbra > 400, "only {penumbra} pixels in the penumbra");
        Measured {
            texels,
            rms: (squares / f64::from(penumbra)).sqrt(),
        }
    }
}

/// How far an image is from the exact one.
struct Measured {
    /// [texel] Rounded up to sixteenths.
    texels: f64,
    /// Over penumbra pixels.
    rms: f64,
}

fn half_plane(degrees: f64) -> Occluder {
    Occluder::half_plane(HEIGHT, HalfPlane::new(DVec2::new(0.05, 0.02), degrees))
}

fn square(degrees: f64) -> Occluder {
    Occluder::square(HEIGHT, DVec2::new(0.1, -0.05), 0.45, degrees)
}

/// Every map is fitted to the occluder, so an edge along an axis falls between two columns of samples,
/// exactly where the contour is put.
fn check(case: &Case, gpu: &Arc<Gpu>, split: u32, bound: f64) {
    let measured = case.measure(gpu, 256, split);
    println!(
        "split {split}: {} texels, rms {:.2e}",
        measured.texels, measured.rms
    );
    assert!(
        measured.texels <= bound,
        "split {split}: {} texels off",
        measured.texels
    );
}

#[test]
fn half_plane_under_a_rectangle() {
    with_gpu(|gpu| {
        for split in [1, 2] {
            check(&Case::rectangle(half_plane(0.0)), gpu, split, 0.0625);
            for degrees in [20.0, 45.0, 110.0] {
                check(
                    &Case::rectangle(half_plane(degrees)),
                    gpu,
                    split,
                    TEXELS_MAX,
                );
            }
        }
    });
}

#[test]
fn square_under_a_rectangle() {
    with_gpu(|gpu| {
        for split in [1, 2] {
            check(&Case::rectangle(square(0.0)), gpu, split, 0.0625);
            check(&Case::rectangle(square(30.0)), gpu, split, TEXELS_MAX);
        }
    });
}

#[test]
fn half_plane_under_a_disc() {
    with_gpu(|gpu| {
        for split in [1, 4] {
            check(&Case::disc(half_plane(0.0)), gpu, split, 0.0625);
            for degrees in [30.0, 200.0] {
                check(&Case::disc(half_plane(degrees)), gpu, split, TEXELS_MAX);
            }
        }
    });
}

/// The error of an edge's place is a share of a texel, so it is of first order in the texel at least: twice, four and
/// eight times the map have a half, a quarter and an eighth of the error. A contour of midpoints lies now on one side
/// of a slanting edge and now on the other; how much of that cancels differs from map to map, for which half as much is
/// allowed on top. (The third map may err less than the fourth where it happens to cancel nearly all.)
#[test]
fn the_error_shrinks_with_the_texel() {
    with_gpu(|gpu| {
        for (case, split) in [
            (Case::rectangle(half_plane(20.0)), 1),
            (Case::rectangle(square(30.0)), 1),
            (Case::disc(half_plane(30.0)), 4),
        ] {
            let errors = [128, 256, 512, 1024].map(|map| {
                let measured = case.measure(gpu, map, split);
                assert!(
                    measured.texels <= TEXELS_MAX,
                    "map {map}: {} texels",
                    measured.texels
                );
                measured.rms
            });
            println!("rms {errors:?}");
            for (error, finer) in errors.iter().zip([1.0, 2.0, 4.0, 8.0]).skip(1) {
                assert!(
                    *error <= 1.5 * errors[0] / finer,
                    "no first order: {errors:?}"
                );
            }
        }
    });
}

/// An occluder parallel to the light is what micropatches are made for: each texel of it is exact, and the whole is too
/// large by less than a texel on each side.
#[test]
fn square_by_micropatches() {
    with_gpu(|gpu| {
        for technique in [Technique::Micropatch, Technique::MicropatchHierarchical] {
            for (gap_filling, light) in [(true, 0), (false, 0), (true, 1)] {
                let settings = Settings {
                    gap_filling,
                    map: 256,
                    ..Settings::usual(technique)
                };
                // Some thousand patches are summed, where a contour has some hundred edges.
                let mut case = match light {
                    0 => Case::rectangle(square(30.0)),
                    _ => Case::disc(half_plane(30.0)),
                };
                case.rounding = case.rounding.max(1e-4);
                let measured = case.measure_with(gpu, settings);
                println!("{technique}: {} texels", measured.texels);
                assert!(measured.texels <= TEXELS_MAX, "{} texels", measured.texels);
            }
        }
    });
}

/// The share of covered samples may be off by those of a stratum's row along each edge that crosses the light.
#[test]
fn square_by_bitmasks() {
    with_gpu(|gpu| {
        for (light_samples, pattern) in [
            (8, Pattern::Regular),
            (16, Pattern::Regular),
            (16, Pattern::Jittered),
        ] {
            let settings = Settings {
                light_samples,
                pattern,
                map: 256,
                ..Settings::usual(Technique::Bitmask)
            };
            let mut case = Case::rectangle(square(30.0));
            case.rounding = 1.0 / f64::from(light_samples);
            let measured = case.measure_with(gpu, settings);
            println!("{light_samples}: {} texels", measured.texels);
            assert!(measured.texels <= TEXELS_MAX, "{} texels", measured.texels);
        }
    });
}

/// The filter of an occluder parallel to the light is a box that the mean blocker depth makes just right: what is left
/// is the error of 1024 samples, a few times 1/√1024 at the worst of thousands of pixels.
#[test]
fn half_plane_by_percentage_closer_soft_shadows() {
    with_gpu(|gpu| {
        let settings = Settings {
            map: 256,
            blocker_samples: 1024,
            filter_samples: 1024,
            ..Settings::usual(Technique::Pcss)
        };
        let mut case = Case::rectangle(half_plane(20.0));
        case.rounding = 2.0 / 32.0;
        let measured = case.measure_with(gpu, settings);
        println!("{} texels", measured.texels);
        assert!(measured.texels <= TEXELS_MAX, "{} texels", measured.texels);
    });
}

/// The mean of hard shadows converges to the exact one: the error of n points that fill the light evenly is about the
/// perimeter of an edge's strata, n^(-1/2) · 1/2 at the most.
#[test]
fn square_by_reference_maps() {
    with_gpu(|gpu| {
        for maps in [16, 256] {
            let settings = Settings {
                maps,
                map: 256,
                ..Settings::usual(Technique::ReferenceMaps)
            };
            let mut case = Case::rectangle(square(30.0));
            case.rounding = 2.0 / f64::from(maps).sqrt();
            let measured = case.measure_with(gpu, settings);
            println!(
                "{maps} maps: {} texels, rms {:.2e}",
                measured.texels, measured.rms
            );
            assert!(measured.texels <= TEXELS_MAX, "{} texels", measured.texels);
            assert!(
                measured.rms <= 0.5 / f64::from(maps).sqrt(),
                "rms {}",
                measured.rms
            );
        }
    });
}
