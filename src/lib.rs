//! Soft shadows of area lights.
#[cfg(feature = "cli")]
pub mod compare;
pub mod error;
#[cfg(feature = "cli")]
pub mod image;
pub mod scene;
pub mod shot;
pub use error::{Error, Result};
