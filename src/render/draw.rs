//! Records what a step draws.

use std::mem::offset_of;

use super::pipelines::Pipelines;
use super::recording::{Inputs, Recording, in_fit, missing, push};
use crate::error::Result;
use crate::frame::{Drawn, Extent, Step, Target};
use crate::gpu::{self, Attachments, Draw, MAX_COLORS, Rendering};
use crate::shared::Fit;

/// A draw of a step, for one view if it has views.
pub struct Drawing<'a> {
    pub recording: &'a Recording<'a>,
    pub step: Step,
    /// [texel] Of the view's map.
    pub side: u32,
}

impl Drawing<'_> {
    /// # Errors
    /// A resource is missing that the plan should have listed, or an input that it asks for.
    pub fn record(
        &self,
        rendering: &Rendering,
        pipelines: &Pipelines,
        what: Drawn,
        into: Target,
        inputs: &mut Inputs,
    ) -> Result<()> {
        let recording = self.recording;
        let (push, list) = (push(&self.step), recording.list(&self.step, inputs));
        let target = self.target(into, inputs)?;
        let into = target.attachments();
        match (what, pipelines) {
            (Drawn::Surface | Drawn::WholeImage | Drawn::Texels, Pipelines::Draw(pass)) => {
                let frame = &recording.plan.frame;
                let (count, instances) = match what {
                    Drawn::Surface => (3 * (frame.opaque_count + frame.masked_count), 1),
                    Drawn::Texels => (6, self.side * self.side),
                    _ => (3, 1),
                };
                let draw = (pass.with(list), Draw::Vertices { count, instances });
                rendering.draw(&into, push, [draw]);
            }
            (Drawn::Casters { .. }, Pipelines::Casters { opaque, masked }) => {
                let fits = recording.resources.buffer("fits")?;
                let indices = recording.resources.buffer("caster_indices")?;
                let casters = |offset| Draw::Indexed {
                    indices,
                    command: (fits, in_fit(push.index, offset)),
                };
                let opaque = (opaque.with(0), casters(offset_of!(Fit, opaque_draw)));
                let masked = masked.as_ref();
                let masked =
                    masked.map(|pass| (pass.with(0), casters(offset_of!(Fit, masked_draw))));
                rendering.draw(&into, push, [opaque].into_iter().chain(masked));
            }
            (Drawn::ByHost, _) => {
                let draw = inputs.draw.as_mut();
                let draw = draw.ok_or_else(|| missing("what draws the casters"))?;
                rendering.draw_by_host(&into, || draw(push.index));
            }
            _ => return Err(missing("the pipelines of a draw")),
        }
        Ok(())
    }

    /// Images by name; of those that views have layers of, the view's.
    fn target(&self, into: Target, inputs: &Inputs) -> Result<Attached> {
        let recording = self.recording;
        let slot = push(&self.step).index % recording.plan.views_at_once;
        match into {
            Target::Images {
                colors,
                depth,
                extent,
                ..
            } => {
                let image = |name| {
                    let mut target = recording.resources.image(name)?.target(slot);
                    if extent != Extent::Image {
                        target.size = (self.side, self.side);
                    }
                    Ok(target)
                };
                let mut attached = [gpu::Target::default(); MAX_COLORS];
                for (target, name) in attached.iter_mut().zip(colors) {
                    *target = image(name)?;
                }
                Ok(Attached {
                    colors: attached,
                    color_count: colors.len(),
                    depth: depth.map(image).transpose()?,
                    margin: match extent {
                        Extent::Image => 0,
                        Extent::Map { margin } => margin,
                    },
                })
            }
            Target::Lent => {
                let output = inputs
                    .output
                    .ok_or_else(|| missing("an image for the result"))?;
                Ok(Attached {
                    colors: [output; MAX_COLORS],
                    color_count: 1,
                    depth: None,
                    margin: 0,
                })
            }
        }
    }
}

/// What a draw goes to.
struct Attached {
    colors: [gpu::Target; MAX_COLORS],
    color_count: usize,
    depth: Option<gpu::Target>,
    /// [texel] Frame round the image that nothing is drawn to.
    margin: u32,
}

impl Attached {
    fn attachments(&self) -> Attachments<'_> {
        Attachments {
            colors: &self.colors[..self.color_count],
            depth: self.depth,
            margin: self.margin,
        }
    }
}
