//! Soft shadows of area lights on Vulkan: without noise, without history, the same image every time.
//!
//! halfshade renders S×S shadow maps of parts of a light, builds a multi-scale shadow map over each, and integrates, for every
//! pixel, what the contours of occluders hide of the light [Yang09]. The techniques of other publications run on the same
//! maps, so that they can be compared. `docs/algorithm.md` has the formulas, `docs/references.md` the publications.
//!
//! # From arrays to visibility
//!
//! ```
//! use std::sync::Arc;
//!
//! use glam::{DVec3, Vec3};
//! use halfshade::gpu::{Gpu, Options};
//! use halfshade::plan::Outputs;
//! use halfshade::render::{DEFAULT_COSTS, DEFAULT_EXPOSURE, RenderOptions, Renderer};
//! use halfshade::scene::{AreaLight, Camera, LightShape, Scene, Triangles};
//! use halfshade::shot::Shot;
//! use halfshade::technique::{Settings, Technique};
//!
//! # fn main() -> halfshade::Result<()> {
//! // A floor of 8 × 8 and, one above it, a plate of 1 × 1.
//! let square = |half: f32, y: f32| [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)]
//!     .map(|(x, z)| Vec3::new(half * x, y, half * z));
//! let scene = Scene::from_triangles(Triangles {
//!     positions: [square(4.0, 0.0), square(0.5, 1.0)].concat(),
//!     indices: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
//!     surfaces: vec![0; 4],
//!     ..Triangles::default()
//! })?;
//! let shot = Shot {
//!     scene: Arc::new(scene),
//!     camera: Camera {
//!         name: String::new(),
//!         eye: DVec3::new(0.0, 3.0, 4.0),
//!         target: DVec3::ZERO,
//!         up: DVec3::Y,
//!         vfov_deg: 45.0,
//!         aspect: None,
//!         ortho_height: None,
//!         near: None,
//!     },
//!     width: 64,
//!     height: 64,
//!     lights: vec![AreaLight {
//!         name: "ceiling".into(),
//!         center: DVec3::new(0.0, 4.0, 0.0),
//!         shape: LightShape::Rect { u: DVec3::X, v: DVec3::Z }, // shines along u × v: down
//!         color: Vec3::ONE,
//!         intensity: None,
//!         beam: None,
//!     }],
//!     settings: Settings { map: 256, ..Settings::usual(Technique::PacketContour) },
//!     budget_map: None,
//!     physical: false,
//!     notes: Vec::new(),
//! };
//! let options = RenderOptions {
//!     outputs: Outputs { picture: false },
//!     costs: DEFAULT_COSTS,
//!     exposure: DEFAULT_EXPOSURE,
//! };
//! let mut renderer = Renderer::new(&Gpu::open(&Options::default())?, &shot, options)?;
//! renderer.render()?;
//! // Row by row from the top: 0 in the umbra, 1 where all of the light is seen, NaN where there is no surface.
//! let visibility: Vec<f32> = renderer.visibility(0)?;
//! assert!(visibility.iter().any(|share| *share > 0.1 && *share < 0.9));
//! # Ok(())
//! # }
//! ```
//!
//! # Three ways in
//!
//! - [`render::Renderer`] draws a [`shot::Shot`] on a device of its own, as above and in `examples/visibility.rs`.
//! - [`render::Effect`] records a light's shadows into a host's command buffers, between the host's images; see
//!   `examples/lent_device`.
//! - `include/halfshade.h` and `include/halfshade_vulkan.h` are both for C and whatever calls it (feature `capi`).
//!
//! # Modules, in the order of the data
//!
//! - [`scene`]: triangles, materials, lights, cameras; the glTF loader.
//! - [`sub_light`]: a light cut into parts, of which each has views of its own.
//! - [`frame`]: passes and resources as data; what they are and who produces them.
//! - [`technique`]: what a publication runs; settings and their table of knobs.
//! - [`shot`]: one image, completely: scene, camera, lights, size, settings.
//! - [`plan`]: what will run, in which sizes, and what is left out and why; pure.
//! - [`render`]: creates what the plan lists and records it.
//! - [`gpu`]: Vulkan, ignorant of shadows. [`shared`]: structs and constants of host and shaders.
//! - `twin`, `reference`: scalar twins of the passes; ray-traced truth (feature `reference`).
//! - `study`, `compare`, `calibrate`: measurements behind the program (feature `cli`).
#[cfg(feature = "capi")]
pub mod c_api;
#[cfg(feature = "cli")]
pub mod calibrate;
#[cfg(feature = "cli")]
pub mod compare;
pub mod error;
pub mod frame;
pub mod gpu;
pub mod image;
pub mod number;
pub mod plan;
#[cfg(feature = "reference")]
pub mod reference;
pub mod render;
pub mod scene;
pub mod shared;
pub mod shot;
#[cfg(feature = "cli")]
pub mod spread;
#[cfg(feature = "cli")]
pub mod study;
pub mod sub_light;
pub mod technique;
#[cfg(feature = "reference")]
pub mod twin;
pub use error::{Error, Result};
