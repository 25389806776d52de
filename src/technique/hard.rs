//! Hard shadows from the nearest sample [Williams78]; with split > 1 the mean of as many hard shadows.
//!
//! Right: lights without extent. Wrong: every penumbra; edges alias in steps of a texel.

use super::{Recipe, Stage, Work};

pub fn recipe() -> Recipe {
    let stage = Stage {
        name: "hard_visibility",
        shader: "hard_visibility.comp",
        work: Work::Pixels,
    };
    Recipe {
        mssm: false,
        stages: vec![stage],
    }
}
