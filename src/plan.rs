//! What will run, in which sizes, and what is left out and why: a pure function of the shot, of what is
//! asked for and of the device's limits. What is recorded equals what is planned.

mod camera;
mod survey;
mod text;

use glam::{DVec2, DVec3};

use crate::error::{Error, Result};
use crate::gpu::Limits;
use crate::scene::{AreaLight, LightShape};
use crate::shared::{
    self, FRONT_REACH, Fit, Kernel, LEVELS_MAX, Lists, Packet, SECTOR_STEPS, View,
};
use crate::shot::Shot;
use crate::sub_light::{SubLight, sub_lights};
use crate::technique::{Recipe, Work};
use camera::Frustum;
use survey::{Survey, survey};

/// What the caller wants to have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outputs {
    /// The shaded picture.
    pub picture: bool,
}

/// A frame, completely.
#[derive(Debug, Clone)]
pub struct Plan {
    /// [pixel]
    pub size: (u32, u32),
    pub frame: shared::Frame,
    pub lights: Vec<LightPlan>,
    pub outputs: Outputs,
    /// [level] MSSM levels that there is memory for; 0 = no MSSM.
    pub levels: u32,
    /// [texel] Side of the shadow map; 0 = no view needs one.
    pub map: u32,
    /// [pixel] Width and height of a packet.
    pub packet: (u32, u32),
    /// The scene has textures that the frame needs.
    pub textured: bool,
    /// The scene has alpha-masked triangles.
    pub masked: bool,
    /// Names of the passes with the number of times each is recorded, in the order of first recording.
    pub passes: Vec<(&'static str, u32)>,
    /// [byte] Name and size of each resource.
    pub resources: Vec<(&'static str, u64)>,
    /// What is left out, and why.
    pub omissions: Vec<Omission>,
}

/// Something that a scene of another kind would need.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Omission {
    pub what: String,
    pub reason: String,
}

/// What is to be done about a light.
#[derive(Debug, Clone)]
pub struct LightPlan {
    pub name: String,
    pub light: shared::Light,
    pub outcome: Outcome,
    pub views: Vec<ViewPlan>,
    /// [sub-light] In how many parts the light is cut.
    pub part_count: usize,
    /// What runs in each of its views.
    pub recipe: Recipe,
}

impl LightPlan {
    /// Whether its views need something of their recipe.
    fn needs(&self, test: impl Fn(&Recipe) -> bool) -> bool {
        !self.views.is_empty() && test(&self.recipe)
    }

    /// Whether several views add up.
    pub fn accumulates(&self) -> bool {
        self.views.len() > 1
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Nothing visible is lit by it: visibility 0.
    Dark,
    /// Nothing can cast a shadow: visibility 1 where it shines.
    Unshadowed,
    /// Its views decide.
    Shadowed,
}

/// One face of one sub-light.
#[derive(Debug, Clone)]
pub struct ViewPlan {
    pub view: View,
    pub variant: Variant,
    /// Sector table of a sub-light that a disc's rim cuts.
    pub sectors: Option<Vec<f32>>,
}

/// Which pipelines a view needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Variant {
    /// A disc's rim cuts the sub-light.
    pub round: bool,
    /// The map is not parallel to the light.
    pub oblique: bool,
    /// The light has more than one view.
    pub accumulate: bool,
}

/// Plans a frame.
///
/// `retained`: the shadow map of the last frame's last view is still there and nothing that it depends on has
/// changed since: scene, camera, lights, map size and bias.
///
/// # Errors
/// The shot makes no sense, or exceeds the device's limits; the message says which knob to turn.
pub fn plan(shot: &Shot, outputs: Outputs, limits: &Limits, retained: bool) -> Result<Plan> {
    shot.validate()?;
    let frustum = Frustum::new(shot);
    let mut plan = Plan {
        size: (shot.width, shot.height),
        frame: frustum.frame(shot),
        lights: Vec::new(),
        outputs,
        levels: 0,
        map: 0,
        packet: shot.settings.packet,
        textured: !shot.scene.textures.is_empty() && (outputs.picture || shot.scene.has_masked()),
        masked: shot.scene.has_masked(),
        passes: Vec::new(),
        resources: Vec::new(),
        omissions: Vec::new(),
    };
    for light in &shot.lights {
        let found = survey(&shot.scene, &frustum, light);
        plan.add_light(shot, light, found);
    }
    plan.size_map(shot, limits)?;
    let retained = retained && plan.views().count() == 1;
    plan.list_passes(retained);
    plan.list_resources(shot);
    plan.list_omissions(shot, retained);
    plan.check(limits)?;
    Ok(plan)
}

impl Plan {
    pub fn views(&self) -> impl Iterator<Item = &ViewPlan> {
        self.lights.iter().flat_map(|light| &light.views)
    }

