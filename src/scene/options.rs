//! How to read a file, and what it may ask for.

/// How to read a glTF file.
#[derive(Debug, Clone, Default)]
pub struct LoadOptions {
    /// Which scene of the file, counted from 0. None: its default scene, else its first.
    pub scene: Option<usize>,
    /// [scene units] ≥ 0. Point and spot lights become spheres of this radius. None: they are left out.
    pub punctual_radius: Option<f64>,
    /// [degree] \[0, 180) Angular diameter of directional lights. None: the sun's.
    pub sun_angle_deg: Option<f64>,
    /// The file may name files outside of its own folder, be it by `..`, by a link, by an absolute path
    /// or by a `file:` URL.
    pub outside_paths: bool,
    /// The caller has lights of its own: nothing is noted about those of the file.
    pub own_lights: bool,
    /// Names of the nodes that cast shadows, each with all below it. None: all do.
    pub casters: Option<Vec<String>>,
    /// What surfaces are that blend with what is behind them.
    pub blend: Blend,
    /// A material whose texture decides where light passes is opaque where that texture cannot be read.
    pub allow_missing: bool,
    pub limits: Limits,
}

/// What materials of alphaMode BLEND are to shadows, which know no half-transparent surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Blend {
    /// Opaque, but where the alpha of their texture is 0.
    #[default]
    Opaque,
    /// Not there.
    Ignore,
    /// Light passes where their alpha is below their alphaCutoff (0.5 without one).
    Mask,
}

/// What a file may ask for at most, however small it is itself.
#[derive(Debug, Clone)]
pub struct Limits {
    /// Triangles, every instance of a mesh counted. Default: 2²⁶ (about 4 GiB).
    pub max_triangles: usize,
    /// Primitives, every instance of a mesh counted: empty ones take time too. Default: 2²².
    pub max_primitives: usize,
    /// [texel] Width and height of a texture. Default: 16384.
    pub max_texture_side: u32,
    /// [texel] All textures together, 4 bytes each. Default: 2²⁸ (1 GiB).
    pub max_texels: u64,
    /// What the scene takes in memory, per byte of its files, beyond the first 256 MiB: compressed images and
    /// instances let a small file ask for much. Default: 256.
    pub max_expansion: u64,
}

/// [byte] What any scene may take, however small its files are.
const FREE_BYTES: u64 = 256 << 20;

/// What a scene may still take in memory, in proportion to the files that it is read from.
pub(super) struct Budget {
    expansion: u64,
    left: u64,
}

impl Budget {
    pub fn new(limits: &Limits) -> Self {
        Self {
            expansion: limits.max_expansion,
            left: FREE_BYTES,
        }
    }

    /// Grants what a file of this many bytes may expand to.
    pub fn earn(&mut self, file_bytes: usize) {
        let earned = self.expansion.saturating_mul(file_bytes as u64);
        self.left = self.left.saturating_add(earned);
    }

    /// [byte] What there is room for.
    pub fn left(&self) -> u64 {
        self.left
    }

    /// Whether there is room for this many bytes, which are taken then.
    pub fn spend(&mut self, bytes: u64) -> bool {
        let rest = self.left.checked_sub(bytes);
        self.left = rest.unwrap_or(self.left);
        rest.is_some()
    }
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            max_triangles: 1 << 26,
            max_primitives: 1 << 22,
            max_texture_side: 16384,
            max_texels: 1 << 28,
            max_expansion: 256,
        }
    }
}
