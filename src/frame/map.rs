//! A view's shadow map, fitted to what can cast on what is visible, and the structures over it.

use super::pass::{Domain, Drawn, Lent, Pass, Work};
use super::resource::{Resource, Shape, Sizes};
use super::{Casters, Density};
use crate::gpu::ImageKind;
use crate::shared::{self, Fit, HierarchyGroups, View};

/// [texel] Frame of the shadow map that stays empty, so that contours close inside the map.
const MARGIN: u32 = 1;

const CLEAR_FITS: Pass =
    Pass::new("clear_fits", Work::Clear(&["fits", "hierarchy_groups"])).lasting();

/// The visible receivers' bounds in the view (`algorithm.md` §10).
const RECEIVERS: Pass =
    Pass::dispatch("receivers", "receivers.comp", Domain::PixelReduction).lasting();

/// The triangles that can shadow one of them, and their bounds.
const CASTERS: Pass =
    Pass::dispatch("casters", "casters.comp", Domain::TriangleReduction).lasting();

/// The bounds of where casters can stand, for a host that draws them.
const REGION: Pass = Pass::dispatch("region", "region.comp", Domain::Once).lasting();

/// Projection, levels and indirect dispatches.
const FIT: Pass = Pass::dispatch("fit", "fit.comp", Domain::Once).lasting();

/// The matrix of the projection, for a host that draws casters.
const PROJECTION: Pass = Pass::dispatch("projection", "projection.comp", Domain::Once).lasting();

/// The least depth in each direction.
const SHADOW_MAP: Pass = drawn(
    "shadow_map",
    "shadow_map.vert",
    None,
    Drawn::Casters {
        masked: "shadow_map.frag",
    },
);

const SHADOW_MAP_BY_HOST: Pass = drawn("shadow_map", "", None, Drawn::ByHost);

const SHADOW_MAP_IMPORTED: Pass = drawn(
    "shadow_map",
    "whole_image.vert",
    Some("import_map.frag"),
    Drawn::WholeImage,
)
.lent(Lent::Map);

/// What lies behind the layers that are kept already [BCS08].
const PEEL: Pass = drawn(
    "peel",
    "shadow_map.vert",
    Some("shadow_map.frag"),
    Drawn::Casters {
        masked: "shadow_map.frag",
    },
)
.with(&[("PEEL", 1)]);

/// The farthest back faces of what casts, for techniques that ask how thick it is.
pub const BOTTOM_MAP: Pass = Pass::depths(
    "bottom_map",
    ("shadow_map.vert", Some("shadow_map.frag")),
    Drawn::Casters {
        masked: "shadow_map.frag",
    },
    "bottom_map",
    MARGIN,
)
.with(&[("BOTTOMS", 1)])
.lasting();

const KEEP_LAYER: Pass = Pass::new(
    "keep_layer",
    Work::CopyLayer {
        from: "shadow_map",
        to: "layers",
    },
)
.lasting();

/// Two levels of the hierarchy over the map.
const HIERARCHY: Pass = building("hierarchy.comp");
const HIERARCHY_16: Pass = building("hierarchy_16.comp");

/// A coarser level of the map [Schwarz08 §3].
const COARSE_MAP: Pass =
    Pass::dispatch("coarse_map", "coarse_map.comp", Domain::PyramidLevel).lasting();

/// A coarser level of microrects [Schwarz08 §5.2].
const MICRORECTS: Pass =
    Pass::dispatch("microrects", "microrects.comp", Domain::PyramidLevel).lasting();

const fn building(shader: &'static str) -> Pass {
    Pass::dispatch("hierarchy", shader, Domain::HierarchyLevel).lasting()
}

const fn drawn(
    name: &'static str,
    vertex: &'static str,
    fragment: Option<&'static str>,
    what: Drawn,
) -> Pass {
    Pass::depths(name, (vertex, fragment), what, "shadow_map", MARGIN).lasting()
}

/// What a technique reads of a view's shadow map.
#[derive(Debug, Clone, Copy, Default)]
pub struct Structures {
    /// [level] Of the hierarchy; 0 = none.
    pub levels: u32,
    /// [bit] 16 or 32, of a bound in it.
    pub bounds_bits: u32,
    /// [layer] That are kept; 0 = the map itself is read.
    pub layers: u32,
    /// [level] Coarser than the map.
    pub coarse_levels: u32,
    /// They are of microrects.
    pub microrects: bool,
}

/// [byte] Of a triangle in the list of casters.
pub const CASTER_BYTES: u64 = size_of::<shared::uvec3>() as u64;

/// A view's shadow map.
pub fn map_shape(side: u32) -> Shape {
    Shape::image(ImageKind::Layers, (side, side))
}

/// A hierarchy of levels below `levels` over a map of `map` × `map` texels, with bounds of 16 or 32 bits.
pub fn hierarchy_shape(density: Density, map: u32, levels: u32, bits: u32) -> Shape {
    let kind = match bits {
        16 => ImageKind::Bounds16,
        _ => ImageKind::Bounds,
    };
    let (width, height, layers) = density.extent(map, levels);
    Shape::layers(kind, (width, height), layers)
}

