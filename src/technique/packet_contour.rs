//! Packet-based hierarchical contours [Yang09]: coherent packets share the walk through the MSSM and the
//! extraction of contour edges; what is left over is integrated pixel by pixel.
//!
//! Right: the same visibility as [GBP07], at a fraction of its cost. Wrong: what a single view per
//! sub-light cannot see; occluders at different depths that overlap on the light count twice.
//! DEVIATION [Yang09]: samples below the receiver's plane do not occlude (`limit_at`), so that tilted surfaces are no
//! occluders of themselves.

use super::{CLASSIFY, KERNELS, PIXELS, Recipe, TURNS_OF_WALKS, once};
use crate::frame::{Domain, Pass};
use crate::shot::Settings;

const PACKETS: Pass = Pass::dispatch(
    "packet_visibility",
    "packet_visibility.comp",
    Domain::PacketList,
);

/// A packet of a single pixel is a pixel: the pixel-wise path.
pub fn recipe(settings: &Settings) -> Recipe {
    let passes = if settings.packet == (1, 1) {
        once([KERNELS, CLASSIFY, PIXELS])
    } else {
        once([KERNELS, CLASSIFY, PACKETS, PIXELS])
    };
    Recipe {
        mssm: true,
        words: 1,
        turns: TURNS_OF_WALKS,
        passes,
        ..Recipe::default()
    }
}
