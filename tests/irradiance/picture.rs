//! The pass against the twin, and what small lights look like.

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};
use halfshade::gpu::Gpu;
use halfshade::plan::{Outputs, plan};
use halfshade::render::{DEFAULT_COSTS, DEFAULT_EXPOSURE, RenderOptions, Renderer};
use halfshade::scene::{AreaLight, LightShape, Scene};
use halfshade::shared::Light;
use halfshade::shot::Shot;
use halfshade::technique::{Settings, Technique};
use halfshade::twin::irradiance::irradiance;

use crate::support::{Triangles, camera, light, shot, with_gpu};

/// [pixel] Width and height of all pictures.
const SIDE: u32 = 64;
/// [scene units] From the light's centre to what the camera looks at.
const DISTANCE: f64 = 2.5;

/// A floor, a wall that faces it at 45 degrees, and one that stands upright.
fn stage() -> Arc<Scene> {
    let wall = |x: f64, top: DVec2| {
        [(0.0, -2.0), (0.0, 2.0), (1.0, 2.0), (1.0, -2.0)]
            .map(|(up, z)| DVec3::new(x + up * top.x, up * top.y, z))
    };
    Triangles::new()
        .floor([-2.0, 2.0], [-2.0, 2.0])
        .polygon(&wall(1.0, DVec2::new(1.0, 1.0)))
        .polygon(&wall(-2.0, DVec2::new(0.0, 1.5)))
        .build()
}

/// A light at [`DISTANCE`] above the stage's middle that shines down at an angle, its half sizes in distances.
fn above(size: [f64; 2], round: bool) -> AreaLight {
    let normal = DVec3::new(0.2, -1.0, 0.1).normalize();
    let (u, v) = normal.any_orthonormal_pair();
    let shape = match round {
        true => LightShape::Disc {
            normal,
            radius: size[0] * DISTANCE,
        },
        false => LightShape::Rect {
            u: u * size[0] * DISTANCE,
            v: v * size[1] * DISTANCE,
        },
    };
    light(DVec3::Y * DISTANCE, shape)
}

fn shot_of(scene: Arc<Scene>, light: AreaLight) -> Shot {
    let settings = Settings {
        map: 64,
        technique: Technique::Hard,
        ..Settings::default()
    };
    let camera = camera(DVec3::new(0.3, 2.2, 4.5), DVec3::ZERO, 50.0);
    shot(scene, camera, light, SIDE, settings)
}

/// A picture without shadows.
struct Picture {
    /// [0, 255] Red of each pixel.
    red: Vec<u8>,
    /// Position and normal where there is a surface.
    points: Vec<Option<(Vec3, Vec3)>>,
    light: Light,
    corners: Vec<[f32; 2]>,
}

fn picture_of(gpu: &Arc<Gpu>, shot: &Shot) -> Picture {
    let options = RenderOptions {
        outputs: Outputs { picture: true },
        costs: DEFAULT_COSTS,
        exposure: DEFAULT_EXPOSURE,
    };
    let mut renderer = Renderer::new(gpu, shot, options).expect("a renderer");
    renderer.render().expect("a frame");
    let pixels = (SIDE * SIDE) as usize;
    let read = |name| -> Vec<[f32; 4]> { renderer.read_image(name, pixels).expect(name) };
    let points = read("position_world").into_iter().zip(read("normal_world"));
    let point = |(position, normal): ([f32; 4], [f32; 4])| {
        let vector = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
        (position[3] > 0.0).then(|| (vector(position), vector(normal)))
    };
    let unshadowed = renderer.picture_of(&vec![1.0; pixels]).expect("a picture");
    Picture {
        red: unshadowed.into_iter().step_by(4).collect(),
        points: points.map(point).collect(),
        light: renderer.plan().lights[0].light,
        corners: renderer.plan().corners(),
    }
}

/// [0, 255] What a white surface of this radiance looks like.
fn encoded(radiance: f64) -> f64 {
    let mapped = radiance * (1.0 + radiance / 16.0) / (1.0 + radiance);
    let linear = mapped.clamp(0.0, 1.0);
    255.0
        * match linear > 0.003_130_8 {
            true => 1.055 * linear.powf(1.0 / 2.4) - 0.055,
            false => 12.92 * linear,
        }
}

