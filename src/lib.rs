//! Soft shadows of area lights.
pub mod error;
pub mod gpu;
pub mod plan;
pub mod render;
pub mod scene;
pub mod shared;
pub mod shot;
pub mod sub_light;
pub mod technique;
pub use error::{Error, Result};
