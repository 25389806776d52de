//! What is to be done about a light: which parts of it have views, and what runs in them.

use glam::{DVec2, DVec3};

use super::survey::LightCoverage;
use super::views::{self, MapParams, ViewPose};
use crate::scene::{AreaLight, Ball, Outline};
use crate::shared::{self, View};
use crate::shot::Shot;
use crate::sub_light::{Cut, Part, evenly_spread};
use crate::technique::{POINT_REACH, Recipe, Settings};

/// What is to be done about a light.
#[derive(Debug, Clone)]
pub struct LightPlan {
    pub name: String,
    pub light: shared::Light,
    /// What it was planned with.
    pub outline: Outline,
    pub lighting: Lighting,
    /// None without views.
    pub sets: Vec<ViewSet>,
    /// [sub-light] In how many parts the light is cut, and how many of them points stand for.
    pub part_count: usize,
    pub near_count: usize,
}

/// Views of a light that run the same.
#[derive(Debug, Clone)]
pub struct ViewSet {
    /// As they run in its views.
    pub settings: Settings,
    pub recipe: Recipe,
    /// [view] The number of its first.
    pub view_first: u32,
    /// Part by part, each towards the same faces.
    pub views: Vec<ViewPlan>,
}

impl ViewSet {
    /// [degree] How far from the light's axis the front face holds receivers.
    pub(super) fn reach_degrees(&self) -> f64 {
        f64::from(self.settings.technique.method().reach())
            .atan()
            .to_degrees()
    }
}

impl LightPlan {
    pub fn views(&self) -> impl Iterator<Item = &ViewPlan> {
        self.sets.iter().flat_map(|set| &set.views)
    }

    /// Whether views add to what is cleared before the first of them: several, or one that looks only where there is
    /// something to add.
    pub fn accumulates(&self) -> bool {
        self.views().count() > 1 || self.sets.iter().any(|set| set.recipe.kernels)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lighting {
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
    /// What the view was planned from.
    pub pose: ViewPose,
    /// The map is not parallel to the light.
    pub oblique: bool,
}

impl ViewPlan {
    /// What cuts the sub-light out of its cell.
    pub fn cut(&self) -> &Cut {
        self.pose.part.cut_by()
    }

    /// See [`Part::table`].
    pub fn table(&self) -> &[f32] {
        self.pose.part.table()
    }
}

/// A light where it stands.
pub(super) struct Placed<'a> {
    pub light: &'a AreaLight,
    /// [scene units, world] What positions on the device are relative to.
    pub origin: DVec3,
    /// [scene units] See [`Shot::touch`].
    pub touch: f64,
    /// See [`views::intensity`].
    pub intensity: [f32; 3],
    /// Around the scene.
    pub ball: Ball,
}

impl<'a> Placed<'a> {
    pub fn of_shot(shot: &Shot, light: &'a AreaLight) -> Self {
        Self {
            light,
            origin: shot.origin(),
            touch: shot.touch(light),
            intensity: views::intensity(shot, light),
            ball: Ball::around(shot.scene.bounds()),
        }
    }

    /// `settings`: as they run in the light's views.
    pub fn map_params(&self, settings: &Settings, levels: u32) -> MapParams {
        MapParams {
            origin: self.origin,
            map: settings.map,
            bias: settings.bias(),
            touch: self.touch,
            levels,
            ball: self.ball,
        }
    }
}

/// A light before it is known how large the maps and hierarchies of all lights are.
pub(super) struct Draft<'a> {
    placed: Placed<'a>,
    lighting: Lighting,
    sets: Vec<DraftSet>,
    part_count: usize,
    near_count: usize,
    /// See [`views::weight_sum`].
    weight_sum: f32,
}

/// Views that run the same, before they have maps.
pub(super) struct DraftSet {
    settings: Settings,
    pub recipe: Recipe,
    poses: Vec<ViewPose>,
}

/// What has been given away to the lights before.
#[derive(Default)]
pub(super) struct Numbering {
    views: u32,
    /// [entry] Of the sector tables.
    sectors: u32,
    /// [corner] Of polygons.
    corners: u32,
}

