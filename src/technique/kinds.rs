//! The choices that knobs of techniques have, by name.

use super::choice::choice;
use crate::frame::Density;

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

choice! {
    /// Which penumbra pixels are evaluated; the others are joined from these.
    enum Evaluate, "share of pixels to evaluate" {
        /// All.
        Full = "full",
        /// Half of them along a side of a tile, where those around them are of one surface and all penumbra.
        Half = "half",
        /// A quarter of them along a side, or else half.
        Quarter = "quarter",
    }
}

impl Evaluate {
    /// [grid] Sparser than that of all pixels, up to this one.
    pub const fn grids(self) -> u32 {
        match self {
            Self::Full => 0,
            Self::Half => 1,
            Self::Quarter => 2,
        }
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
