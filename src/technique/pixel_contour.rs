//! Contours pixel by pixel [GBP07, as re-implemented in Yang09 §6]: with tight kernels from the MSSM,
//! without the adaptive precision of the original, which trades quality.
//!
//! Right and wrong as `packet_contour`, whose baseline it is: flat over every cell of the kernel, or
//! hierarchical over the MSSM.

use super::{CLASSIFY, KERNELS, PIXELS, Recipe, Stage, Work};
use crate::shot::Settings;

const FLAT: Stage = Stage {
    name: "contour_visibility",
    shader: "contour_visibility.comp",
    work: Work::Kernels,
};

pub fn recipe(settings: &Settings) -> Recipe {
    let stages = if settings.hierarchical {
        vec![KERNELS, CLASSIFY, PIXELS]
    } else {
        vec![KERNELS, FLAT]
    };
    Recipe { mssm: true, stages }
}
