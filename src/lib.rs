//! Soft shadows of area lights.
pub mod error;
pub mod gpu;
pub mod scene;
pub mod shared;
pub mod shot;
pub use error::{Error, Result};
