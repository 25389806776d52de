//! One image, completely: a scene, a camera, lights, a size and the settings of the technique.

use std::sync::Arc;

use crate::scene::{AreaLight, Camera, Scene};

/// What a leaf does whose status differs between the packet's pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Leaf {
    /// Null status: the whole packet goes to the pixel-wise list [Yang09 §4.1].
    Reprocess,
    /// The four comparisons are made for each pixel, all else is shared.
    PerPixel,
}

/// How a packet's pixels map to shader invocations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mapping {
    /// One invocation loops over the packet's pixels [Yang09 alg. 2].
    Serial,
    /// One invocation per pixel; all lanes of a packet walk the same stack.
    Lanes,
}

/// Which publication computes the visibility.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Technique {
    /// [Yang09], this engine's own.
    PacketContour,
    /// [GBP07] as re-implemented in [Yang09]: every cell of the kernel, pixel by pixel.
    PixelContour,
    /// [Williams78]: one nearest-sample test per view.
    Hard,
}

/// The knobs of a technique.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Settings {
    pub technique: Technique,
    /// [pixel] Width and height of a packet, each 1 to 8; 1×1 is the pixel-wise path.
    pub packet: (u32, u32),
    pub leaf: Leaf,
    pub mapping: Mapping,
    /// [1, 16] The light is cut into split × split sub-lights.
    pub split: u32,
    /// [texel] [16, 8192] Width and height of a shadow map.
    pub map: u32,
    /// Leave out nodes whose back-projection misses the light (`algorithm.md` §7).
    pub footprint_pruning: bool,
    /// `PixelContour` only: walk the MSSM instead of every cell.
    pub hierarchical: bool,
    /// [texel] Bias along the receiver's plane, in texels of its slope.
    pub bias: f32,
    /// Count pixels, packets, nodes and edges (costs time).
    pub counters: bool,
}

/// One image, completely.
#[derive(Debug, Clone)]
pub struct Shot {
    pub scene: Arc<Scene>,
    pub camera: Camera,
    /// [pixel]
    pub width: u32,
    /// [pixel]
    pub height: u32,
    pub lights: Vec<AreaLight>,
    pub settings: Settings,
    /// What the shot file asked for and is ignored, a sentence each.
    pub notes: Vec<String>,
}
