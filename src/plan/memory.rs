//! The sizes of a frame's resources, against what the device allows.

use super::Plan;
use super::text::human;
use crate::error::{Error, Result};
use crate::frame::{Domain, Inventory, Resource, Shape, Sizes, back, front, kernel, map};
use crate::gpu::{ImageKind, Limits};
use crate::technique::Recipe;

/// A resource as large as the frame needs it.
#[derive(Debug, Clone, Copy)]
pub struct PlannedResource {
    pub name: &'static str,
    pub shape: Shape,
    copied: bool,
}

impl PlannedResource {
    /// [byte]
    pub fn bytes(&self) -> u64 {
        self.shape.bytes()
    }
}

/// [byte] Of resources and of the largest copy that goes to the device or comes back.
pub(super) fn peak_bytes(resources: &[PlannedResource]) -> u64 {
    let copied = resources.iter().filter(|resource| resource.copied);
    let all: u64 = resources.iter().map(PlannedResource::bytes).sum();
    all + copied.map(PlannedResource::bytes).max().unwrap_or(0)
}

/// All resources that some frame has, in the order of plans; those of its techniques before the back.
fn declared(techniques: Vec<Resource>) -> impl Iterator<Item = Resource> {
    let shared = [
        front::RESOURCES,
        map::RESOURCES,
        kernel::RESOURCES,
        back::OCCLUSION,
        map::VIEW_RESOURCES,
        kernel::LIST_RESOURCES,
        map::SECTORS,
    ];
    let shared = shared.into_iter().flatten().copied();
    shared
        .chain(techniques)
        .chain(back::RESOURCES.iter().copied())
}

impl Plan {
    pub(super) fn list_resources(&mut self, inventory: &Inventory) {
        self.resources = self.resources_for(self.views_at_once, inventory);
    }

    /// The resources of a frame that makes the maps of so many views at once.
    pub(super) fn resources_for(
        &self,
        views_at_once: u32,
        inventory: &Inventory,
    ) -> Vec<PlannedResource> {
        let sizes = self.sizes(views_at_once, *inventory);
        let planned = |resource: Resource| PlannedResource {
            name: resource.name,
            shape: (resource.shape)(&sizes),
            copied: resource.copied,
        };
        declared(self.of_techniques()).map(planned).collect()
    }

    /// What the lights' techniques have for themselves, each once.
    fn of_techniques(&self) -> Vec<Resource> {
        let mut found: Vec<Resource> = Vec::new();
        for resource in self.sets().flat_map(|set| &set.recipe.resources) {
            if found.iter().all(|known| known.name != resource.name) {
                found.push(*resource);
            }
        }
        found
    }

    fn sizes(&self, views_at_once: u32, inventory: Inventory) -> Sizes {
        let most = |of: fn(&Recipe) -> u32| self.sets().map(|set| of(&set.recipe)).max();
        let entries = self.views().map(|view| view.table().len() as u64);
        let corners = (self.lights.iter()).map(|light| light.light.corner_count);
        Sizes {
            front: self.front,
            casters: self.casters,
            inventory,
            image: self.size,
            picture: self.outputs.picture,
            multisampled: self.multisampled,
            textured: self.textured,
            colored: self.colored,
            masked: self.masked,
            tells_casters: self.tells_casters,
            lights: self.lights.len() as u32,
            views: self.views().count() as u32,
            sector_entries: entries.sum(),
            corners: corners.sum(),
            map: self.map,
            bounds_bits: self.bounds_bits,
            levels: self.levels,
            density: self.density,
            views_at_once,
            looked_at_once: match self.needs(Recipe::side_by_side) {
                true => views_at_once,
                false => 1,
            },
            layers: most(|recipe| recipe.layers).unwrap_or(0),
            coarse_levels: most(|recipe| recipe.coarse_levels).unwrap_or(0),
            microrects: self.needs(|recipe| recipe.microrects),
            budgets_vary: self.budgets_vary(),
            budget_mapped: self.budgets_vary() && self.budget.mapped,
            kernels: self.needs(|recipe| recipe.kernels),
            windows: self.needs(|recipe| recipe.windows),
            joins: self.needs(|recipe| recipe.grids > 0),
            packet_lists: self.needs(|recipe| recipe.has(Domain::PacketList) && !recipe.windows),
            pixel_lists: self.needs(|recipe| recipe.has(Domain::PixelList)),
            packet: self.packet,
            rounds: self.rounds(),
            words: most(|recipe| recipe.words).unwrap_or(0),
        }
    }

    /// [byte] Name and size of each resource that the frame has.
    pub fn memory(&self) -> impl Iterator<Item = (&'static str, u64)> {
        let sizes = (self.resources.iter()).map(|resource| (resource.name, resource.bytes()));
        sizes.filter(|&(_, bytes)| bytes > 0)
    }

    /// What an image of that name is for, if there is one.
    pub(crate) fn image_kind(&self, name: &str) -> Option<ImageKind> {
        let found = self.resources.iter().find(|resource| resource.name == name);
        match found?.shape {
            Shape::Image { kind, .. } => Some(kind),
            Shape::Buffer(_) => None,
        }
    }

    /// [byte] Of all resources; they live as long as the frame.
    pub fn memory_bytes(&self) -> u64 {
        self.memory().map(|(_, bytes)| bytes).sum()
    }

    /// [byte] Of all resources and of the largest copy that goes to the device or comes back.
    pub fn peak_bytes(&self) -> u64 {
        peak_bytes(&self.resources)
    }

    pub(super) fn check(&self, limits: &Limits) -> Result<()> {
        let (width, height) = self.size;
        if width.max(height) > limits.image_side {
            return Err(Error::Unsupported(format!(
                "an image of {width}x{height} is more than the device's {} pixels a side; choose a smaller --size",
                limits.image_side
            )));
        }
        let adds = |kind| {
            matches!(
                kind,
                Shape::Image {
                    kind: ImageKind::Sums,
                    ..
                }
            )
        };
        if !limits.adds_floats && self.resources.iter().any(|resource| adds(resource.shape)) {
            return Err(Error::Unsupported(
                "the device cannot add up in 32-bit floats; choose --accumulate fp16".into(),
            ));
        }
        for resource in &self.resources {
            let (limit, what) = match resource.shape.is_image() {
                true => (limits.image_bytes, "image"),
                false => (limits.buffer_bytes, "buffer"),
            };
            let (name, bytes) = (resource.name, resource.bytes());
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
        let (peak, most) = (self.peak_bytes(), limits.bytes_max());
        if peak <= most {
            return Ok(());
        }
        let largest = self.memory().max_by_key(|&(_, bytes)| bytes);
        let (name, bytes) = largest.unwrap_or_default();
        let (source, raised) = match limits.allowed_bytes < limits.memory_bytes {
            true => ("--max-memory allows", ", or raise --max-memory"),
            false => ("the device has", ""),
        };
        let halved = match name == "hierarchy" && self.bounds_bits > 16 {
            true => ", or --mssm-bits 16",
            false => "",
        };
        let fewer = match self.views_at_once {
            1 => "",
            _ => ", or fewer --views-at-once",
        };
        Err(Error::Unsupported(format!(
            "the frame takes {} at its peak, {} of it for {name}, and {source} {}; \
             choose a smaller --map or --size{fewer}{halved}{raised}",
            human(peak),
            human(bytes),
            human(most),
        )))
    }
}
