//! What will not be as it was asked for, a sentence each.

use glam::DVec2;

use super::light::Placed;
use super::patches::{Occluders, fraction_bits};
use super::survey::{self, LightCoverage};
use super::{LightPlan, Lighting, Plan};
use crate::scene::{AreaLight, Ball, Spread};
use crate::shared::BIAS_ROUNDING;
use crate::shot::Shot;
use crate::technique::Settings;

/// [share of the way from eye to target] A rounding of depths that is seen.
const SEEN: f64 = 1e-3;

/// [point] On a light: with as many, slats in most directions err by less than 0.02.
const FEW_POINTS: usize = 200;

/// Rounding of a depth, in steps of the bias for it: the depth itself, and the coordinates that it is found from.
const ROUNDINGS: f64 = 3.0;

impl Plan {
    /// Notes on all lights; `found`: on each side of each.
    pub(super) fn note_lights(&mut self, shot: &Shot, found: &[Vec<LightCoverage>]) {
        let lights = shot.lights.iter().zip(&self.lights).zip(found);
        let notes = lights.flat_map(|((light, planned), found)| notes(shot, light, planned, found));
        self.notes.extend(notes.collect::<Vec<_>>());
        if shot.budget_map.is_some() && !self.budgets_vary() {
            let reason = match shot.settings.budget {
                None => "there is no --budget".to_owned(),
                Some(_) => format!("{} does not read --budget", shot.settings.technique),
            };
            (self.notes).push(format!("The budget map is ignored, for {reason}."));
        }
    }
}

/// Notes on a light.
fn notes(
    shot: &Shot,
    light: &AreaLight,
    planned: &LightPlan,
    found: &[LightCoverage],
) -> Vec<String> {
    let (settings, placed) = (shot.settings.of_light(light), Placed::of_shot(shot, light));
    let placed = &placed;
    let notes = [
        lights_nothing(planned),
        integrates_near_occluders(planned, &settings, found),
        has_few_points(planned),
        touches(planned, placed, found),
        is_far(planned, shot, placed),
        loses_shares(planned, shot, light, &settings, found),
    ];
    notes.into_iter().flatten().collect()
}

/// Where a light shines to, for people.
pub fn shines_along(planned: &LightPlan) -> String {
    if planned.light.spread == Spread::Sphere as u32 {
        return "it shines to all sides".into();
    }
    let [x, y, z] = planned.light.n;
    format!("it shines along ({x:.3}, {y:.3}, {z:.3})")
}

fn lights_nothing(planned: &LightPlan) -> Option<String> {
    let name = &planned.name;
    (planned.lighting == Lighting::Dark).then(|| {
        format!(
            "{name} lights nothing that the camera sees: {}; if that is the wrong way, swap its u and v or turn its normal.",
            shines_along(planned)
        )
    })
}

fn integrates_near_occluders(
    planned: &LightPlan,
    settings: &Settings,
    found: &[LightCoverage],
) -> Option<String> {
    let near: usize = found.iter().map(LightCoverage::near_count).sum();
    let integrated = planned.sets.iter().any(|set| set.settings == *settings);
    let (name, technique) = (&planned.name, settings.technique);
    (near > 0 && integrated && !settings.has_near_points() && !settings.samples_points()).then(|| {
        format!(
            "An occluder is nearer to {name} than its sub-lights are wide ({near} of {}), where {technique} errs; \
             packet-contour with --near-points does not.",
            planned.part_count
        )
    })
}

fn has_few_points(planned: &LightPlan) -> Option<String> {
    let points = (planned.sets.iter())
        .filter(|_| planned.near_count > 0)
        .find(|set| set.settings.samples_points())?;
    let front = points.views.iter().filter(|view| view.view.face == 0);
    let (count, name) = (front.count(), &planned.name);
    let on_light = count * planned.part_count / planned.near_count;
    (on_light < FEW_POINTS).then(|| {
        format!(
            "An occluder is so near to {name} that {on_light} points on it cast shadows, which may err by more than 0.02; \
             raise --near-points for more.",
        )
    })
}

fn touches(planned: &LightPlan, placed: &Placed, found: &[LightCoverage]) -> Option<String> {
    let name = &planned.name;
    found.iter().any(|side| side.touching).then(|| {
        format!(
            "A surface less than {:.1e} before {name} is taken for the lamp's own and casts no shadow.",
            placed.touch
        )
    })
}

fn is_far(planned: &LightPlan, shot: &Shot, placed: &Placed) -> Option<String> {
    if placed.light.spread() == Spread::Sun {
        return None;
    }
    let camera = &shot.camera;
    let away = placed.light.center.distance(camera.target);
    let lost = ROUNDINGS * f64::from(BIAS_ROUNDING) * away;
    let name = &planned.name;
    (planned.lighting == Lighting::Shadowed && lost > SEEN * camera.eye.distance(camera.target))
        .then(|| {
            format!(
                "{name} is {away:.1e} away, where depths are rounded: occluders less than {lost:.1e} above a surface cast no shadow on it."
            )
        })
}

/// Micropatches that hide so little that the format of their sums cannot tell [Atty06 app. A].
fn loses_shares(
    planned: &LightPlan,
    shot: &Shot,
    light: &AreaLight,
    settings: &Settings,
    found: &[LightCoverage],
) -> Option<String> {
    let sums = settings.reads("accumulate", light.is_point()) == Some(true);
    if !sums || planned.lighting != Lighting::Shadowed {
        return None;
    }
    let sides = light.sides(&Ball::around(shot.scene.bounds()));
    let occluders = sides.iter().zip(found).filter_map(|(side, found)| {
        let placed = survey::Placed::new(side, shot.origin(), shot.touch(light));
        Occluders::new(shot, &placed, found)
    });
    let occluders = occluders.min_by(|a, b| a.nearest.total_cmp(&b.nearest))?;
    let (width, height) = sides[0].light.half_size();
    let size = 2.0 * DVec2::new(width, height) / f64::from(settings.split);
    let least = occluders.least_distance(settings, size);
    let (name, nearest, format) = (&planned.name, occluders.nearest, settings.accumulate);
    (nearest < least).then(|| {
        format!(
            "An occluder is {nearest:.2e} from {name}; where one is nearer than {least:.2e}, a texel of its map hides less than \
             2^-{} of the light and {format} may lose it: choose --accumulate fp32, a smaller --map or a larger --split.",
            fraction_bits(format)
        )
    })
}
