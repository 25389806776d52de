//! Soft shadows of area lights.
pub mod error;
pub mod scene;
pub mod shot;
pub use error::{Error, Result};
