//! A resource: memory that passes share under the name that their shaders give it.

use super::{Casters, Density, Front};
use crate::gpu::ImageKind;
use crate::scene::Scene;
use crate::shared::TILE_SIZE;

/// A resource as its producer declares it.
#[derive(Debug, Clone, Copy)]
pub struct Resource {
    pub name: &'static str,
    /// How large it is in a frame.
    pub shape: fn(&Sizes) -> Shape,
    /// The host fills or reads it, by way of memory that it sees.
    pub copied: bool,
}

/// The form of a resource in a frame. One without bytes is left out; shaders that name it find a placeholder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// [byte]
    Buffer(u64),
    Image {
        kind: ImageKind,
        /// [texel]
        size: (u32, u32),
        layers: u32,
    },
}

/// What the sizes of resources depend on.
#[derive(Debug, Clone, Copy)]
pub struct Sizes {
    pub front: Front,
    pub casters: Casters,
    pub inventory: Inventory,
    /// [pixel]
    pub image: (u32, u32),
    /// The shaded picture is asked for.
    pub picture: bool,
    /// Pixels have several samples.
    pub multisampled: bool,
    /// The scene has textures that the frame needs.
    pub textured: bool,
    /// Its vertices have colours that the frame needs.
    pub colored: bool,
    /// The scene has alpha-masked triangles.
    pub masked: bool,
    /// Some of its triangles cast no shadows.
    pub tells_casters: bool,
    pub lights: u32,
    pub views: u32,
    /// [entry] Of the sector tables of the views' sub-lights.
    pub sector_entries: u64,
    /// Of polygons.
    pub corners: u32,
    /// [texel] Side of the shadow map; 0 = no view needs one.
    pub map: u32,
    /// [bit] 16 or 32, of a bound in the hierarchy over it.
    pub bounds_bits: u32,
    /// [level] Of the hierarchy; 0 = none.
    pub levels: u32,
    pub density: Density,
    /// [slot] For views whose maps are made side by side.
    pub views_at_once: u32,
    /// Of these, views that are looked at side by side.
    pub looked_at_once: u32,
    /// [layer] Of the shadow map that are kept.
    pub layers: u32,
    /// [level] Coarser than the map that are kept; 0 = no budget limits quality.
    pub coarse_levels: u32,
    /// They are of microrects.
    pub microrects: bool,
    /// Pixels have budgets of their own, and an image of shares is given for them.
    pub budgets_vary: bool,
    pub budget_mapped: bool,
    /// Whether there are kernels, and lists of packets and of pixels.
    pub kernels: bool,
    /// Local packets form in windows.
    pub windows: bool,
    /// Some pixels are joined from others.
    pub joins: bool,
    pub packet_lists: bool,
    pub pixel_lists: bool,
    /// [pixel] Width and height of a packet.
    pub packet: (u32, u32),
    /// [dispatch] In which a list is worked off.
    pub rounds: u32,
    /// [word] What a pixel keeps from one round to the next.
    pub words: u32,
}

/// How much of a scene there is, or may be.
#[derive(Debug, Clone, Copy, Default)]
pub struct Inventory {
    pub vertices: u64,
    pub triangles: u64,
    pub materials: u64,
    pub texcoords: u64,
    pub colors: u64,
    /// [byte] Of all textures.
    pub texels: u64,
    /// Of a host's meshes in a frame.
    pub instances: u64,
}

impl Resource {
    /// One that stays on the device.
    pub const fn new(name: &'static str, shape: fn(&Sizes) -> Shape) -> Self {
        Self {
            name,
            shape,
            copied: false,
        }
    }

    /// One that is copied from or to the host.
    pub const fn copied(name: &'static str, shape: fn(&Sizes) -> Shape) -> Self {
        Self {
            name,
            shape,
            copied: true,
        }
    }
}

impl Shape {
    /// A buffer of `count` elements of type `T`.
    pub fn array<T>(count: u64) -> Self {
        Self::Buffer(count * size_of::<T>() as u64)
    }

    pub fn image(kind: ImageKind, size: (u32, u32)) -> Self {
        Self::layers(kind, size, 1)
    }

    pub fn layers(kind: ImageKind, size: (u32, u32), layers: u32) -> Self {
        Self::Image { kind, size, layers }
    }

    /// So many of them, one after another: an image's layers.
    #[must_use]
    pub fn times(self, count: u32) -> Self {
        match self {
            Self::Buffer(bytes) => Self::Buffer(bytes * u64::from(count)),
            Self::Image { kind, size, layers } => Self::layers(kind, size, layers * count),
        }
    }

    /// As it is if it is needed, or else without bytes.
    #[must_use]
    pub fn when(self, needed: bool) -> Self {
        match self {
            _ if needed => self,
            Self::Buffer(_) => Self::Buffer(0),
            Self::Image { kind, size, .. } => Self::layers(kind, size, 0),
        }
    }

    /// [byte]
    pub fn bytes(self) -> u64 {
        match self {
            Self::Buffer(bytes) => bytes,
            Self::Image {
                kind,
                size: (width, height),
                layers,
            } => u64::from(width) * u64::from(height) * u64::from(layers) * kind.texel_bytes(),
        }
    }

    pub fn is_image(self) -> bool {
        matches!(self, Self::Image { .. })
    }
}

impl Sizes {
    /// [pixel] Of the image.
    pub fn pixels(&self) -> u64 {
        u64::from(self.image.0) * u64::from(self.image.1)
    }

    /// [tile] Of the image.
    pub fn tiles(&self) -> u64 {
        let along = |pixels: u32| u64::from(pixels.div_ceil(TILE_SIZE));
        along(self.image.0) * along(self.image.1)
    }

    /// [packet] Of the image.
    pub fn packets(&self) -> u64 {
        let along = |pixels: u32, packet: u32| u64::from(pixels.div_ceil(packet));
        along(self.image.0, self.packet.0) * along(self.image.1, self.packet.1)
    }

    /// Whether some light has views.
    pub fn has_views(&self) -> bool {
        self.views > 0
    }

    pub fn is_drawn(&self) -> bool {
        self.front == Front::Drawn
    }

    /// The lists of packets and of pixels, a pair for each view.
    pub fn lists(&self) -> u64 {
        match self.packet_lists || self.windows || self.pixel_lists {
            true => self.views.into(),
            false => 0,
        }
    }
}

impl Inventory {
    pub fn of(scene: &Scene) -> Self {
        let texels = scene.textures.iter().map(|texture| texture.rgba.len());
        Self {
            vertices: scene.positions.len() as u64,
            triangles: scene.triangles.len() as u64,
            materials: scene.materials.len() as u64,
            texcoords: scene.texcoords.len() as u64,
            colors: scene.colors.len() as u64,
            texels: texels.sum::<usize>() as u64,
            instances: 0,
        }
    }
}
