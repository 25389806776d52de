//! Shots that the program brings along: those of `scenes/`, which an installed program has not beside it.

use std::path::Path;

use super::{Overrides, Shot};
use crate::{Error, Result};

const BUILT_IN: [(&str, &[u8]); 5] = [
    ("knot", include_bytes!("../../scenes/knot.glb")),
    ("staircase", include_bytes!("../../scenes/staircase.glb")),
    ("grid", include_bytes!("../../scenes/grid.glb")),
    ("colonnade", include_bytes!("../../scenes/colonnade.glb")),
    ("tree", include_bytes!("../../scenes/tree.glb")),
];

impl Shot {
    /// A shot of `scenes/` by its name, that of the plate apart.
    ///
    /// # Errors
    /// There is none of this name, or the overrides make no sense.
    pub fn built_in(name: &str, overrides: &Overrides) -> Result<Self> {
        let found = BUILT_IN.iter().find(|(known, _)| *known == name);
        let (name, bytes) = found.ok_or_else(|| {
            let names = BUILT_IN.map(|(name, _)| name).join(", ");
            Error::Invalid(format!(
                "there is no shot {name:?} built in; choose one of {names}"
            ))
        })?;
        Self::from_gltf(Path::new(name), bytes, overrides)
    }
}