impl<'a> Draft<'a> {
    /// `parts`: of the light as it is cut by settings as they run for it; `found`: for each side that it shines to.
    pub fn new(
        settings: &Settings,
        placed: Placed<'a>,
        parts: Vec<Part>,
        found: &[LightCoverage],
    ) -> Self {
        let lighting = match (
            found.iter().any(|side| side.receivers),
            found.iter().any(|side| side.casters),
        ) {
            (false, _) => Lighting::Dark,
            (_, false) => Lighting::Unshadowed,
            _ => Lighting::Shadowed,
        };
        let settings = settings.of_light(placed.light);
        let part_count = parts.len();
        let is_near = |part: usize| {
            let near = |side: &LightCoverage| side.near.get(part).copied().unwrap_or(false);
            settings.has_near_points() && found.iter().any(near)
        };
        let near: Vec<bool> = (0..part_count).map(is_near).collect();
        let near_count = near.iter().filter(|near| **near).count();
        let sides = found.iter().filter(|side| side.casters);
        let faces: usize = sides.map(|side| side.faces(POINT_REACH).len()).sum();
        let sampled = sampled(settings, parts, &near, faces);
        Self {
            placed,
            lighting,
            sets: draft_sets(&sampled, found),
            part_count,
            near_count,
            weight_sum: views::weight_sum(sampled.iter().flat_map(|(_, parts)| parts)),
        }
    }

    /// None without views.
    pub fn sets(&self) -> &[DraftSet] {
        &self.sets
    }

    /// The light with all its views. `levels`: see [`Plan::levels`](super::Plan).
    pub fn finish(self, index: usize, levels: u32, numbering: &mut Numbering) -> LightPlan {
        let (placed, view_first) = (self.placed, numbering.views);
        let set = |set: DraftSet| {
            let params = placed.map_params(&set.settings, levels);
            let first = numbering.views;
            let view = |pose: ViewPose| {
                let view = pose.view(&params, placed.light, numbering.sectors);
                numbering.views += 1;
                numbering.sectors += pose.part.table().len() as u32;
                ViewPlan {
                    view,
                    oblique: pose.face != 0,
                    pose,
                }
            };
            ViewSet {
                view_first: first,
                views: set.poses.into_iter().map(view).collect(),
                recipe: set.recipe,
                settings: set.settings,
            }
        };
        let sets = self.sets.into_iter().map(set).collect();
        let light = placed.light;
        let name = match light.name.as_str() {
            "" => format!("light {index}"),
            name => name.to_owned(),
        };
        let views = view_first..numbering.views;
        let (outline, corner_first) = (light.outline(), numbering.corners);
        numbering.corners += outline.corners().len() as u32;
        LightPlan {
            name,
            light: views::whole_light(
                placed.origin,
                light,
                placed.intensity,
                self.weight_sum,
                views,
                corner_first,
            ),
            outline,
            lighting: self.lighting,
            sets,
            part_count: self.part_count,
            near_count: self.near_count,
        }
    }
}

fn draft_sets(sampled: &[(Settings, Vec<Part>)], found: &[LightCoverage]) -> Vec<DraftSet> {
    // A side without casters has no shadow on it.
    let sides = found.iter().enumerate().filter(|(_, side)| side.casters);
    let set = |(index, side): (usize, &LightCoverage)| {
        let set = move |(settings, parts): &(Settings, Vec<Part>)| DraftSet {
            settings: settings.clone(),
            recipe: Recipe::new(settings),
            poses: poses(settings, parts, side, index),
        };
        sampled.iter().map(set).collect::<Vec<_>>()
    };
    sides.flat_map(set).collect()
}

/// Each of the parts, towards each face that may have receivers.
fn poses(
    settings: &Settings,
    parts: &[Part],
    found: &LightCoverage,
    index: usize,
) -> Vec<ViewPose> {
    let reach = settings.technique.method().reach();
    let faces = found.faces(reach);
    let reach = match faces.len() {
        1 => f32::MAX,
        _ => reach,
    };
    let of_part = |part: &Part| {
        let pose = |&face: &usize| ViewPose {
            part: part.clone(),
            face,
            side: index,
            reach,
        };
        faces.iter().map(pose).collect::<Vec<_>>()
    };
    parts.iter().flat_map(of_part).collect()
}

/// The parts of a light with the settings that run in their views. Where an occluder is nearer to a part than the part is
/// wide (`near`), its points differ too much in what they see for the middle to stand for them, however it is integrated:
/// points with hard shadows take its place. Where these have several faces, time and error share what that costs.
fn sampled(
    settings: Settings,
    parts: Vec<Part>,
    near: &[bool],
    faces: usize,
) -> Vec<(Settings, Vec<Part>)> {
    let count = f64::from(settings.near_points) / (faces.max(1) as f64).sqrt();
    let on_light: Vec<DVec2> = evenly_spread(count.ceil() as u32).collect();
    let is_near = |index: usize| near.get(index).copied().unwrap_or(false);
    let (mut whole, mut points) = (Vec::new(), Vec::new());
    for (index, part) in parts.into_iter().enumerate() {
        match is_near(index) {
            true => points.extend(part.points(&on_light)),
            false => whole.push(part),
        }
    }
    let of_points = settings.of_points();
    let mut sampled = vec![(settings, whole), (of_points, points)];
    sampled.retain(|(_, parts)| !parts.is_empty());
    sampled
}
