//! Plans for a host's frames, of which only the shape is known beforehand: what stands where comes with each frame.

use glam::DVec3;

use super::light::{Draft, Placed};
use super::survey::LightCoverage;
use super::views::whole_light;
use super::{Budget, Outputs, Plan};
use crate::error::{Error, Result};
use crate::frame::{Casters, Front, Inventory, Surface};
use crate::gpu::Limits;
use crate::scene::{AreaLight, Ball, Spread};
use crate::shared;
use crate::shot::MAX_SIZE;
use crate::technique::Settings;
use crate::technique::{self, Recipe};

/// What a host's frames have in common.
#[derive(Debug, Clone)]
pub struct HostFrame {
    /// [pixel]
    pub size: (u32, u32),
    pub surface: Surface,
    /// Its shape counts, and whether it has extent; where it stands comes with each frame.
    pub light: AreaLight,
    pub settings: Settings,
    pub casters: Casters,
    /// Views along the light's plane as well, for receivers beyond 60° of its axis.
    pub side_faces: bool,
    /// [element] Most of the host's meshes in a frame, and of what they hold.
    pub instances: u32,
    pub vertices: u32,
    pub triangles: u32,
}

impl HostFrame {
    fn validate(&self) -> Result<()> {
        let size = 1..=MAX_SIZE;
        if !size.contains(&self.size.0) || !size.contains(&self.size.1) {
            return Err(Error::Invalid(format!(
                "an image is 1 to {MAX_SIZE} pixels wide and high, not {}x{}",
                self.size.0, self.size.1
            )));
        }
        self.light.validate()?;
        if matches!(self.light.spread(), Spread::Sun | Spread::Sphere) {
            return Err(Error::Unsupported(
                "an effect takes rectangles, discs, polygons and points; a renderer takes suns and spheres as well".into(),
            ));
        }
        self.settings.validate()?;
        let most = u32::MAX / 3;
        if self.vertices > most || self.triangles > most || self.instances > most {
            return Err(Error::Invalid(format!(
                "meshes, vertices and triangles are at most {most} each"
            )));
        }
        if self.settings.multisample > 1 {
            return Err(Error::Unsupported(
                "a host's surface has the samples that the host gives it; leave multisample at 1"
                    .into(),
            ));
        }
        let redrawn = Recipe::new(&self.settings.of_light(&self.light)).redraws();
        if redrawn && !self.casters.are_triangles() {
            return Err(Error::Unsupported(format!(
                "{} with these settings needs geometry that the library draws; give meshes, or choose a single layer or \
                 another technique",
                self.settings.technique
            )));
        }
        if self.side_faces && self.casters == Casters::Maps {
            return Err(Error::Unsupported(
                "shadow maps of the host look along the light; leave the side faces out".into(),
            ));
        }
        Ok(())
    }
}

/// Plans a host's frames.
///
/// # Errors
/// Something makes no sense, or exceeds the device's limits.
pub fn plan_for_host(host: &HostFrame, limits: &Limits) -> Result<Plan> {
    host.validate()?;
    let settings = &host.settings;
    let frame = shared::Frame {
        size: [host.size.0, host.size.1],
        ..Default::default()
    };
    let outputs = Outputs { picture: false };
    let mut plan = Plan {
        front: Front::Imported(host.surface),
        casters: host.casters,
        // A host's surface has no colour.
        budget: Budget {
            masking: 1.0,
            ..Budget::new(settings)
        },
        ..Plan::empty(host.size, frame, outputs, settings, limits)
    };
    let found = LightCoverage {
        receivers: true,
        receiver_bounds: (DVec3::NEG_INFINITY, DVec3::INFINITY),
        casters: true,
        tangents: [if host.side_faces { f64::INFINITY } else { 0.0 }; 4],
        near: Vec::new(),
        touching: false,
    };
    let parts = technique::parts(&host.light, &settings.of_light(&host.light));
    let found = vec![found; host.light.side_count()];
    let draft = Draft::new(settings, placed(&host.light), parts, &found);
    let inventory = Inventory {
        vertices: host.vertices.into(),
        triangles: host.triangles.into(),
        instances: host.instances.into(),
        ..Inventory::default()
    };
    plan.add_lights(vec![draft], settings, &inventory, limits)?;
    if host.casters == Casters::Maps {
        // A host's map may be turned any way.
        plan.views_mut().for_each(|view| view.oblique = true);
    }
    plan.list_resources(&inventory);
    plan.check(limits)?;
    Ok(plan)
}

/// A host's scene is not known.
const NOWHERE: Ball = Ball {
    center: DVec3::ZERO,
    radius: 1.0,
};

/// A light among a host's positions, which are relative to whatever origin it has chosen.
fn placed(light: &AreaLight) -> Placed<'_> {
    Placed {
        light,
        origin: DVec3::ZERO,
        touch: light.touch(light.center.abs().max_element()),
        intensity: [0.0; 3],
        ball: NOWHERE,
    }
}

impl Plan {
    /// Moves the light of a host's frame, and its views, to where they stand now. Does not allocate.
    ///
    /// # Errors
    /// The light is of another shape than the one that was planned.
    pub fn place(&mut self, light: &AreaLight) -> Result<()> {
        let placed = placed(light);
        for planned in &mut self.lights {
            let spread = light.spread() as u32;
            let recipe_changes = light.is_point() != (planned.light.half_size == [0.0; 2])
                || spread != planned.light.spread;
            if recipe_changes || !light.outline().is_like(&planned.outline) {
                return Err(Error::Invalid(
                    "the light has another shape than the one that the effect was made for".into(),
                ));
            }
            let views =
                planned.light.view_first..planned.light.view_first + planned.light.view_count;
            let (weight_sum, corner_first) = (planned.light.weight_sum, planned.light.corner_first);
            planned.light = whole_light(
                placed.origin,
                light,
                placed.intensity,
                weight_sum,
                views,
                corner_first,
            );
            for set in &mut planned.sets {
                let params = placed.map_params(&set.settings, self.levels);
                for view in &mut set.views {
                    let sector_first = view.view.sector_first;
                    view.view = view.pose.view(&params, light, sector_first);
                }
            }
        }
        Ok(())
    }
}