/// Once a frame, before the first view.
pub fn first_passes() -> impl Iterator<Item = Pass> {
    [CLEAR_FITS].into_iter()
}

/// What fits views' maps to their receivers and casters.
pub fn fitting_passes(casters: Casters) -> impl Iterator<Item = Pass> {
    let passes: &[Pass] = match casters {
        Casters::Scene | Casters::Gathered => &[RECEIVERS, CASTERS, FIT],
        Casters::DrawnByHost => &[RECEIVERS, REGION, FIT, PROJECTION],
        Casters::Maps => &[RECEIVERS, FIT],
    };
    passes.iter().copied()
}

/// What draws a view's map.
pub fn drawing_pass(casters: Casters) -> Pass {
    match casters {
        Casters::Scene | Casters::Gathered => SHADOW_MAP,
        Casters::DrawnByHost => SHADOW_MAP_BY_HOST,
        Casters::Maps => SHADOW_MAP_IMPORTED,
    }
}

/// What builds the hierarchies over views' maps, each pass with the lower of the two levels that it makes.
pub fn hierarchy_passes(structures: Structures) -> impl Iterator<Item = (Pass, u32)> {
    let hierarchy = match structures.bounds_bits {
        16 => HIERARCHY_16,
        _ => HIERARCHY,
    };
    let lower_of_two = (0..structures.levels).step_by(2);
    lower_of_two.map(move |level| (hierarchy, level))
}

/// What else is made of a view's map, each pass with the level or layer that it makes.
pub fn structure_passes(structures: Structures) -> Vec<(Pass, u32)> {
    let coarser = match structures.microrects {
        true => MICRORECTS,
        false => COARSE_MAP,
    };
    let mut passes: Vec<(Pass, u32)> = (1..=structures.coarse_levels)
        .map(|level| (coarser, level))
        .collect();
    for layer in 0..structures.layers {
        passes.extend((layer > 0).then_some((PEEL, layer)));
        passes.push((KEEP_LAYER, layer));
    }
    passes
}

/// What `BOTTOM_MAP` draws into; or nothing, where shaders name it and do without.
pub const fn bottom_map(needed: bool) -> Resource {
    match needed {
        true => Resource::new("bottom_map", |s| {
            Shape::image(ImageKind::Depth, (s.map, s.map))
        }),
        false => Resource::new("bottom_map", |_| Shape::image(ImageKind::Depth, (0, 0))),
    }
}

/// [texel] Of all coarser levels: their sides halve, from half of the next power of two on.
fn coarse_texels(sizes: &Sizes) -> u64 {
    let side = u64::from(sizes.map.next_power_of_two());
    let last = side >> sizes.coarse_levels;
    (side * side - last * last) / 3
}

/// What passes draw and build.
pub const RESOURCES: &[Resource] = &[
    Resource::copied("triangle_casts", |s| {
        Shape::array::<u32>(s.inventory.triangles.div_ceil(32))
            .when(s.has_views() && s.tells_casters)
    }),
    Resource::new("caster_indices", |s| {
        Shape::Buffer(s.inventory.triangles * CASTER_BYTES)
            .times(s.views_at_once)
            .when(s.has_views() && s.casters.are_triangles())
    }),
    Resource::new("givens", |s| {
        Shape::array::<shared::Given>(s.views.into()).when(!s.casters.are_triangles())
    }),
    Resource::new("projections", |s| {
        Shape::array::<shared::Projection>(s.views.into()).when(s.casters == Casters::DrawnByHost)
    }),
    Resource::new("shadow_map", |s| map_shape(s.map).times(s.views_at_once)),
    Resource::new("hierarchy", |s| {
        hierarchy_shape(s.density, s.map, s.levels, s.bounds_bits).times(s.views_at_once)
    }),
    Resource::new("coarse_map", |s| {
        Shape::array::<[f32; 2]>(coarse_texels(s)).when(!s.microrects)
    }),
    Resource::new("microrects", |s| {
        Shape::array::<[u32; 3]>(coarse_texels(s)).when(s.microrects)
    }),
    Resource::new("layers", |s| {
        Shape::layers(ImageKind::Layers, (s.map, s.map), s.layers)
    }),
];

/// What the host knows of the views, and what the device finds out.
pub const VIEW_RESOURCES: &[Resource] = &[
    Resource::copied("views", |s| Shape::array::<View>(s.views.into())),
    Resource::new("fits", |s| Shape::array::<Fit>(s.views.into())),
    Resource::new("hierarchy_groups", |s| {
        Shape::array::<HierarchyGroups>(s.views.into())
    }),
];

/// The sector tables of sub-lights that a disc's rim or a polygon's sides cut, with these sides.
pub const SECTORS: &[Resource] = &[Resource::copied("sectors", |s| {
    Shape::array::<f32>(s.sector_entries)
})];
