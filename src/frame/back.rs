//! The back: what the views add up to, as visibility and as a picture.

use super::Front;
use super::pass::{Domain, Drawn, Pass, Target, Work};
use super::resource::{Resource, Shape};

const CLEAR_OCCLUSION: Pass = Pass::new("clear_occlusion", Work::Clear(&["occlusion"]));

/// A light's visibility: what its views have added up, over their weights.
const RESOLVE: Pass = Pass::dispatch("resolve", "resolve.comp", Domain::Image);

/// The picture of all lights.
pub const SHADE: Pass = Pass::dispatch("shade", "shade.comp", Domain::Image);

/// The same of pixels of several samples [Schwarz08 §7].
const SHADE_SAMPLES: Pass = Pass::dispatch("shade", "shade_samples.comp", Domain::Image);

/// The visibility into the image that a host has lent.
const EXPORT: Pass = Pass::new(
    "export",
    Work::Draw {
        vertex: "whole_image.vert",
        fragment: Some("export.frag"),
        what: Drawn::WholeImage,
        into: Target::Lent,
    },
);

/// Before a light's views, if several add up.
pub fn first_passes(accumulates: bool) -> impl Iterator<Item = Pass> {
    accumulates.then_some(CLEAR_OCCLUSION).into_iter()
}

/// After a light's views.
pub fn light_passes() -> impl Iterator<Item = Pass> {
    [RESOLVE].into_iter()
}

/// After the lights.
pub fn passes(front: Front, picture: bool, multisampled: bool) -> impl Iterator<Item = Pass> {
    let shade = match multisampled {
        true => SHADE_SAMPLES,
        false => SHADE,
    };
    let shade = picture.then_some(shade);
    shade
        .into_iter()
        .chain((front != Front::Drawn).then_some(EXPORT))
}

/// What the views add to.
pub const OCCLUSION: &[Resource] = &[Resource::new("occlusion", |s| {
    Shape::array::<f32>(s.pixels()).when(s.has_views())
})];

pub const RESOURCES: &[Resource] = &[
    Resource::copied("corners", |s| Shape::array::<[f32; 2]>(s.corners.into())),
    Resource::copied("visibility", |s| {
        Shape::array::<f32>(s.pixels() * u64::from(s.lights))
    }),
    Resource::copied("picture", |s| Shape::Buffer(s.pixels() * 4).when(s.picture)),
];
