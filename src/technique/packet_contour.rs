//! Packet-based hierarchical contours [Yang09]: coherent packets share the walk through the MSSM and the
//! extraction of contour edges; what is left over is integrated pixel by pixel.
//!
//! Right: the same visibility as [GBP07], at a fraction of its cost. Wrong: what a single view per
//! sub-light cannot see; occluders at different depths that overlap on the light count twice.
//! DEVIATION [Yang09]: samples below the receiver's plane do not occlude (`limit_at`), so that tilted surfaces are no
//! occluders of themselves.

use super::{CLASSIFY, KERNELS, PIXELS, Recipe, Stage, TURNS_OF_WALKS, Work};
use crate::shot::Settings;

const PACKETS: Stage = Stage {
    name: "packet_visibility",
    shader: "packet_visibility.comp",
    work: Work::PacketList,
};

/// A packet of a single pixel is a pixel: the pixel-wise path.
pub fn recipe(settings: &Settings) -> Recipe {
    let stages = if settings.packet == (1, 1) {
        vec![KERNELS, CLASSIFY, PIXELS]
    } else {
        vec![KERNELS, CLASSIFY, PACKETS, PIXELS]
    };
    Recipe {
        mssm: true,
        words: 1,
        turns: TURNS_OF_WALKS,
        stages,
        ..Recipe::default()
    }
}
