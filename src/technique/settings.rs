//! The settings of a technique: the table of all knobs, and what they come to.

use super::choice::choice;
use super::knob::{self, Access, Field, Row};
use super::{Recipe, Technique};
use crate::Result;
use crate::frame::Density;
use crate::scene::AreaLight;
use crate::shared::LEAST_BUDGET;

choice! {
    /// What a leaf does whose status differs between the packet's pixels.
    enum Leaf, "leaf mode" {
        /// A packet whose pixels disagree is worked off pixel by pixel [Yang09 §4.1].
        Reprocess = "reprocess",
        /// The pixels of a packet compare for themselves; all else is shared.
        PerPixel = "per-pixel",
    }
}

choice! {
    /// How a packet's pixels map to shader invocations.
    enum Mapping, "mapping" {
        /// A packet is one invocation, which loops over its pixels [Yang09 alg. 2].
        Serial = "serial",
        /// A packet is one invocation for each pixel; all walk the same stack.
        Lanes = "lanes",
        /// A subgroup walks for those of its pixels that are alike: its lanes look at different nodes, then each at its pixel.
        Cooperative = "cooperative",
    }
}

choice! {
    /// How densely the nodes of the hierarchy over a shadow map stand.
    enum Hierarchy, "hierarchy" {
        /// Side by side [DU07]; a third of a node a texel.
        Hsm = "hsm",
        /// Side by side over the finest levels, at every texel of a coarse map above them [Schwarz08 §6].
        Ysm = "ysm",
        /// At every texel, in every level [SS07; Yang09 §4.2].
        Mssm = "mssm",
        /// At every texel of the first level, half a node's side apart above it.
        Graded = "graded",
    }
}

impl Hierarchy {
    /// [texel] Side of the coarse map of a YSM [Schwarz08 §6].
    const YSM_SIDE: u32 = 256;
    /// [level] Of a graded hierarchy, the last whose nodes stand at every texel.
    const GRADED: u32 = 1;

    /// Over a map of `map` × `map` texels.
    pub fn density(self, map: u32) -> Density {
        match self {
            Self::Hsm => Density::HSM,
            Self::Ysm => Density::ysm((map / Self::YSM_SIDE).max(1).ilog2()),
            Self::Mssm => Density::MSSM,
            Self::Graded => Density::graded(Self::GRADED),
        }
    }
}

choice! {
    /// Where the samples of a bitmask stand in the light's strata.
    enum Pattern, "sample pattern" {
        /// The light's samples stand in the middles of their strata.
        Regular = "regular",
        /// They stand anywhere in them, the same for all pixels.
        Jittered = "jittered",
    }
}

choice! {
    /// What texels stand for.
    enum Occluders, "kind of occluder" {
        /// The texels of a peeled layer are rectangles.
        Micropatches = "micropatches",
        /// The texels of a peeled layer have contours.
        Contours = "contours",
        /// Four neighbouring samples span a quadrangle.
        Microquads = "microquads",
        /// As micropatches, but that texels of coarser levels are rectangles of whatever size fits [Schwarz08 §5.2].
        Microrects = "microrects",
    }
}

/// A knob of [`Settings`].
pub type Knob = knob::Knob<Settings>;

choice! {
    /// From where the shadow-width map gets a texel's width.
    enum Neighbours, "neighbourhood" {
        /// From three neighbours, at distances that double.
        Three = "3",
        /// From six neighbours, at distances that double.
        Six = "6",
        /// From the nearest texel that nothing hides, found by jump flooding.
        Flood = "flood",
    }
}

choice! {
    /// In which format the shares of micropatches add up.
    enum Accumulate, "format of sums" {
        /// In 32 bits.
        Fp32 = "fp32",
        /// In 16 bits, which lose small shares [Atty06 app. A].
        Fp16 = "fp16",
    }
}

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

/// Knobs that every technique reads, whatever its lights.
const COMMON: [&str; 2] = ["map", "bias"];

/// [texel] A map of a point that is no larger is not made smaller.
const POINT_MAP: u32 = 128;

impl Settings {
    /// The settings that a technique is known by: rivals have a single view, as in their publications.
    pub fn usual(technique: Technique) -> Self {
        let mut usual = Self {
            technique,
            ..Self::default()
        };
        technique.method().make_usual(&mut usual);
        usual
    }

    /// The usual settings, but that every sub-light is integrated, as in the publications.
    pub fn published(technique: Technique) -> Self {
        Self {
            near_points: 0,
            ..Self::usual(technique)
        }
    }

