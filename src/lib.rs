//! Soft shadows of area lights.
#[cfg(feature = "capi")]
pub mod c_api;
#[cfg(feature = "cli")]
pub mod calibrate;
#[cfg(feature = "cli")]
pub mod compare;
#[cfg(feature = "reference")]
pub mod cpu;
pub mod error;
pub mod frame;
pub mod gpu;
#[cfg(feature = "reference")]
pub mod image;
pub mod number;
pub mod plan;
pub mod render;
pub mod scene;
pub mod shared;
pub mod shot;
#[cfg(feature = "cli")]
pub mod spread;
#[cfg(feature = "cli")]
pub mod study;
pub mod sub_light;
pub mod technique;
pub use error::{Error, Result};
