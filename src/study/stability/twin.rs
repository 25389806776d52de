//! What the f64 twin of the integration makes of the maps that a frame has drawn.

use glam::Vec3;
use rayon::prelude::*;

use crate::Result;
use crate::image::Plane;
use crate::render::Renderer;
use crate::shot::Shot;
use crate::technique::Technique;
use crate::twin::contour::ShadowMap;
use crate::twin::radial::SubLight;
use crate::twin::receiver::{in_view, project};
use crate::twin::resolve;

/// Cells of all views and pixels: beyond it the twin, which leaves nothing out, would take minutes.
const WORK_MAX: u64 = 4 << 30;

/// [visibility] How far the image of a technique that integrates contours is off what its own maps say in f64, at
/// most. None: the technique is another one, points stand for sub-lights, or the shot is too large for the twin.
///
/// # Errors
/// The device is lost, or memory cannot be read back.
pub fn largest_deviation(
    renderer: &mut Renderer,
    shot: &Shot,
    image: &Plane,
) -> Result<Option<f64>> {
    let integrates = matches!(
        shot.settings.technique,
        Technique::PacketContour | Technique::PixelContour
    ) && renderer.plan().near_count() == 0;
    let pixels = image.data.len();
    let light = renderer.plan().lights[0].light;
    let corners = renderer.plan().corners();
    let texels = u64::from(shot.settings.map).pow(2);
    if !integrates || texels * pixels as u64 * u64::from(light.view_count) > WORK_MAX {
        return Ok(None);
    }
    let positions: Vec<[f32; 4]> = renderer.read_image("position_world", pixels)?;
    let normals: Vec<[f32; 4]> = renderer.read_image("normal_world", pixels)?;
    let place = |pixel: usize| {
        let vector = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
        (vector(positions[pixel]), vector(normals[pixel]))
    };
    let mut hidden = vec![0.0; pixels];
    for index in 0..light.view_count {
        add_hidden(renderer, index, &place, &mut hidden)?;
    }
    let deviation = |pixel: usize| {
        let (position, normal) = place(pixel);
        let wanted = resolve::visibility(&light, &corners, position, normal, hidden[pixel]);
        (f64::from(image.data[pixel]) - wanted).abs()
    };
    let surfaces = (0..pixels).filter(|&pixel| positions[pixel][3] > 0.0);
    Ok(Some(surfaces.map(deviation).fold(0.0, f64::max)))
}

/// Adds what a view hides from each pixel, by all cells of its map.
fn add_hidden(
    renderer: &mut Renderer,
    index: u32,
    place: &(impl Fn(usize) -> (Vec3, Vec3) + Sync),
    hidden: &mut [f64],
) -> Result<()> {
    renderer.render_view(index)?;
    let Some(planned) = renderer.plan().views().nth(index as usize).cloned() else {
        return Ok(());
    };
    let fit = renderer.fits()?[index as usize];
    if fit.level_count == 0 {
        return Ok(());
    }
    let view = planned.view;
    let size = view.map_size as i32;
    let depths: Vec<f32> =
        renderer.read_image_of_view("shadow_map", index, (size * size) as usize)?;
    let map = ShadowMap {
        size,
        depths: &depths,
    };
    let part = SubLight::new(&view, &fit, planned.cut(), map);
    hidden
        .par_iter_mut()
        .enumerate()
        .for_each(|(pixel, hidden)| {
            let (position, normal) = place(pixel);
            let to_point = position - Vec3::from(view.center);
            if in_view(&view, position, normal) {
                let receiver = project(&view, &fit, planned.oblique, to_point, normal);
                let share = part.hidden_share(&receiver, [0; 2], [size - 2; 2]);
                *hidden += f64::from(view.weight) * share;
            }
        });
    Ok(())
}