    /// As they run for a light: one without extent casts a hard shadow, whatever the technique.
    pub fn of_light(&self, light: &AreaLight) -> Self {
        let mut settings = self.clone();
        if light.is_point() && self.technique != Technique::Hard {
            settings.technique = Technique::Hard;
            settings.percentage_closer = false;
        }
        settings
    }

    /// As they run for points of the light that stand for a part of it: hard shadows of which the mean counts. A quarter of
    /// the texels of large maps is enough, since a point's error is one of many.
    pub fn of_points(&self) -> Self {
        Self {
            technique: Technique::ReferenceMaps,
            map: (self.map / 2).max(self.map.min(POINT_MAP)),
            bias: None,
            ..self.clone()
        }
    }

    /// [texel] The bias that is asked for, or else the usual one, with which the technique errs least: what covers the
    /// way from a receiver to the samples that it is compared with.
    pub fn bias(&self) -> f32 {
        let usual = || self.technique.method().bias(self);
        self.bias.unwrap_or_else(usual)
    }

    /// Whether sub-lights that an occluder is near to give way to points.
    pub fn has_near_points(&self) -> bool {
        self.near_points > 0 && self.reads("near-points", false) == Some(true)
    }

    /// [level] Coarser than the map that a budget can take; None: there is no budget.
    pub fn coarse_levels(&self) -> Option<u32> {
        let whole = self.map.next_power_of_two().ilog2();
        (self.budget).map(|_| whole.saturating_sub(LEAST_BUDGET.ilog2()))
    }

    /// Whether it is the light's points that cast shadows, hard ones.
    pub fn samples_points(&self) -> bool {
        self.technique.method().samples_points()
    }

    /// Whether these settings read a flag, given without its dashes. None: no technique does, it is no knob.
    ///
    /// `point`: for a light without extent, whose shadow is hard whatever the technique.
    pub fn reads(&self, flag: &str, point: bool) -> Option<bool> {
        KNOBS.iter().find(|knob| knob.row.flag == flag)?;
        if COMMON.contains(&flag) {
            return Some(true);
        }
        let mut own = self.technique.method().knobs(self);
        if point {
            // Sub-lights have no extent either, and another technique's knobs are not asked for.
            own.retain(|knob| self.technique == Technique::Hard && *knob != "split");
        }
        let is_read = match flag {
            "technique" => !point || self.technique == Technique::Hard,
            "hierarchy" | "mssm-bits" => !point && Recipe::new(self).kernels,
            "counters" | "multisample" => true,
            "no-neighbour-visibility" => self.multisample > 1,
            _ => own.contains(&flag),
        };
        Some(is_read)
    }

    /// As a size of packets: they form where they are [Yang09 §6], among the pixels that the lanes of a subgroup hold.
    pub const LOCAL: (u32, u32) = knob::LOCAL;
    /// [pixel] What local packets form in.
    const WINDOW: (u32, u32) = (8, 8);

    /// [pixel] Width and height of what is listed as a packet: the packet, or what local ones form in.
    pub fn window(&self) -> (u32, u32) {
        match self.packet {
            Self::LOCAL => Self::WINDOW,
            packet => packet,
        }
    }

    /// How a packet maps to invocations: local ones have no choice.
    pub fn packet_mapping(&self) -> Mapping {
        match self.packet {
            Self::LOCAL => Mapping::Cooperative,
            _ => self.mapping,
        }
    }

    /// The specialization constants that the technique's shaders take, by name.
    pub fn constants(&self) -> Vec<(&'static str, u32)> {
        let read = KNOBS
            .iter()
            .filter(|knob| self.reads(knob.row.flag, false) == Some(true));
        let constant = |knob: &Knob| Some((knob.row.constant?, knob.number(self)));
        let mut constants: Vec<_> = read.filter_map(constant).collect();
        constants.extend(self.technique.method().constants(self));
        constants
    }

    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) when a setting is out of its range.
    pub fn validate(&self) -> Result<()> {
        KNOBS.iter().try_for_each(|knob| knob.check(self))?;
        let known = self.technique.method().occluders();
        match known.is_empty() || known.contains(&self.occluders) {
            true => Ok(()),
            false => {
                let names: Vec<String> = known.iter().map(Occluders::to_string).collect();
                Err(crate::Error::Invalid(format!(
                    "the occluders of {} are {}, not {}",
                    self.technique,
                    names.join(" or "),
                    self.occluders
                )))
            }
        }
    }
}
