//! The sizes of a frame's resources, against what the device allows.

use super::text::human;
use super::{Casters, Front, Plan};
use crate::error::{Error, Result};
use crate::gpu::Limits;
use crate::scene::Scene;
use crate::shared::{self, Fit, Kernel, Lists, Packet, Progress, Round, SECTOR_STEPS, View};
use crate::shot::Settings;
use crate::technique::{Recipe, Work};

/// Resources that the host fills or reads, by way of memory that it sees.
const COPIED: [&str; 13] = [
    "positions",
    "position_residuals",
    "triangles",
    "triangle_surfaces",
    "triangle_planes",
    "surfaces",
    "texcoords",
    "vertex_surfaces",
    "texels",
    "views",
    "sectors",
    "visibility",
    "picture",
];

/// How much of a scene there is, or may be.
#[derive(Debug, Clone, Copy, Default)]
pub struct Inventory {
    pub vertices: u64,
    pub triangles: u64,
    pub materials: u64,
    pub texcoords: u64,
    /// [byte] Of all textures.
    pub texels: u64,
    /// Of a host's meshes in a frame.
    pub instances: u64,
}

impl Inventory {
    pub fn of(scene: &Scene) -> Self {
        let texels = scene.textures.iter().map(|texture| texture.rgba.len());
        Self {
            vertices: scene.positions.len() as u64,
            triangles: scene.triangles.len() as u64,
            materials: scene.materials.len() as u64,
            texcoords: scene.texcoords.len() as u64,
            texels: texels.sum::<usize>() as u64,
            instances: 0,
        }
    }
}

impl Plan {
    pub(super) fn list_resources(&mut self, settings: &Settings, inventory: &Inventory) {
        let pixels = u64::from(self.size.0) * u64::from(self.size.1);
        let map = u64::from(self.map) * u64::from(self.map);
        let views = self.views().count() as u64;
        let tables = self.views().filter(|view| view.sectors.is_some()).count() as u64;
        let any = |test: fn(&Recipe) -> bool| self.needs(test);
        let rounds = self.rounds();
        // Of packets and of pixels, a pair for each view.
        let lists = if any(Recipe::has_lists) { views } else { 0 };
        let layers = self.sets().map(|set| set.recipe.layers);
        let layers = layers.max().unwrap_or(0);
        let words = match rounds {
            1 => None,
            _ => self.sets().map(|set| set.recipe.words).max(),
        };
        let words = words.unwrap_or(0);
        let grid = u64::from(self.size.0.div_ceil(settings.packet.0))
            * u64::from(self.size.1.div_ceil(settings.packet.1));
        // One for each pixel or for each lane of each packet.
        let lanes = u64::from(settings.packet.0 * settings.packet.1);
        let progress = if words > 0 {
            (grid * lanes).max(pixels)
        } else {
            0
        };
        let padded = u64::from(self.map.next_power_of_two());
        let Inventory {
            vertices,
            triangles,
            ..
        } = *inventory;
        let textured = u64::from(self.textured);
        let per_pixel = |needed: bool, bytes: usize| if needed { pixels * bytes as u64 } else { 0 };
        let drawn = u64::from(self.front == Front::Drawn);
        let host = 1 - drawn;
        let fitted = u64::from(matches!(self.casters, Casters::Scene | Casters::Gathered));
        self.resources = vec![
            ("positions", vertices * 12),
            (
                "position_residuals",
                if views > 0 { drawn * vertices * 12 } else { 0 },
            ),
            ("triangles", triangles * 12),
            ("triangle_surfaces", drawn * triangles * 4),
            ("triangle_planes", drawn * triangles * 16),
            (
                "surfaces",
                inventory.materials * size_of::<shared::Surface>() as u64,
            ),
            ("texcoords", textured * inventory.texcoords * 8),
            (
                "vertex_surfaces",
                if self.masked { vertices * 4 } else { 0 },
            ),
            ("texels", textured * inventory.texels),
            ("camera_depth", drawn * pixels * 4),
            ("position_world", pixels * 16),
            ("normal_world", pixels * 16),
            ("albedo", drawn * pixels * 4),
            (
                "caster_indices",
                if views > 0 {
                    fitted * triangles * 12
                } else {
                    0
                },
            ),
            ("host", host * size_of::<shared::Host>() as u64),
            (
                "instances",
                inventory.instances * size_of::<shared::Instance>() as u64,
            ),
            (
                "givens",
                (1 - fitted) * views * size_of::<shared::Given>() as u64,
            ),
            (
                "projections",
                u64::from(self.casters == Casters::DrawnByHost)
                    * views
                    * size_of::<shared::Projection>() as u64,
            ),
            ("shadow_map", map * 4),
            (
                "mssm",
                map * self.mssm_texel_bytes() * u64::from(self.levels),
            ),
            ("layers", map * 4 * u64::from(layers)),
            (
                "hsm",
                if any(|recipe| recipe.hsm) {
                    u64::from(self.map.div_ceil(2)) * padded * 8
                } else {
                    0
                },
            ),
            (
                "kernels",
                per_pixel(any(|recipe| recipe.mssm), size_of::<Kernel>()),
            ),
            (
                "packets",
                if any(|recipe| recipe.has(Work::PacketList)) {
                    grid * size_of::<Packet>() as u64
                } else {
                    0
                },
            ),
            (
                "pixels",
                per_pixel(any(|recipe| recipe.has(Work::PixelList)), 4),
            ),
            ("occlusion", per_pixel(views > 0, 4)),
            ("views", views * size_of::<View>() as u64),
            ("fits", views * size_of::<Fit>() as u64),
            ("lists", lists * size_of::<Lists>() as u64),
            (
                "rounds",
                lists * u64::from(rounds) * size_of::<Round>() as u64,
            ),
            ("partial", pixels * 4 * u64::from(words)),
            ("progress", progress * size_of::<Progress>() as u64),
            ("sectors", tables * u64::from(SECTOR_STEPS + 1) * 4),
            ("visibility", pixels * 4 * self.lights.len() as u64),
            ("picture", per_pixel(self.outputs.picture, 4)),
        ];
        self.resources.retain(|&(_, bytes)| bytes > 0);
    }

