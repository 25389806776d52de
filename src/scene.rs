//! Triangles, materials, textures, lights and cameras: what a scene file holds, flattened.

mod accessor;
mod container;
mod document;
mod draco;
mod emitters;
mod extensions;
pub(crate) mod file;
mod geometry;
pub mod gltf;
mod light;
mod material;
mod meshopt;
mod notes;
mod options;
mod pose;
mod primitive;
mod shape;
mod tree;
mod triangles;
mod uri;

use std::path::PathBuf;

use glam::{DVec3, Vec2, Vec3, Vec4};

pub use light::{
    Ball, Beam, Cone, Corners, Outline, SUN_ANGLE_DEG, Side, Spread, mapped, polygon_area,
};
pub(crate) use primitive::MAX_COORDINATE;
pub use shape::Shape;
pub use triangles::Triangles;

/// A scene, flattened into one list of triangles in world space. Whoever works in f32 takes positions relative to where
/// it looks from ([`Scene::positions_around`]), so that neither where the scene stands nor what else it holds costs
/// precision.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    /// [scene units, world] Vertex positions; every component is finite.
    pub positions: Vec<DVec3>,
    /// [texture widths, heights] One per vertex, KHR_texture_transform applied; empty when no material
    /// has a texture.
    pub texcoords: Vec<Vec2>,
    /// [0, 1] linear RGB, multiplied with the material's colour; one per vertex, or none.
    pub colors: Vec<Vec3>,
    /// Three vertices per triangle, counter-clockwise seen from the front; opaque triangles first,
    /// then the alpha-masked ones. Every index is below `positions.len()`.
    pub triangles: Vec<[u32; 3]>,
    /// One per triangle: index into `materials`.
    pub triangle_materials: Vec<u32>,
    /// Triangles `..opaque_count` are opaque, `opaque_count..` are alpha-masked.
    pub opaque_count: usize,
    /// One per triangle: whether it casts shadows. Empty: all do.
    pub casts: Vec<bool>,
    pub materials: Vec<Material>,
    /// Only the textures that `materials` name.
    pub textures: Vec<Texture>,
    /// In the order of the file's node tree.
    pub lights: Vec<AreaLight>,
    /// In the order of the file's node tree.
    pub cameras: Vec<Camera>,
    /// The files that a shot or a scene is read from: the shot file, the glTF, and the buffers and images that it names.
    pub files: Vec<PathBuf>,
    /// What the file asked for and the engine leaves out or treats otherwise, a sentence each.
    pub notes: Vec<String>,
}

/// A surface: diffuse colour and, where it has holes, the alpha below which light passes.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    pub name: String,
    /// [0, 1] linear RGB and alpha, multiplied with the texture.
    pub base_color: Vec4,
    /// Index into `Scene::textures`.
    pub texture: Option<usize>,
    /// [0, 1] alphaMode MASK: a texel whose alpha is below lets light through. None = opaque.
    pub alpha_cutoff: Option<f32>,
    /// False: the camera does not see its back faces. (They cast shadows all the same.)
    pub double_sided: bool,
}

/// How a texture continues beyond [0, 1].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Wrap {
    Repeat = 0,
    Mirror = 1,
    Clamp = 2,
}

/// A base-colour texture: sRGB colour, linear alpha, 8 bits each.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Texture {
    /// [texel]
    pub width: u32,
    /// [texel]
    pub height: u32,
    /// width × height × RGBA, the top row first.
    pub rgba: Vec<u8>,
    pub wrap: [Wrap; 2],
    /// True: bilinear between texel centres. False: the nearest texel.
    pub linear: bool,
}

/// A pinhole camera, or one of parallel rays. Positions are in world space.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    pub name: String,
    /// [scene units]
    pub eye: DVec3,
    /// [scene units]
    pub target: DVec3,
    pub up: DVec3,
    /// [degree] (0, 180) The full vertical field of view of a pinhole.
    pub vfov_deg: f64,
    /// [scene units] (0, ...) Parallel rays: the height of what is seen; the field of view does not count then. None: a pinhole.
    pub ortho_height: Option<f64>,
    /// Width / height that the file asks for, when it does.
    pub aspect: Option<f64>,
    /// [scene units] Along the view axis: what is nearer is not seen. None: everything in front of the eye is.
    pub near: Option<f64>,
}

/// What an area light looks like. A light with no extent at all is a point: its shadow is hard. A disc with a normal is the
/// limit of small discs then; other points have no direction and shine to all sides alike.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "a host moves lights in every frame, which must not allocate"
)]
pub enum LightShape {
    /// [scene units] Half-axis vectors, perpendicular to each other; the light shines along u × v.
    Rect { u: DVec3, v: DVec3 },
    /// [scene units] The light shines along `normal` (any length but 0, unless the radius is 0).
    Disc { normal: DVec3, radius: f64 },
    /// [scene units] What corners leave of a rectangle with these half-axes; it shines along u × v. [`LightShape::polygon`] makes it.
    Polygon {
        u: DVec3,
        v: DVec3,
        corners: Corners,
    },
    /// [scene units] It shines to all sides.
    Sphere { radius: f64 },
    /// Light from infinity along `direction` (any length but 0). [degree] \[0, 180) The angular diameter of the disc that it
    /// comes from. The light's centre is of no meaning.
    Sun { direction: DVec3, angle_deg: f64 },
}

/// A light of constant radiance; flat ones are one-sided.
#[derive(Debug, Clone, PartialEq)]
pub struct AreaLight {
    pub name: String,
    /// [scene units, world]
    pub center: DVec3,
    pub shape: LightShape,
    /// Linear RGB, ≥ 0.
    pub color: Vec3,
    /// [radiance] Of a light without extent: radiant intensity; of a sun: irradiance of a surface that faces it. None: such that a white surface at the camera's target
    /// that faces the light has radiance 1.
    pub intensity: Option<f32>,
    /// None: it shines as its shape does.
    pub beam: Option<Beam>,
}

impl Scene {
    /// [scene units, world] The bounding box of all vertices (both zero without any).
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let Some((&first, rest)) = self.positions.split_first() else {
            return (DVec3::ZERO, DVec3::ZERO);
        };
        rest.iter()
            .fold((first, first), |(lo, hi), &p| (lo.min(p), hi.max(p)))
    }

    /// [scene units, world] The corners of triangle `index`.
    pub fn corners(&self, index: usize) -> [DVec3; 3] {
        self.triangles[index].map(|i| self.positions[i as usize])
    }

    /// [scene units] All positions relative to `origin`, in f32.
    pub fn positions_around(&self, origin: DVec3) -> Vec<Vec3> {
        let positions = self.positions.iter();
        positions.map(|&p| (p - origin).as_vec3()).collect()
    }

    /// [scene units] The corners of triangle `index` relative to `origin`.
    pub fn corners_around(&self, origin: DVec3, index: usize) -> [DVec3; 3] {
        self.corners(index).map(|p| p - origin)
    }

    /// The material of triangle `index`.
    pub fn material_of(&self, index: usize) -> &Material {
        &self.materials[self.triangle_materials[index] as usize]
    }

    /// Whether triangle `index` casts shadows.
    pub fn casts(&self, index: usize) -> bool {
        self.casts.get(index).copied().unwrap_or(true)
    }

    /// Whether some triangles cast no shadows.
    pub fn tells_casters(&self) -> bool {
        !self.casts.is_empty()
    }

    /// Whether any material lets light through where its texture is transparent.
    pub fn has_masked(&self) -> bool {
        self.opaque_count < self.triangles.len()
    }
}
