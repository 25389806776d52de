//! What is to be done about a light: which parts of it have views, and what runs in them.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::Plan;
use super::survey::Survey;
use super::views::{self, Aspect, Site};
use crate::scene::AreaLight;
use crate::shared::{self, FRONT_REACH, SECTOR_STEPS, View};
use crate::shot::{Settings, Shot, Technique};
use crate::sub_light::{Part, evenly_spread};
use crate::technique::Recipe;

/// Tangent up to which the front face of a point's view holds receivers: 76 degrees. Its map is fitted to casters, so that
/// a wide one costs texels only where there are casters to the side.
const POINT_REACH: f32 = 4.0;

/// What is to be done about a light.
#[derive(Debug, Clone)]
pub struct LightPlan {
    pub name: String,
    pub light: shared::Light,
    pub outcome: Outcome,
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
    /// Part by part, each towards the same faces.
    pub views: Vec<ViewPlan>,
}

impl ViewSet {
    /// [degree] How far from the light's axis the front face holds receivers.
    pub(super) fn reach_degrees(&self) -> f64 {
        f64::from(reach(&self.settings)).atan().to_degrees()
    }
}

impl LightPlan {
    pub fn views(&self) -> impl Iterator<Item = &ViewPlan> {
        self.sets.iter().flat_map(|set| &set.views)
    }

    /// Whether several views add up.
    pub fn accumulates(&self) -> bool {
        self.views().count() > 1
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
    pub sectors: Option<Arc<[f32]>>,
    /// What the view was planned from.
    pub aspect: Aspect,
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

/// A light where it stands.
pub(super) struct Placed<'a> {
    pub light: &'a AreaLight,
    /// [scene units, world] What positions on the device are relative to.
    pub origin: DVec3,
    /// [scene units] See [`Shot::touch`].
    pub touch: f64,
    /// See [`views::intensity`].
    pub intensity: [f32; 3],
}

impl<'a> Placed<'a> {
    pub fn of_shot(shot: &Shot, light: &'a AreaLight) -> Self {
        Self {
            light,
            origin: shot.origin(),
            touch: shot.touch(light),
            intensity: views::intensity(shot, light),
        }
    }

    /// `settings`: as they run in the light's views.
    pub fn site(&self, settings: &Settings, levels: u32) -> Site {
        Site {
            origin: self.origin,
            map: settings.map,
            bias: settings.bias(),
            touch: self.touch,
            levels,
        }
    }
}

impl Plan {
    /// `parts`: of the light as it is cut by settings as they run for it; `found`: for each side that it shines to.
    pub(super) fn add_light(
        &mut self,
        settings: &Settings,
        placed: &Placed,
        parts: Vec<Part>,
        found: &[Survey],
    ) {
        let outcome = match (
            found.iter().any(|side| side.receivers),
            found.iter().any(|side| side.casters),
        ) {
            (false, _) => Outcome::Dark,
            (_, false) => Outcome::Unshadowed,
            _ => Outcome::Shadowed,
        };
        let settings = settings.of_light(placed.light);
        let (near, near_count): (&[bool], _) = match settings.has_near_points() {
            true => (&found[0].near, found[0].near_count()),
            false => (&[], 0),
        };
        let part_count = parts.len();
        let sampled = sampled(settings, parts, near, found[0].faces(POINT_REACH).len());
        let weight_sum = views::weight_sum(sampled.iter().flat_map(|(_, parts)| parts));
        let view_first = self.views().count() as u32;
        let sets = self.view_sets(placed, &sampled, found);
        let view_count: usize = sets.iter().map(|set| set.views.len()).sum();
        let view_range = view_first..view_first + view_count as u32;
        let light = placed.light;
        let name = match light.name.as_str() {
            "" => format!("light {}", self.lights.len()),
            name => name.to_owned(),
        };
        let intensity = placed.intensity;
        self.lights.push(LightPlan {
            name,
            light: views::whole_light(placed.origin, light, intensity, weight_sum, view_range),
            outcome,
            sets,
            part_count,
            near_count,
        });
    }

    fn view_sets<'s>(
        &self,
        placed: &Placed,
        sampled: &'s [(Settings, Vec<Part>)],
        found: &[Survey],
    ) -> Vec<ViewSet> {
        let tables = self.views().filter(|view| view.sectors.is_some()).count() as u32;
        let mut sector_first = tables * (SECTOR_STEPS + 1);
        // A side without casters has no shadow on it.
        let sides = found.iter().enumerate().filter(|(_, side)| side.casters);
        let sets: Vec<(&Settings, Vec<Aspect>)> = sides
            .flat_map(|(index, side)| {
                let aspects = move |(settings, parts): &'s (Settings, Vec<Part>)| {
                    (settings, aspects(settings, parts, side, index > 0))
                };
                sampled.iter().map(aspects)
            })
            .collect();
        let accumulate = sets.iter().map(|(_, aspects)| aspects.len()).sum::<usize>() > 1;
        let set = |(settings, aspects): (&Settings, Vec<Aspect>)| {
            let site = placed.site(settings, 0);
            let view = |aspect: Aspect| {
                let sectors = aspect.sectors();
                let mut view = aspect.view(&site, placed.light, 0);
                if let Some(table) = &sectors {
                    view.sector_first = sector_first;
                    sector_first += table.len() as u32;
                }
                ViewPlan {
                    view,
                    variant: Variant {
                        round: sectors.is_some(),
                        oblique: aspect.face != 0,
                        accumulate,
                    },
                    sectors,
                    aspect,
                }
            };
            ViewSet {
                views: aspects.into_iter().map(view).collect(),
                recipe: Recipe::new(settings),
                settings: settings.clone(),
            }
        };
        sets.into_iter().map(set).collect()
    }
}

/// Each of the parts, towards each face that may have receivers.
fn aspects(settings: &Settings, parts: &[Part], found: &Survey, turned: bool) -> Vec<Aspect> {
    let faces = found.faces(reach(settings));
    let reach = match faces.len() {
        1 => f32::MAX,
        _ => reach(settings),
    };
    let of_part = |part: &Part| {
        let aspect = |&face: &usize| Aspect {
            part: part.clone(),
            face,
            turned,
            reach,
        };
        faces.iter().map(aspect).collect::<Vec<_>>()
    };
    parts.iter().flat_map(of_part).collect()
}

/// Tangent up to which the front face of a view holds receivers; side faces hold the rest.
fn reach(settings: &Settings) -> f32 {
    match settings.technique {
        Technique::ReferenceMaps => POINT_REACH,
        _ => FRONT_REACH,
    }
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
    let count = f64::from(settings.near_points) / (faces as f64).sqrt();
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