    /// [byte] Of all resources; they live as long as the frame.
    pub fn memory_bytes(&self) -> u64 {
        self.resources.iter().map(|&(_, bytes)| bytes).sum()
    }

    /// [byte] Of all resources and of the largest copy that goes to the device or comes back.
    pub fn peak_bytes(&self) -> u64 {
        let copied = self
            .resources
            .iter()
            .filter(|(name, _)| COPIED.contains(name));
        self.memory_bytes() + copied.map(|&(_, bytes)| bytes).max().unwrap_or(0)
    }

    pub(super) fn check(&self, limits: &Limits) -> Result<()> {
        let (width, height) = self.size;
        if width.max(height) > limits.image_side {
            return Err(Error::Unsupported(format!(
                "an image of {width}x{height} is more than the device's {} pixels a side; choose a smaller --size",
                limits.image_side
            )));
        }
        let images = [
            "camera_depth",
            "position_world",
            "normal_world",
            "albedo",
            "shadow_map",
            "mssm",
            "layers",
            "hsm",
        ];
        for &(name, bytes) in &self.resources {
            let (limit, what) = if images.contains(&name) {
                (limits.image_bytes, "image")
            } else {
                (limits.buffer_bytes, "buffer")
            };
            if bytes > limit {
                return Err(Error::Unsupported(format!(
                    "{name} takes {bytes} bytes and the device's largest {what} has {limit}; \
                     choose a smaller --size or a smaller scene"
                )));
            }
        }
        self.check_peak(limits)
    }

    fn check_peak(&self, limits: &Limits) -> Result<()> {
        let (peak, most) = (
            self.peak_bytes(),
            limits.memory_bytes.min(limits.allowed_bytes),
        );
        if peak <= most {
            return Ok(());
        }
        let largest = self.resources.iter().max_by_key(|(_, bytes)| *bytes);
        let (name, bytes) = largest.copied().unwrap_or_default();
        let (source, raised) = match limits.allowed_bytes < limits.memory_bytes {
            true => ("--max-memory allows", ", or raise --max-memory"),
            false => ("the device has", ""),
        };
        let halved = match name == "mssm" && self.mssm_bits > 16 {
            true => ", or --mssm-bits 16",
            false => "",
        };
        Err(Error::Unsupported(format!(
            "the frame takes {} at its peak, {} of it for {name}, and {source} {}; \
             choose a smaller --map or --size{halved}{raised}",
            human(peak),
            human(bytes),
            human(most),
        )))
    }
}
