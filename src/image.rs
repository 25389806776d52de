//! Images in memory and in files: OpenEXR for numbers, PNG for looking at, all written atomically.

#[cfg(feature = "cli")]
mod atomic;
#[cfg(feature = "cli")]
mod exr_file;
#[cfg(feature = "cli")]
mod png_file;

#[cfg(feature = "cli")]
pub use atomic::{check_writable, write_atomically};
#[cfg(feature = "cli")]
pub use exr_file::{read_exr, write_exr};
#[cfg(feature = "cli")]
pub use png_file::{RgbImage, read_png, write_png};

use crate::{Error, Result};

/// A single-channel image. What a value means, and that NaN stands for "nothing here", is up to the
/// channel.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// [pixel]
    pub width: usize,
    /// [pixel]
    pub height: usize,
    /// width × height values, the top row first.
    pub data: Vec<f32>,
}

impl Plane {
    /// # Errors
    /// When `data` does not hold width × height values.
    pub fn new(width: usize, height: usize, data: Vec<f32>) -> Result<Self> {
        if width.checked_mul(height) != Some(data.len()) {
            return Err(Error::Invalid(format!(
                "an image of {width}×{height} pixels cannot have {} values",
                data.len()
            )));
        }
        Ok(Self {
            width,
            height,
            data,
        })
    }
}
