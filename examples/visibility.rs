//! The shadow of a knot under a square light, from triangles in memory, printed and saved as numbers.
//!
//!     cargo run --release --example visibility [FILE.csv]
//!
//! Prints the visibility as characters, from `#` in the umbra to a blank where all of the light is seen, and writes one row of
//! the image per line to FILE.csv if it is given.

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use halfshade::gpu::{Gpu, Options};
use halfshade::plan::Outputs;
use halfshade::render::{DEFAULT_COSTS, DEFAULT_EXPOSURE, RenderOptions, Renderer};
use halfshade::scene::{AreaLight, Camera, LightShape, Scene, Shape, Triangles};
use halfshade::shot::Shot;
use halfshade::technique::{Settings, Technique};
use halfshade::{Error, Result};

/// [pixel]
const WIDTH: u32 = 96;
const HEIGHT: u32 = 48;

pub fn main() -> Result<()> {
    let shot = shot()?;
    let gpu = Gpu::open(&Options::default())?;
    let options = RenderOptions {
        outputs: Outputs { picture: false },
        costs: DEFAULT_COSTS,
        exposure: DEFAULT_EXPOSURE,
    };
    // Plans the frame, takes its memory and creates its pipelines; then any number of frames can follow.
    let mut renderer = Renderer::new(&gpu, &shot, options)?;
    renderer.render()?;
    let visibility = renderer.visibility(0)?;
    for row in visibility.chunks(WIDTH as usize) {
        println!(
            "{}",
            row.iter().map(character).collect::<String>().trim_end()
        );
    }
    match std::env::args_os().nth(1) {
        Some(file) => save(Path::new(&file), &visibility),
        None => Ok(()),
    }
}

/// A floor and a knot that stands on it.
fn scene() -> Result<Scene> {
    let mut triangles = Triangles::default();
    for shape in [
        Shape::square(6.0),
        Shape::torus_knot(0.8, 0.35, 0.15, 96, 12),
    ] {
        let first = triangles.positions.len() as u32;
        triangles
            .positions
            .extend(shape.positions.iter().map(|p| p.as_vec3()));
        let moved = shape
            .triangles
            .iter()
            .map(|corners| corners.map(|corner| first + corner));
        triangles.indices.extend(moved);
    }
    // No material is given, so all have the plain one, number 0.
    triangles.surfaces = vec![0; triangles.indices.len()];
    Scene::from_triangles(triangles)
}

fn shot() -> Result<Shot> {
    Ok(Shot {
        scene: Arc::new(scene()?),
        camera: Camera {
            name: String::new(),
            eye: DVec3::new(0.0, 3.2, 6.0),
            target: DVec3::new(0.0, 0.6, 0.0),
            up: DVec3::Y,
            vfov_deg: 40.0,
            aspect: None,
            ortho_height: None,
            near: None,
        },
        width: WIDTH,
        height: HEIGHT,
        lights: vec![AreaLight {
            name: "lamp".into(),
            center: DVec3::new(1.5, 4.0, 0.5),
            // Half axes; it shines along u × v, which is down.
            shape: LightShape::Rect {
                u: DVec3::X * 0.6,
                v: DVec3::Z * 0.6,
            },
            color: Vec3::ONE,
            intensity: None,
            beam: None,
        }],
        settings: Settings::usual(Technique::PacketContour),
        budget_map: None,
        physical: false,
        notes: Vec::new(),
    })
}

/// Darker characters for less of the light; a dot where there is no surface.
fn character(visibility: &f32) -> char {
    const SHADES: &[u8] = b"#%*+- ";
    match visibility.is_nan() {
        true => '.',
        false => char::from(SHADES[(visibility * (SHADES.len() - 1) as f32).round() as usize]),
    }
}

fn save(file: &Path, visibility: &[f32]) -> Result<()> {
    let mut text = String::new();
    for row in visibility.chunks(WIDTH as usize) {
        let numbers: Vec<String> = row.iter().map(f32::to_string).collect();
        writeln!(text, "{}", numbers.join(",")).map_err(|e| Error::Invalid(e.to_string()))?;
    }
    std::fs::write(file, text).map_err(|e| Error::io(file, e))
}
