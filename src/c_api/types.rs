//! The types and constants of `halfshade.h`.

pub use super::types_context::*;
pub use super::types_render::*;
pub use super::types_scene::*;
