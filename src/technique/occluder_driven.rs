//! Soft shadow maps [Atty06]: each texel of a map of the occluders is a micropatch parallel to the light, which adds what it hides of
//! the light to all texels of a second map whose receivers it can hide it from. Pixels look their shadow up there.
//!
//! Right: inner and outer penumbrae at a cost that neither image nor receivers but occluders decide; a shot that tells casters from
//! receivers. Wrong: occluders receive no shadow, not even of others; areas add up, so that patches of different depths overlap on
//! the light or leave gaps between them, by up to equation 3 for each pair; what the light's centre does not see hides nothing,
//! which bottoms mend: two sides in most part, bottom patches at the price of more overlaps, too dark under what is thick; sums in
//! 16 bits lose shares below 2⁻¹¹ of themselves. A disc light is a square of its area.
//! Where a shot tells no casters, everything casts, and of the front faces towards the light the farthest receive: right on the
//! ground, not on what lies between.
//! DEVIATION [Atty06 §3.1]: patches and lights of any aspect; §3.5: the nearest faces are drawn whichever side they show, for they
//! are front faces of what is closed. The paper shows bottom patches in figure 11 and does not say what they are: here each texel's
//! patch has another below it where the farthest back face is, and what either hides counts once.

use super::{Accumulate, Method, Recipe, Settings, with};
use crate::frame::map::{BOTTOM_MAP, bottom_map};
use crate::frame::{Domain, Drawn, Extent, Pass, Resource, Shape, Target, Work};
use crate::gpu::{Blend, ImageKind};

pub struct OccluderDriven;

/// What shadows fall on.
const RECEIVER_MAP: Pass = Pass::depths(
    "receiver_map",
    ("receiver_map.vert", Some("receiver_map.frag")),
    Drawn::Surface,
    "receiver_map",
    0,
)
.lasting();

/// A level of the farthest receivers.
const RECEIVER_PYRAMID: Pass = Pass::dispatch(
    "receiver_pyramid",
    "receiver_pyramid.comp",
    Domain::PyramidLevel,
)
.lasting();

/// Where the patches of a map, 0 or that of bottoms, 1, can take light.
const EXTENTS: Pass = Pass::dispatch(
    "penumbra_extents",
    "penumbra_extents.comp",
    Domain::MapTexels,
)
.lasting();

/// What they take.
const SCATTER: Pass = scatter(&["soft_shadows"]);
const SCATTER_BOTTOMS: Pass = scatter(&["bottom_shadows"]);

const fn scatter(colors: &'static [&'static str]) -> Pass {
    let work = Work::Draw {
        vertex: "scatter.vert",
        fragment: Some("scatter.frag"),
        what: Drawn::Texels,
        into: Target::Images {
            colors,
            depth: None,
            extent: Extent::Map { margin: 0 },
            blend: Blend::Add,
        },
    };
    Pass::new("scatter_visibility", work).lasting()
}

const RECEIVERS: Resource = Resource::new("receiver_map", |s| {
    Shape::image(ImageKind::Depth, (s.map, s.map))
});
const PYRAMID: Resource = Resource::new("receiver_pyramid", |s| {
    // Its levels below one another, as if the map's side were the next power of two.
    let size = (s.map.div_ceil(2), s.map.next_power_of_two());
    Shape::image(ImageKind::Bounds, size)
});
const OF_PATCHES: Resource = Resource::new("penumbra_extents", |s| {
    Shape::array::<[u32; 2]>(u64::from(s.map) * u64::from(s.map))
});

/// A map of sums.
const fn sums(name: &'static str, accumulate: Accumulate) -> Resource {
    match accumulate {
        Accumulate::Fp32 => Resource::new(name, |s| Shape::image(ImageKind::Sums, (s.map, s.map))),
        Accumulate::Fp16 => {
            Resource::new(name, |s| Shape::image(ImageKind::Sums16, (s.map, s.map)))
        }
    }
}

/// An image that shaders name and these settings do without.
const fn absent(name: &'static str) -> Resource {
    Resource::new(name, |_| Shape::image(ImageKind::Depth, (0, 0)))
}

/// [level] Of the receiver pyramid over a map of `side` texels, from 2×2 texels to a single node.
fn pyramid_levels(side: u32) -> u32 {
    side.next_power_of_two().ilog2()
}

impl Method for OccluderDriven {
    fn recipe(&self, settings: &Settings) -> Recipe {
        let bottoms = settings.two_sided || settings.bottom_patches;
        let mut passes = vec![(RECEIVER_MAP, 0)];
        passes.extend((1..=pyramid_levels(settings.map)).map(|level| (RECEIVER_PYRAMID, level)));
        passes.extend(bottoms.then_some((BOTTOM_MAP, 0)));
        passes.extend([(EXTENTS, 0), (SCATTER, 0)]);
        if settings.two_sided {
            passes.extend([(EXTENTS, 1), (SCATTER_BOTTOMS, 1)]);
        }
        let mut recipe = Recipe::over_samples("soft_visibility", "soft_visibility.comp");
        recipe.passes.splice(0..0, passes);
        recipe.resources = vec![
            RECEIVERS,
            bottom_map(bottoms),
            PYRAMID,
            OF_PATCHES,
            sums("soft_shadows", settings.accumulate),
            match settings.two_sided {
                true => sums("bottom_shadows", settings.accumulate),
                false => absent("bottom_shadows"),
            },
        ];
        recipe
    }

    fn knobs(&self, settings: &Settings) -> Vec<&'static str> {
        let mut knobs = vec!["split", "accumulate", "two-sided"];
        if !settings.two_sided {
            knobs.push("bottom-patches");
        }
        knobs
    }

    /// [Atty06 §5.1.3] finds 128 texels enough for an occluder, and few maps beyond 200 better.
    fn make_usual(&self, settings: &mut Settings) {
        (settings.split, settings.map) = (1, 128);
    }

    fn variants(&self, usual: Settings) -> Vec<Settings> {
        let two = with(&usual, |settings| settings.two_sided = true);
        let bottoms = with(&usual, |settings| settings.bottom_patches = true);
        vec![two, bottoms, usual]
    }

    /// A single map holds all receivers.
    fn reach(&self) -> f32 {
        f32::MAX
    }
}
