//! Flicker: what changes from frame to frame although the truth does not.

use std::sync::Arc;

use crate::compare::faces_wholly;
use crate::gpu::Gpu;
use crate::render::{RenderOptions, Renderer};
use crate::scene::AreaLight;
use crate::technique::Settings;
use crate::{Error, Result};

use super::subject::Subject;

/// Of its width a light steps aside from one frame to the next. As occluders stand still on the light's plane, seen
/// from a receiver, the truth changes by the share of the area that comes in or goes out: no more than the step for a
/// rectangle, no more than 4/π of it for a disc.
const STEP: f64 = 1.0 / 256.0;

/// Mean change of the visibility from one frame to the next beyond what the truth can change, over shadow pixels
/// that face the whole light, while all lights step aside `frames` times.
///
/// # Errors
/// A frame cannot be rendered, or there is no shadow pixel.
pub(super) fn flicker(
    gpu: &Arc<Gpu>,
    subject: &Subject,
    settings: &Settings,
    frames: u32,
    options: RenderOptions,
) -> Result<f64> {
    let mut shot = subject.shot.clone();
    shot.settings = settings.clone();
    let (mut sum, mut count) = (0.0, 0usize);
    let mut last: Option<Vec<f32>> = None;
    for _ in 0..=frames {
        let mut renderer = Renderer::new(gpu, &shot, options)?;
        renderer.render()?;
        let frame = all_lights(&renderer, shot.lights.len())?;
        for excess in last.iter().flat_map(|last| changes(subject, last, &frame)) {
            sum += excess;
            count += 1;
        }
        last = Some(frame);
        shot.lights.iter_mut().for_each(step_aside);
    }
    match count {
        0 => Err(Error::Invalid(
            "no pixel is in shadow, so nothing can flicker".into(),
        )),
        _ => Ok(sum / count as f64),
    }
}

/// Visibility of all lights, one below the other.
pub(super) fn all_lights(renderer: &Renderer, lights: usize) -> Result<Vec<f32>> {
    let mut all = Vec::new();
    for light in 0..lights {
        all.extend(renderer.visibility(light)?);
    }
    Ok(all)
}

/// The change of each shadow pixel beyond what the truth can change.
fn changes(subject: &Subject, before: &[f32], after: &[f32]) -> impl Iterator<Item = f64> {
    let allowed = STEP * 4.0 / std::f64::consts::PI;
    let truth = subject.visibility.data.iter().zip(&subject.facing.data);
    before
        .iter()
        .zip(after)
        .zip(truth)
        .filter(|((before, after), (truth, facing))| {
            **truth < 1.0 && faces_wholly(**facing) && !before.is_nan() && !after.is_nan()
        })
        .map(move |((before, after), _)| (f64::from((after - before).abs()) - allowed).max(0.0))
}

fn step_aside(light: &mut AreaLight) {
    let (u, _, _) = light.frame();
    light.center += u * 2.0 * light.half_size().0 * STEP;
}