    fn add_light(&mut self, shot: &Shot, light: &AreaLight, found: Survey) {
        let outcome = match found {
            Survey {
                receivers: false, ..
            } => Outcome::Dark,
            Survey { casters: false, .. } => Outcome::Unshadowed,
            _ => Outcome::Shadowed,
        };
        let parts = sub_lights(light, shot.settings.split);
        let faces: Vec<usize> = (0..5).filter(|&face| found.faces[face]).collect();
        let view_first = self.views().count() as u32;
        let mut views = Vec::new();
        if outcome == Outcome::Shadowed {
            let accumulate = parts.len() * faces.len() > 1;
            for part in &parts {
                views.extend(
                    faces
                        .iter()
                        .map(|&face| view_plan(shot, light, part, face, &faces, accumulate)),
                );
            }
        }
        let name = if light.name.is_empty() {
            format!("light {}", self.lights.len())
        } else {
            light.name.clone()
        };
        self.lights.push(LightPlan {
            name,
            light: whole_light(shot, light, &parts, view_first, views.len() as u32),
            outcome,
            views,
            part_count: parts.len(),
            recipe: Recipe::new(&shot.settings, light.is_point()),
        });
    }

    fn size_map(&mut self, shot: &Shot, limits: &Limits) -> Result<()> {
        if self.views().next().is_none() {
            return Ok(());
        }
        let side = shot.settings.map;
        if side > limits.image_side {
            return Err(Error::Unsupported(format!(
                "a map of {side} texels is more than the device's {}; choose a smaller --map",
                limits.image_side
            )));
        }
        self.map = side;
        if self
            .lights
            .iter()
            .any(|light| light.needs(|recipe| recipe.mssm))
        {
            let wanted = (side - 1).ilog2() + 2;
            let level_bytes = u64::from(side) * u64::from(side) * 8;
            let fitting = (limits.image_bytes / level_bytes).min(limits.image_layers.into());
            self.levels = wanted.min(LEVELS_MAX).min(fitting as u32);
            if self.levels == 0 {
                return Err(Error::Unsupported(format!(
                    "an MSSM level of {level_bytes} bytes is more than the device's largest image of {} bytes; \
                     choose a smaller --map",
                    limits.image_bytes
                )));
            }
        }
        let levels = self.levels;
        for view in self.lights.iter_mut().flat_map(|light| &mut light.views) {
            view.view.levels_max = levels.max(1);
        }
        Ok(())
    }

    fn list_passes(&mut self, retained: bool) {
        let mut passes = Vec::new();
        let mut add = |name, count| {
            if count > 0 {
                match passes.iter_mut().find(|(known, _)| *known == name) {
                    Some((_, known)) => *known += count,
                    None => passes.push((name, count)),
                }
            }
        };
        add("gbuffer", 1);
        if self.views().next().is_some() {
            add("clear_fits", u32::from(!retained));
            add("clear_lists", 1);
        }
        for light in &self.lights {
            let count = light.views.len() as u32;
            add("clear_occlusion", u32::from(light.accumulates()));
            for (name, times) in self.view_passes(light, retained) {
                add(name, count * times);
            }
            add("resolve", 1);
        }
        add("shade", u32::from(self.outputs.picture));
        self.passes = passes;
    }

    /// What is recorded for each view of a light, in this order, and how often.
    fn view_passes(&self, light: &LightPlan, retained: bool) -> Vec<(&'static str, u32)> {
        let mut passes = Vec::new();
        if !retained {
            passes.extend(["receivers", "casters", "fit", "shadow_map"].map(|name| (name, 1)));
            if light.recipe.mssm {
                passes.push(("mssm", self.levels));
            }
        }
        passes.extend(light.recipe.stages.iter().map(|stage| (stage.name, 1)));
        passes
    }

