//! The front: the visible surface of a scene that is drawn, or of a host's images.

use super::pass::{Domain, Drawn, Extent, Lent, Pass, Target, Work};
use super::resource::{Resource, Shape};
use super::{Casters, Front, Surface};
use crate::gpu::{Blend, ImageKind};
use crate::shared;

/// Position, normal and colour of what each pixel sees.
const GBUFFER: Pass = Pass::new(
    "gbuffer",
    Work::Draw {
        vertex: "gbuffer.vert",
        fragment: Some("gbuffer.frag"),
        what: Drawn::Surface,
        into: Target::Images {
            colors: &["position_world", "normal_world", "albedo"],
            depth: Some("camera_depth"),
            extent: Extent::Image,
            blend: Blend::Replace,
        },
    },
);

/// The same of each of a pixel's samples.
const GBUFFER_SAMPLES: Pass = Pass::new(
    "gbuffer",
    Work::Draw {
        vertex: "gbuffer.vert",
        fragment: Some("gbuffer.frag"),
        what: Drawn::Surface,
        into: Target::Images {
            colors: &["position_samples", "normal_samples", "albedo_samples"],
            depth: Some("depth_samples"),
            extent: Extent::Image,
            blend: Blend::Replace,
        },
    },
);

/// The sample that stands for its pixel [Schwarz08 §7].
const PICK_SAMPLE: Pass = Pass::new(
    "pick_sample",
    Work::Draw {
        vertex: "whole_image.vert",
        fragment: Some("pick_sample.frag"),
        what: Drawn::WholeImage,
        into: Target::Images {
            colors: &["position_world", "normal_world", "albedo"],
            depth: None,
            extent: Extent::Image,
            blend: Blend::Replace,
        },
    },
);

/// A host's transforms and lights of this frame.
const UPDATE: Pass = Pass::new("update", Work::Upload);

/// A host's depths, and its normals, as position and normal of each pixel.
const IMPORT_DEPTHS: Pass =
    Pass::dispatch("import_surface", "import_surface.comp", Domain::Image).lent(Lent::Surface);

/// The same from positions.
const IMPORT_POSITIONS: Pass = IMPORT_DEPTHS.with(&[("GIVEN_POSITIONS", 1)]);

/// The triangles of a host's meshes where they stand.
const GATHER: Pass = Pass::dispatch("gather", "gather.comp", Domain::Instances).lent(Lent::Mesh);

/// What comes before the lights.
pub fn passes(front: Front, multisampled: bool, casters: Casters) -> impl Iterator<Item = Pass> {
    let surface: &[Pass] = match front {
        Front::Drawn if multisampled => &[GBUFFER_SAMPLES, PICK_SAMPLE],
        Front::Drawn => &[GBUFFER],
        Front::Imported(Surface::Depths) => &[UPDATE, IMPORT_DEPTHS],
        Front::Imported(Surface::Positions) => &[UPDATE, IMPORT_POSITIONS],
    };
    let gather = (casters == Casters::Gathered).then_some(GATHER);
    surface.iter().copied().chain(gather)
}

pub const RESOURCES: &[Resource] = &[
    Resource::copied("positions", |s| Shape::Buffer(s.inventory.vertices * 12)),
    Resource::copied("position_residuals", |s| {
        Shape::Buffer(s.inventory.vertices * 12).when(s.is_drawn() && s.has_views())
    }),
    Resource::copied("triangles", |s| Shape::Buffer(s.inventory.triangles * 12)),
    Resource::copied("triangle_surfaces", |s| {
        Shape::Buffer(s.inventory.triangles * 4).when(s.is_drawn())
    }),
    Resource::copied("triangle_planes", |s| {
        Shape::Buffer(s.inventory.triangles * 16).when(s.is_drawn())
    }),
    Resource::copied("surfaces", |s| {
        Shape::array::<shared::Surface>(s.inventory.materials)
    }),
    Resource::copied("texcoords", |s| {
        Shape::Buffer(s.inventory.texcoords * 8).when(s.textured)
    }),
    Resource::copied("vertex_colors", |s| {
        Shape::Buffer(s.inventory.colors * 12).when(s.colored)
    }),
    Resource::copied("vertex_surfaces", |s| {
        Shape::Buffer(s.inventory.vertices * 4).when(s.masked)
    }),
    Resource::copied("texels", |s| {
        Shape::Buffer(s.inventory.texels).when(s.textured)
    }),
    Resource::new("camera_depth", |s| {
        Shape::image(ImageKind::Depth, s.image).when(s.is_drawn() && !s.multisampled)
    }),
    Resource::new("depth_samples", |s| {
        Shape::image(ImageKind::DepthSamples, s.image).when(s.multisampled)
    }),
    Resource::new("position_samples", |s| {
        Shape::image(ImageKind::VectorSamples, s.image).when(s.multisampled)
    }),
    Resource::new("normal_samples", |s| {
        Shape::image(ImageKind::VectorSamples, s.image).when(s.multisampled)
    }),
    Resource::new("albedo_samples", |s| {
        Shape::image(ImageKind::ColorSamples, s.image).when(s.multisampled)
    }),
    Resource::new("position_world", |s| {
        Shape::image(ImageKind::Vector, s.image)
    }),
    Resource::new("normal_world", |s| Shape::image(ImageKind::Vector, s.image)),
    Resource::new("albedo", |s| {
        Shape::image(ImageKind::Color, s.image).when(s.is_drawn())
    }),
    Resource::new("host", |s| {
        Shape::array::<shared::Host>(1).when(!s.is_drawn())
    }),
    Resource::new("instances", |s| {
        Shape::array::<shared::Instance>(s.inventory.instances)
    }),
];