/// By how many levels of 255 the picture differs from the twin's at most, and the range of white's unshadowed radiance.
fn difference_from_twin(picture: &Picture) -> (f64, [f64; 2]) {
    let ambient = f64::from(DEFAULT_EXPOSURE.ambient);
    let mut largest: f64 = 0.0;
    let mut range = [f64::MAX, 0.0f64];
    for (index, point) in picture.points.iter().enumerate() {
        let Some((position, normal)) = *point else {
            assert_eq!(picture.red[index], 0, "no surface");
            continue;
        };
        let intensity = f64::from(picture.light.intensity[0]);
        let unshadowed = f64::from(irradiance(
            &picture.light,
            &picture.corners,
            position,
            normal,
        )) * intensity
            / std::f64::consts::PI;
        let wanted = encoded(ambient + unshadowed);
        largest = largest.max((f64::from(picture.red[index]) - wanted).abs());
        range = [range[0].min(unshadowed), range[1].max(unshadowed)];
    }
    (largest, range)
}

/// From points to lights that reach far beyond the stage, whose planes cut them.
#[test]
fn the_pass_is_its_twin() {
    with_gpu(|gpu| {
        for round in [false, true] {
            for size in [0.0, 1e-7, 1e-3, 0.3, 3.0, 50.0] {
                let shot = shot_of(stage(), above([size, 0.6 * size], round));
                let picture = picture_of(gpu, &shot);
                let (levels, range) = difference_from_twin(&picture);
                println!("round {round}, size {size}: {levels:.2} levels, radiance {range:?}");
                // Half a level of rounding, and powers that are off by less than another half.
                assert!(levels < 1.0, "round {round}, size {size}: {levels}");
                assert!(range[1] > 0.5 && range[0] < 0.5 * range[1], "{range:?}");
            }
        }
    });
}

/// Small ones and wide ones, whose sides the stage's planes cut.
#[test]
fn the_pass_is_its_twin_under_polygons() {
    with_gpu(|gpu| {
        for size in [1e-6, 1e-3, 0.1, 0.3, 3.0, 50.0] {
            let LightShape::Rect { u, v } = above([size, 0.6 * size], false).shape else {
                panic!("a rectangle")
            };
            let corners = [
                [-1.0, -0.8],
                [0.3, -1.0],
                [1.0, -0.2],
                [0.9, 0.5],
                [-0.4, 1.0],
            ];
            let corners = corners.map(|[x, y]| DVec3::Y * DISTANCE + x * u + y * v);
            let (center, shape) = LightShape::polygon(&corners).expect("a polygon");
            let picture = picture_of(gpu, &shot_of(stage(), light(center, shape)));
            let (levels, range) = difference_from_twin(&picture);
            println!("size {size}: {levels:.2} levels, radiance {range:?}");
            assert!(levels < 1.0, "size {size}: {levels}");
            assert!(range[1] > 0.5 && range[0] < 0.5 * range[1], "{range:?}");
        }
    });
}

#[test]
fn the_pass_is_its_twin_under_suns_and_spheres() {
    with_gpu(|gpu| {
        let direction = DVec3::new(0.3, -1.0, 0.2);
        let sun = |angle_deg| LightShape::Sun {
            direction,
            angle_deg,
        };
        let sphere = |radius| LightShape::Sphere { radius };
        for shape in [sun(0.0), sun(0.533), sun(60.0), sphere(0.001), sphere(1.0)] {
            let light = light(DVec3::Y * DISTANCE, shape);
            let (levels, range) = difference_from_twin(&picture_of(gpu, &shot_of(stage(), light)));
            println!("{shape:?}: {levels:.2} levels, radiance {range:?}");
            assert!(levels < 1.0, "{shape:?}: {levels}");
            assert!(range[1] > 0.5 && range[0] < 0.5 * range[1], "{range:?}");
        }
    });
}