    fn list_resources(&mut self, shot: &Shot) {
        let scene = &shot.scene;
        let pixels = u64::from(self.size.0) * u64::from(self.size.1);
        let map = u64::from(self.map) * u64::from(self.map);
        let views = self.views().count() as u64;
        let tables = self.views().filter(|view| view.sectors.is_some()).count() as u64;
        let any = |test: fn(&Recipe) -> bool| self.lights.iter().any(|light| light.needs(test));
        let triangles = scene.triangles.len() as u64;
        let textured = u64::from(self.textured);
        let per_pixel = |needed: bool, bytes: usize| if needed { pixels * bytes as u64 } else { 0 };
        let texels: usize = scene
            .textures
            .iter()
            .map(|texture| texture.rgba.len())
            .sum();
        let grid = u64::from(self.size.0.div_ceil(shot.settings.packet.0))
            * u64::from(self.size.1.div_ceil(shot.settings.packet.1));
        self.resources = vec![
            ("positions", scene.positions.len() as u64 * 12),
            ("triangles", triangles * 12),
            ("triangle_surfaces", triangles * 4),
            (
                "surfaces",
                scene.materials.len() as u64 * size_of::<shared::Surface>() as u64,
            ),
            ("texcoords", textured * scene.texcoords.len() as u64 * 8),
            (
                "vertex_surfaces",
                if self.masked {
                    scene.positions.len() as u64 * 4
                } else {
                    0
                },
            ),
            ("texels", textured * texels as u64),
            ("camera_depth", pixels * 4),
            ("position_world", pixels * 16),
            ("normal_world", pixels * 16),
            ("albedo", pixels * 4),
            ("caster_indices", if views > 0 { triangles * 12 } else { 0 }),
            ("shadow_map", map * 4),
            ("mssm", map * 8 * u64::from(self.levels)),
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
            ("lists", views * size_of::<Lists>() as u64),
            ("sectors", tables * u64::from(SECTOR_STEPS + 1) * 4),
            ("visibility", pixels * 4 * self.lights.len() as u64),
            ("picture", per_pixel(self.outputs.picture, 4)),
        ];
        self.resources.retain(|&(_, bytes)| bytes > 0);
    }

    /// Whether the last frame's shadow map is kept.
    pub fn is_retained(&self) -> bool {
        self.views().next().is_some() && !self.passes.iter().any(|(name, _)| *name == "shadow_map")
    }

    /// [byte] Of all resources; they live as long as the frame, so this is the peak.
    pub fn memory_bytes(&self) -> u64 {
        self.resources.iter().map(|&(_, bytes)| bytes).sum()
    }

    fn check(&self, limits: &Limits) -> Result<()> {
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
        if self.memory_bytes() > limits.memory_bytes {
            return Err(Error::Unsupported(format!(
                "the frame takes {} bytes and the device has {}; choose a smaller --map or --size",
                self.memory_bytes(),
                limits.memory_bytes
            )));
        }
        Ok(())
    }

    fn omit(&mut self, what: impl Into<String>, reason: impl Into<String>) {
        self.omissions.push(Omission {
            what: what.into(),
            reason: reason.into(),
        });
    }

    fn list_omissions(&mut self, shot: &Shot, retained: bool) {
        if !self.masked {
            self.omit(
                "fragment shader of the shadow maps",
                "no material is alpha-masked",
            );
        }
        if !self.textured {
            let reason = if shot.scene.textures.is_empty() {
                "no material has a texture"
            } else {
                "only visibility is asked for"
            };
            self.omit("textures and texture coordinates", reason);
        }
        if !self.outputs.picture {
            self.omit("shade", "only visibility is asked for");
        }
        if retained {
            self.omit(
                "receivers, casters, fit, shadow_map, mssm",
                "nothing that the view depends on has changed since the last frame",
            );
        }
        for index in 0..self.lights.len() {
            self.omit_of_light(shot, index);
        }
    }

