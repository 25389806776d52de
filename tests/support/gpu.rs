//! Scenes built in code, rendered under the validation layer.
#![allow(dead_code)] // Each test program uses a part of it.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3, Vec4};
use halfshade::gpu::{Gpu, Options};
use halfshade::plan::{Outputs, Plan};
use halfshade::render::{DEFAULT_COSTS, DEFAULT_EXPOSURE, RenderOptions, Renderer};
use halfshade::scene::{AreaLight, Camera, LightShape, Material, Scene};
use halfshade::shared::Fit;
use halfshade::shot::{Overrides, Shot};
use halfshade::technique::Settings;

/// The scenes of the repository that have a shot file.
pub const SCENES: [&str; 6] = ["plate", "knot", "staircase", "grid", "colonnade", "tree"];

/// Runs a test on a device of its own under the validation layer, and fails when the layer has anything
/// to say, be it only when the device goes.
pub fn with_gpu<T>(test: impl FnOnce(&Arc<Gpu>) -> T) -> T {
    let gpu = Gpu::open(&Options {
        validate: true,
        ..Options::default()
    })
    .expect("a Vulkan device and the validation layer");
    let messages = gpu.validation_messages();
    let result = test(&gpu);
    assert_eq!(Arc::strong_count(&gpu), 1, "something outlives the test");
    drop(gpu);
    let messages = messages.lock().expect("no callback panicked");
    assert!(messages.is_empty(), "{}", messages.join("\n"));
    result
}

/// [pixel or texel] The grid that the rasteriser moves vertices onto: lavapipe's is 1/256, SwiftShader's 1/16.
pub fn raster_grid(gpu: &Gpu) -> f64 {
    0.5f64.powi(gpu.info.subpixel_bits as i32)
}

/// What a frame of one light left behind.
pub struct Image {
    pub visibility: Vec<f32>,
    /// [scene units, world] w = 1 where there is a surface, else 0.
    pub positions: Vec<[f64; 4]>,
    pub fits: Vec<Fit>,
    pub plan: Plan,
}

pub fn renderer(gpu: &Arc<Gpu>, shot: &Shot) -> Renderer {
    let options = RenderOptions {
        outputs: Outputs { picture: false },
        costs: DEFAULT_COSTS,
        exposure: DEFAULT_EXPOSURE,
    };
    Renderer::new(gpu, shot, options).expect("a renderer")
}

/// Renders a shot of one light.
pub fn render(gpu: &Arc<Gpu>, shot: &Shot) -> Image {
    let mut renderer = renderer(gpu, shot);
    let frame = renderer.render().expect("a frame");
    Image {
        visibility: renderer.visibility(0).expect("visibility"),
        positions: positions(&renderer, shot),
        fits: renderer.fits().expect("fits"),
        plan: frame.plan,
    }
}

pub fn visibility(gpu: &Arc<Gpu>, shot: &Shot) -> Vec<f32> {
    let mut renderer = renderer(gpu, shot);
    renderer.render().expect("a frame");
    renderer.visibility(0).expect("visibility")
}

/// [scene units, world] Of all pixels; w = 1 where there is a surface, else 0.
pub fn positions(renderer: &Renderer, shot: &Shot) -> Vec<[f64; 4]> {
    let relative: Vec<[f32; 4]> = renderer
        .read_image("position_world", (shot.width * shot.height) as usize)
        .expect("positions");
    let world = |[x, y, z, surface]: [f32; 4]| {
        let point = shot.origin() + Vec3::new(x, y, z).as_dvec3();
        point.extend(surface.into()).to_array()
    };
    relative.into_iter().map(world).collect()
}

/// The largest difference of two images of visibility, which must agree about where there is a surface.
pub fn largest_difference(a: &[f32], b: &[f32]) -> f32 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |largest, (a, b)| {
        assert_eq!(
            a.is_nan(),
            b.is_nan(),
            "a surface in only one of the images"
        );
        if a.is_nan() {
            largest
        } else {
            largest.max((a - b).abs())
        }
    })
}

