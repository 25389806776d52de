//! The settings of a technique: the table of all knobs.

use super::Technique;
use super::field::Field;
use super::kinds::{
    Accumulate, Evaluate, Hierarchy, Leaf, Mapping, Neighbours, Occluders, Pattern,
};
use super::knob::{self, Access};
use super::row::Row;

/// A knob of [`Settings`].
pub type Knob = knob::Knob<Settings>;

/// Declares [`Settings`] and the table of knobs: a row each, of a field with its type and default, and what [`Row`] says.
macro_rules! settings {
    ($($(#[$doc:meta])* $field:ident: $type:ty = $default:expr, $row:expr;)+) => {
        /// A technique and its knobs.
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        pub struct Settings {
            $($(#[$doc])* pub $field: $type,)+
        }

        impl Default for Settings {
            fn default() -> Self {
                Self { $($field: $default,)+ }
            }
        }

        /// All knobs, in the order in which commands and tables name them.
        pub static KNOBS: &[Knob] = &[$(knob::Knob {
            field: stringify!($field),
            row: $row,
            access: Access {
                text: |settings| settings.$field.text(),
                set_text: |settings, text| Field::parse(text).map(|value| settings.$field = value),
                number: |settings| settings.$field.number(),
                set_number: |settings, number| {
                    Field::from_number(number).map(|value| settings.$field = value)
                },
                check: |settings, row| settings.$field.check(row),
                choices: <$type as Field>::choices,
            },
        },)+];
    };
}

settings! {
    technique: Technique = Technique::PacketContour,
        Row::value("technique", "NAME", "Which publication computes the visibility: {}")
            .swept("techniques", "NAMES", "Techniques [default: all]");

    /// [texel] [16, 8192] Width and height of a shadow map.
    map: u32 = 512,
        Row::value(
            "map",
            "R",
            "Width and height of a shadow map in texels, 16 to 8192 [default: 128 with occluder-driven, else 512]",
        )
            .depends()
            .within(16, 8192, "a shadow map is {} texels wide")
            .swept("maps", "TEXELS", "Values of --map")
            .swept_over("256,512,1024");

    /// [texel] Bias along the receiver's plane, in texels of its slope; None: the usual one of what runs
    /// ([`Settings::bias`]).
    bias: Option<f32> = None,
        Row::value(
            "bias",
            "TEXELS",
            "Depth bias in texels of the receiver's slope, 0 or more \
             [default: 0.25 with contours, 0.5 with reference-maps, 6 with pcss, else 1]",
        )
        .depends()
        .finite("the bias is a finite number of texels from 0")
        .swept("biases", "TEXELS", "Values of --bias [default: each technique's own]");

    /// [1, 16] The light is cut into split × split sub-lights.
    split: u32 = 4,
        Row::value(
            "split",
            "N",
            "Cut each light into N×N sub-lights, 1 to 16; 1 is fastest and leaks where occluders overlap \
             [default: 4 with packet-contour, else 1]",
        )
        .depends()
        .within(1, 16, "the light's split is {}")
        .swept("splits", "NUMBERS", "Values of --split [default: packet-contour 1,2,4, rivals 1]");

    /// [pixel] Width and height of a packet, each 1 to 8; 1×1 is the pixel-wise path; [`Settings::LOCAL`].
    packet: (u32, u32) = Settings::LOCAL,
        Row::value(
            "packet",
            "PIXELS",
            "Pixels that share a traversal: 1x1 to 8x8, where 1x1 is the pixel-wise path, or local: those that are \
             alike among the pixels of a subgroup, which walks for them together [default: calibrated, else local]",
        )
        .depends()
        .within(1, 8, "a packet is {} pixels")
        .swept("packets", "PIXELS", "Values of --packet [default: this device's]");

    leaf: Leaf = Leaf::PerPixel,
        Row::value(
            "leaf",
            "RULE",
            "What a leaf does where a packet's pixels disagree: {} \
             [default: calibrated, else per-pixel]",
        )
        .depends();

    mapping: Mapping = Mapping::Serial,
        Row::value(
            "mapping",
            "MAPPING",
            "How a packet of WxH pixels maps to shader invocations: {} [default: calibrated, else serial]",
        )
        .depends();

    /// [point] [0, 4096] `PacketContour` only: on the whole light, of those that stand for sub-lights that an occluder is
    /// nearer to than they are wide; fewer where side faces multiply their views; 0 = none, they are integrated all the
    /// same.
    near_points: u32 = 256,
        Row::value(
            "near-points",
            "N",
            "With packet-contour: points of the light that cast hard shadows, on all of it, where an occluder is \
             nearer to sub-lights than they are wide, 0 to 4096; 0 = integrate these as well",
        )
        .within(0, 4096, "the number of points near occluders is {}");

    /// How densely the nodes of the hierarchy over the map stand.
    hierarchy: Hierarchy = Hierarchy::Graded,
        Row::value(
            "hierarchy",
            "NAME",
            "How densely the hierarchy over the map stands, {}; with contours the image is the same",
        )
        .depends()
        .swept("hierarchies", "NAMES", "Values of --hierarchy [default: as the technique has it]");

    /// 32 or 16: bits of a bound in the hierarchy. With 16 they are conservative: half the memory, wider kernels.
    mssm_bits: u32 = 32,
        Row::value(
            "mssm-bits",
            "BITS",
            "Bits of a depth bound in the hierarchy over the map, 32 or 16 (half its memory, the same image)",
        )
        .one_of(&[16, 32], "a bound of the hierarchy has {} bits");

    /// [view] [1, 64] Views side by side, at most; None: as many as fit into 64 MiB more, or 1 on a CPU. The image is the same.
    views_at_once: Option<u32> = None,
        Row::value(
            "views-at-once",
            "N",
            "Views that are made, and with local packets looked at, side by side, 1 to 64: fewer and larger dispatches \
             for more memory, the same image [default: as many as fit into 64 MiB more, 1 on CPU drivers]",
        )
        .within(1, 64, "the number of views at once is {}")
        .depends();

    /// [8, 16] `Bitmask` only: the light has light_samples × light_samples samples.
    light_samples: u32 = 16,
        Row::value("light-samples", "N", "With bitmask: N×N samples of the light, 8 to 16")
            .within(8, 16, "the number of samples along a side of the light is {}")
            .sets("LIGHT_SAMPLES")
            .swept("light-samples", "NUMBERS", "Values of --light-samples [default: 8,16]");

    /// `Bitmask` only.
    pattern: Pattern = Pattern::Jittered,
        Row::value(
            "pattern",
            "NAME",
            "With bitmask: where the light's samples stand, {}",
        )
        .sets("JITTERED");

    /// [layer] [1, 4] `Bitmask` and `DepthPeeling` only: peeled layers of the shadow map.
    layers: u32 = 1,
        Row::value(
            "layers",
            "N",
            "With bitmask and depth-peeling: layers of the shadow map, 1 to 4 \
             [default: 4 with depth-peeling, else 1]",
        )
        .depends()
        .within(1, 4, "the number of layers of a shadow map is {}")
        .swept("layers", "NUMBERS", "Values of --layers [default: each technique's usual ones]");

    /// `DepthPeeling`, `Micropatch` and `Bitmask` only, each some of them ([`Method::occluders`](super::Method::occluders)).
    occluders: Occluders = Occluders::Micropatches,
        Row::value(
            "occluders",
            "KIND",
            "What texels stand for, of {}: the first two with depth-peeling, micropatches or microrects with micropatch, all \
             but contours with bitmask [default: microquads with bitmask, else micropatches]",
        )
        .depends();

    /// [sample] [1, 1024] `Pcss` only: of the blocker search.
    blocker_samples: u32 = 16,
        Row::value(
            "blocker-samples",
            "N",
            "With pcss: samples of the search for blockers, 1 to 1024",
        )
        .within(1, 1024, "the number of samples of the blocker search is {}")
        .sets("BLOCKER_SAMPLES");

    /// [sample] [1, 1024] `Pcss` only: of the filter.
    filter_samples: u32 = 32,
        Row::value("filter-samples", "N", "With pcss: samples of the filter, 1 to 1024")
            .within(1, 1024, "the number of samples of the filter is {}")
            .sets("FILTER_SAMPLES")
            .swept(
                "filter-samples",
                "NUMBERS",
                "Values of --filter-samples, with half as many --blocker-samples [default: 32]",
            );

    /// [map] [1, 4096] `ReferenceMaps` only.
    maps: u32 = 1024,
        Row::value(
            "maps",
            "N",
            "With reference-maps: hard shadow maps from points on the light, 1 to 4096",
        )
        .within(1, 4096, "the number of reference maps is {}")
        .swept("reference-maps", "NUMBERS", "Values of --maps of reference-maps [default: 256]");

    /// `ShadowWidth` only.
    neighbours: Neighbours = Neighbours::Flood,
        Row::value(
            "neighbours",
            "KIND",
            "With shadow-width: from where a texel gets its width, {}",
        )
        .sets("NEIGHBOURS");

    /// [4, 1024] `ShadowWidth` with neighbours only: the starting difference is 1 / start; no shadow is wider than start texels.
    start: u32 = 64,
        Row::value(
            "start",
            "N",
            "With shadow-width and 3 or 6 neighbours: start with a difference of 1/N, 4 to 1024; widths end at N texels",
        )
        .within(4, 1024, "the starting difference is 1 over {}")
        .sets("START");

    /// `ShadowWidth` only: factor on c_scale; 1 = the inner penumbra of an edge.
    scale: f32 = 1.0,
        Row::value(
            "scale",
            "FACTOR",
            "With shadow-width: how fast shadows darken inwards, 0 or more; 1 is as an edge of the light's size does",
        )
        .finite("the scale of shadow widths is a finite number from 0")
        .sets("SCALE");

    /// [share of the light] `ShadowWidth` only: c_bias, what hidden pixels are brighter by.
    shadow_bias: f32 = 0.0,
        Row::value(
            "shadow-bias",
            "SHARE",
            "With shadow-width: by how much of the light hidden pixels are brighter, 0 or more",
        )
        .finite("the bias of shadow widths is a finite number from 0")
        .sets("SHADOW_BIAS");

    /// `ShadowWidth` only: occluders are as far from the light as their farthest back faces [Kirsch03 §5].
    back_faces: bool = false,
        Row::switch(
            "back-faces",
            "With shadow-width: take the depths of the farthest back faces, so that overlapping blockers make shadows harder \
             instead of softer; for blockers that receive no shadows",
        )
        .sets("BACK_FACES");

    /// `OccluderDriven` only: of the soft shadow map.
    accumulate: Accumulate = Accumulate::Fp32,
        Row::value(
            "accumulate",
            "FORMAT",
            "With occluder-driven: in which format shadows add up, {} (half the memory, loses small shares)",
        );

    /// `OccluderDriven` only: a second map, of the occluders' farthest back faces.
    two_sided: bool = false,
        Row::switch(
            "two-sided",
            "With occluder-driven: the shadows of the farthest back faces as well, of which the darker counts",
        )
        .sets("TWO_SIDED");

    /// `OccluderDriven` with one side only: a patch has another below it, at the farthest back face.
    bottom_patches: bool = false,
        Row::switch(
            "bottom-patches",
            "With occluder-driven and without --two-sided: each patch hides what one at its occluder's end does as well",
        )
        .sets("BOTTOM_PATCHES");

    /// [micro-occluder] [4, 4096] Along each side of a pixel's kernel, at most; None: no limit [Schwarz08 §4].
    budget: Option<u32> = None,
        Row::value(
            "budget",
            "N",
            "Take levels of the map so coarse that kernels have no more than about N texels a side, 4 to 4096, blended smoothly; \
             with packet-contour, pixel-contour, micropatch and bitmask of one layer [default: none, the map itself]",
        )
        .depends()
        .within(4, 4096, "a budget is {} micro-occluders a side")
        .swept("budgets", "NUMBERS", "Values of --budget, none for no limit [default: none]");

    /// [0, 1] With a budget: the share of it that is left at the image's border.
    budget_falloff: f32 = 1.0,
        Row::value(
            "budget-falloff",
            "SHARE",
            "With --budget: the share of it that is left at the image's border, 0 to 1; from the middle on it falls evenly",
        )
        .share("what is left of a budget at the image's border is {}");

    /// [0, 1] With a budget: the share of it that is left where the surface's texture hides what shadows look like.
    budget_masking: f32 = 1.0,
        Row::value(
            "budget-masking",
            "SHARE",
            "With --budget: the share of it that is left where a surface's texture has much contrast, 0 to 1",
        )
        .share("what is left of a budget under a texture is {}");

    /// With a budget: kernels are looked for in all that the coarse texels at their corners stand for [Schwarz08 §6].
    query_growth: bool = true,
        Row::switch(
            "no-query-growth",
            "With --budget: look for kernels in no more than the texels in them, which ends shadows of coarse levels too early",
        )
        .sets("QUERY_GROWTH");

    /// Without a budget: which penumbra pixels are evaluated.
    evaluate: Evaluate = Evaluate::Full,
        Row::value(
            "evaluate",
            "SHARE",
            "Penumbra pixels that are evaluated along a side, {}; the others are joined from those around them on the same \
             surface, which is faster and blurs; with techniques that have kernels, without --budget",
        )
        .swept("evaluate", "SHARES", "Values of --evaluate [default: as the technique has it]");

    /// Leave out nodes whose back-projection misses the light (`algorithm.md` §7).
    footprint_pruning: bool = true,
        Row::switch(
            "no-footprint-pruning",
            "Visit nodes whose back-projection misses the light as well, as the paper does",
        )
        .sets("FOOTPRINT");

    /// `PixelContour` only: walk the hierarchy instead of every cell.
    hierarchical: bool = false,
        Row::switch(
            "hierarchical",
            "With pixel-contour: walk the hierarchy instead of every cell of the kernel",
        );

    /// `Micropatch…` only: patches reach out to where their left and bottom neighbours end.
    gap_filling: bool = true,
        Row::switch(
            "no-gap-filling",
            "With micropatch and micropatch-hierarchical: leave the gaps between patches open",
        )
        .sets("GAP_FILLING");

    /// `Hard` only: the share of 3×3 samples instead of the nearest one.
    percentage_closer: bool = false,
        Row::switch(
            "percentage-closer",
            "With hard: the share of 3×3 samples that hide the pixel, instead of the nearest one",
        )
        .sets("FILTER_REACH");

    /// [sample] 1 or 4: of a pixel, in the picture; visibility is of one of them [Schwarz08 §7].
    multisample: u32 = 1,
        Row::value(
            "multisample",
            "N",
            "Samples of a pixel in the picture, 1 or 4, which have one visibility together",
        )
        .one_of(&[1, crate::gpu::SAMPLES], "a pixel has {} samples");

    /// With several samples: one that lies on another surface than its pixel's takes a neighbour's visibility.
    neighbour_visibility: bool = true,
        Row::switch(
            "no-neighbour-visibility",
            "With --multisample 4: give all samples of a pixel its visibility, whatever they lie on",
        );

    /// Count pixels, packets, nodes and edges (costs time).
    counters: bool = false,
        Row::switch("counters", "Count pixels, packets, nodes and edges (takes time)").sets("COUNT");
}