    fn omit_of_light(&mut self, shot: &Shot, index: usize) {
        let planned = &self.lights[index];
        let name = planned.name.clone();
        match planned.outcome {
            Outcome::Dark => {
                return self.omit(
                    format!("{name}: everything"),
                    "no visible surface faces it: visibility 0",
                );
            }
            Outcome::Unshadowed => {
                return self.omit(
                    format!("{name}: shadow maps"),
                    "nothing can cast a shadow on what is visible: visibility 1",
                );
            }
            Outcome::Shadowed => {}
        }
        let one_view = planned.views.len() == 1;
        let faces = planned.views.len() / planned.part_count.max(1);
        let parts = planned.part_count as u32;
        let recipe = planned.recipe.clone();
        if shot.lights[index].is_point() {
            self.omit(
                format!("{name}: mssm, kernels, packets"),
                "the light has no extent: its shadow is hard",
            );
        }
        if one_view {
            self.omit(format!("{name}: accumulation"), "it has a single view");
        }
        if faces == 1 {
            self.omit(
                format!("{name}: side faces"),
                "every receiver lies within 60° of the light's axis",
            );
        }
        let cells = shot.settings.split * shot.settings.split;
        if parts < cells && !shot.lights[index].is_point() {
            self.omit(
                format!("{name}: {} sub-lights", cells - parts),
                "the disc's rim leaves nothing of them",
            );
        }
        if recipe.has(Work::PixelList) && !recipe.has(Work::PacketList) {
            self.omit(
                format!("{name}: packet_visibility"),
                "a packet is a single pixel",
            );
        }
        let wanted = (self.map.max(2) - 1).ilog2() + 2;
        if recipe.mssm && self.levels < wanted {
            self.omit(
                format!("{name}: mssm levels {} to {}", self.levels, wanted - 1),
                "the device's largest image does not hold them; larger kernels start from several nodes",
            );
        }
    }
}

fn view_plan(
    shot: &Shot,
    light: &AreaLight,
    part: &SubLight,
    face: usize,
    faces: &[usize],
    accumulate: bool,
) -> ViewPlan {
    let (u, v, n) = light.frame();
    // right × up = forward.
    let [right, up, forward] = match face {
        0 => [u, v, n],
        1 => [v, n, u],
        2 => [n, v, -u],
        3 => [n, u, v],
        _ => [u, n, -v],
    };
    let array = |vector: DVec3| -> [f32; 3] { vector.as_vec3().into() };
    let rim = part.rim.map_or([0.0; 3], |(center, radius)| {
        [center.x as f32, center.y as f32, radius as f32]
    });
    // A light without extent is a point in the middle of half sizes that can be divided by.
    let (half, (lower, upper)) = if light.is_point() {
        (DVec2::ONE, (DVec2::ZERO, DVec2::ZERO))
    } else {
        (part.half_size, part.extent)
    };
    let sectors = part.rim.map(|_| part.sectors());
    let area = sectors
        .as_ref()
        .map_or(part.area as f32, |table| table[SECTOR_STEPS as usize]);
    let view = View {
        center: array(part.center - shot.scene.origin),
        right: array(right),
        up: array(up),
        forward: array(forward),
        light_u: array(u / half.x),
        light_v: array(v / half.y),
        light_n: array(n),
        half_size: half.as_vec2().into(),
        extent: [
            lower.x as f32,
            lower.y as f32,
            upper.x as f32,
            upper.y as f32,
        ],
        rim,
        area,
        weight: area,
        sector_first: 0,
        face: face as u32,
        reach: if faces == [0] { f32::MAX } else { FRONT_REACH },
        map_size: shot.settings.map,
        bias: shot.settings.bias,
        levels_max: 0,
    };
    ViewPlan {
        view,
        variant: Variant {
            round: part.rim.is_some(),
            oblique: face != 0,
            accumulate,
        },
        sectors,
    }
}

fn whole_light(
    shot: &Shot,
    light: &AreaLight,
    parts: &[SubLight],
    view_first: u32,
    view_count: u32,
) -> shared::Light {
    let (u, v, n) = light.frame();
    let half = light.half_size();
    let weight = |part: &SubLight| {
        part.rim
            .map_or(part.area as f32, |_| part.sectors()[SECTOR_STEPS as usize])
    };
    shared::Light {
        center: (light.center - shot.scene.origin).as_vec3().into(),
        u: u.as_vec3().into(),
        v: v.as_vec3().into(),
        n: n.as_vec3().into(),
        half_size: [half.0 as f32, half.1 as f32],
        round: u32::from(matches!(light.shape, LightShape::Disc { .. })),
        // In the order in which the views add up, so that a fully hidden light is exactly so.
        weight_sum: parts
            .iter()
            .map(weight)
            .fold(0.0, |sum, weight| sum + weight),
        radiance: radiance(shot, light),
        view_first,
        view_count,
    }
}

/// Linear RGB radiance; unless it is given, such that a white surface at the camera's target that faces the
/// light's centre has radiance 1 from that light. For a light without extent: radiant intensity.
fn radiance(shot: &Shot, light: &AreaLight) -> [f32; 3] {
    let way = shot.camera.target - light.center;
    let square = way.length_squared().max(f64::MIN_POSITIVE);
    let (_, _, normal) = light.frame();
    // The solid angle of a light that is small against its distance, or at most the hemisphere's share.
    let share = if light.is_point() {
        1.0 / square
    } else {
        (light.area() * normal.dot(way.normalize_or(normal)).abs().max(0.1)
            / square
            / std::f64::consts::PI)
            .min(1.0)
    };
    let intensity = light.intensity.unwrap_or((1.0 / share) as f32);
    (light.color * intensity).into()
}
