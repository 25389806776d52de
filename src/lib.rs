//! Soft shadows of area lights.
#[cfg(feature = "cli")]
pub mod compare;
#[cfg(feature = "cli")]
pub mod cpu;
pub mod error;
#[cfg(feature = "cli")]
pub mod image;
pub mod scene;
pub mod shot;
pub use error::{Error, Result};