/// Of a light that is small against its distance nothing is left but where it is: all pictures are that of the limit, a disc
/// without extent. The floor is lit up to grazing angles.
#[test]
fn pictures_of_small_lights_are_the_same() {
    let floor = || Triangles::new().floor([-40.0, 40.0], [-40.0, 4.0]).build();
    with_gpu(|gpu| {
        let limit = picture_of(gpu, &shot_of(floor(), above([0.0; 2], true)));
        let levels: Vec<u8> = (limit.points.iter().zip(&limit.red))
            .filter(|(point, _)| point.is_some())
            .map(|(_, &red)| red)
            .collect();
        let (least, most) = (levels.iter().min(), levels.iter().max());
        assert!(
            least < Some(&70) && most > Some(&180),
            "{least:?} … {most:?}"
        );
        for size in [1e-3, 1e-5, 1e-7, 1e-18] {
            for round in [false, true] {
                let picture = picture_of(gpu, &shot_of(floor(), above([size; 2], round)));
                let differences = picture.red.iter().zip(&limit.red);
                let largest = differences.map(|(a, b)| a.abs_diff(*b)).max();
                assert!(
                    largest <= Some(1),
                    "round {round}, size {size}: {largest:?}"
                );
            }
        }
    });
}

/// What a light is given to shine with ends, with its size, in what a point is given.
#[test]
fn intensity_does_not_end_with_the_area() {
    let intensity = |light: AreaLight| {
        with_gpu(|gpu| {
            let shot = shot_of(stage(), light);
            let planned = plan(&shot, Outputs { picture: true }, &gpu.limits).expect("a plan");
            planned.lights[0].light.intensity[0]
        })
    };
    let limit = intensity(above([0.0; 2], true));
    for size in [1e-3, 1e-7, 1e-18] {
        for round in [false, true] {
            assert_eq!(intensity(above([size; 2], round)), limit, "size {size}");
        }
    }
    let given = |radiance, size| AreaLight {
        intensity: Some(radiance),
        beam: None,
        ..above([size; 2], true)
    };
    let area = std::f64::consts::PI * (0.1 * DISTANCE).powi(2);
    assert_eq!(intensity(given(3.0, 0.1)), (3.0 * area) as f32);
    assert_eq!(intensity(given(3.0, 0.0)), 3.0);
    assert_eq!(intensity(given(f32::MAX, 1e10)), f32::MAX);
}

/// Colours of vertices are interpolated, and multiply the material's.
#[test]
fn colours_of_vertices_are_those_of_surfaces() {
    let mut scene = (*stage()).clone();
    scene.materials[0].base_color = glam::Vec4::new(1.0, 0.5, 1.0, 1.0);
    scene.colors = (scene.positions.iter())
        .map(|place| Vec3::new(0.25, 0.5 + 0.1 * place.z as f32, 0.0))
        .collect();
    let shot = shot_of(Arc::new(scene), above([0.1; 2], true));
    with_gpu(|gpu| {
        let options = RenderOptions {
            outputs: Outputs { picture: true },
            costs: DEFAULT_COSTS,
            exposure: DEFAULT_EXPOSURE,
        };
        let mut renderer = Renderer::new(gpu, &shot, options).expect("a renderer");
        renderer.render().expect("a frame");
        let pixels = (SIDE * SIDE) as usize;
        let places: Vec<[f32; 4]> = renderer
            .read_image("position_world", pixels)
            .expect("positions");
        let found: Vec<[u8; 4]> = renderer.read_image("albedo", pixels).expect("albedo");
        let eye = shot.origin();
        let mut count = 0;
        for (place, found) in places.iter().zip(found).filter(|(place, _)| place[3] > 0.0) {
            let z = f64::from(place[2]) + eye.z;
            let wanted = [0.25, 0.5 * (0.5 + 0.1 * z), 0.0];
            for (found, wanted) in found.into_iter().zip(wanted) {
                // Half a step of 8 bits, and what interpolation rounds.
                assert!(
                    (f64::from(found) - 255.0 * wanted).abs() < 0.6,
                    "{found} for {wanted} at {z}"
                );
            }
            count += 1;
        }
        assert!(count > 1000, "{count}");
    });
}