/// Whether two images are the same bit for bit.
pub fn same_bits(a: &[f32], b: &[f32]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

/// A scene of the repository.
pub fn load(name: &str, side: u32, settings: Settings) -> Shot {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.json"));
    let overrides = Overrides {
        size: Some((side, side)),
        ..Overrides::default()
    };
    let mut shot = Shot::load(&file, &overrides).expect("a scene of the repository");
    shot.settings = settings;
    shot
}

/// A scene of white, double-sided triangles.
#[derive(Default)]
pub struct Triangles(pub Vec<[DVec3; 3]>);

impl Triangles {
    pub fn new() -> Self {
        Self::default()
    }

    /// A convex polygon, as a fan.
    pub fn polygon(mut self, corners: &[DVec3]) -> Self {
        for i in 1..corners.len() - 1 {
            self.0.push([corners[0], corners[i], corners[i + 1]]);
        }
        self
    }

    /// A polygon in the plane at a height.
    pub fn plate(self, height: f64, corners: &[DVec2]) -> Self {
        let corners: Vec<DVec3> = corners
            .iter()
            .map(|c| DVec3::new(c.x, height, c.y))
            .collect();
        self.polygon(&corners)
    }

    /// The floor y = 0 over [x0, x1] × [z0, z1].
    pub fn floor(self, x: [f64; 2], z: [f64; 2]) -> Self {
        self.plate(0.0, &rectangle(x, z))
    }

    pub fn build(&self) -> Arc<Scene> {
        Arc::new(Scene {
            positions: self.0.iter().flatten().copied().collect(),
            triangles: (0..self.0.len() as u32)
                .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
                .collect(),
            triangle_materials: vec![0; self.0.len()],
            opaque_count: self.0.len(),
            materials: vec![Material {
                name: String::new(),
                base_color: Vec4::ONE,
                texture: None,
                alpha_cutoff: None,
                double_sided: true,
            }],
            ..Scene::default()
        })
    }
}

pub fn rectangle(x: [f64; 2], z: [f64; 2]) -> [DVec2; 4] {
    [
        DVec2::new(x[0], z[0]),
        DVec2::new(x[0], z[1]),
        DVec2::new(x[1], z[1]),
        DVec2::new(x[1], z[0]),
    ]
}

/// A light that shines down.
pub fn light(center: DVec3, shape: LightShape) -> AreaLight {
    AreaLight {
        name: String::new(),
        center,
        shape,
        color: Vec3::ONE,
        intensity: None,
        beam: None,
    }
}

/// A rectangle with half sizes along x and z.
pub fn rectangle_light(center: DVec3, half: DVec2) -> AreaLight {
    let (u, v) = (DVec3::X * half.x, DVec3::Z * half.y);
    light(center, LightShape::Rect { u, v })
}

pub fn disc_light(center: DVec3, radius: f64) -> AreaLight {
    let normal = DVec3::NEG_Y;
    light(center, LightShape::Disc { normal, radius })
}

/// A camera.
pub fn camera(eye: DVec3, target: DVec3, vfov_deg: f64) -> Camera {
    let down = (target - eye).normalize().cross(DVec3::Y).length() < 1e-3;
    Camera {
        name: String::new(),
        eye,
        target,
        up: if down { DVec3::NEG_Z } else { DVec3::Y },
        vfov_deg,
        aspect: None,
        ortho_height: None,
        near: None,
    }
}

/// One light, a square image.
pub fn shot(
    scene: Arc<Scene>,
    camera: Camera,
    light: AreaLight,
    side: u32,
    settings: Settings,
) -> Shot {
    Shot {
        scene,
        camera,
        width: side,
        height: side,
        lights: vec![light],
        settings,
        budget_map: None,
        physical: false,
        notes: Vec::new(),
    }
}
