//! Images in memory and in files: OpenEXR for numbers, PNG for looking at, all written atomically.

#[cfg(feature = "cli")]
mod atomic;
#[cfg(feature = "cli")]
mod exr_file;
#[cfg(feature = "cli")]
mod place;
#[cfg(feature = "cli")]
mod png_file;

#[cfg(feature = "cli")]
pub use atomic::{check_writable, write_atomically};
#[cfg(feature = "cli")]
pub use exr_file::{read_exr, write_exr};
#[cfg(feature = "cli")]
pub use place::is_same_file;
#[cfg(feature = "cli")]
pub use png_file::{RgbImage, read_png, write_png};

use crate::{Error, Result};

/// [sample] What readers of image files take by default, all channels together: 1 GiB of f32. Files that claim more are
/// refused before anything is allocated.
#[cfg(feature = "cli")]
pub const MAX_SAMPLES: u64 = 1 << 28;

/// Whether an image of so many samples per pixel may be read, or why not.
#[cfg(feature = "cli")]
fn check_samples(
    size: [u64; 2],
    channels: u64,
    max_samples: u64,
) -> std::result::Result<(), String> {
    let samples = size[0]
        .checked_mul(size[1])
        .and_then(|pixels| pixels.checked_mul(channels));
    match samples {
        Some(samples) if samples <= max_samples => Ok(()),
        _ => Err(format!(
            "claims to have {}x{} pixels of {channels} channels, more than the limit of {max_samples} samples",
            size[0], size[1]
        )),
    }
}

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

    /// Stretched to another size: between the values of four pixels, and beyond the outermost as these are. Of no pixels
    /// nothing is made.
    pub fn stretched(&self, width: usize, height: usize) -> Vec<f32> {
        let place = |i: usize, side: usize, own: usize| {
            let at = (i as f32 + 0.5) * own as f32 / side as f32 - 0.5;
            let at = at.clamp(0.0, own as f32 - 1.0);
            let first = at.floor() as usize;
            (first, (first + 1).min(own - 1), at - at.floor())
        };
        let value = |x: usize, y: usize| {
            let (left, right, across) = place(x, width, self.width);
            let (top, bottom, down) = place(y, height, self.height);
            let row = |row: usize| {
                let (a, b) = (
                    self.data[row * self.width + left],
                    self.data[row * self.width + right],
                );
                a + (b - a) * across
            };
            row(top) + (row(bottom) - row(top)) * down
        };
        let rows = 0..if self.data.is_empty() { 0 } else { height };
        rows.flat_map(|y| (0..width).map(move |x| value(x, y)))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_are_stretched_between_the_middles_of_their_pixels() {
        let plane = Plane::new(2, 2, vec![0.0, 1.0, 2.0, 3.0]).unwrap();
        assert_eq!(plane.stretched(2, 2), plane.data);
        assert_eq!(plane.stretched(1, 1), [1.5]);
        let wide = plane.stretched(4, 1);
        assert_eq!(wide, [1.0, 1.25, 1.75, 2.0]);
        assert!(Plane::new(0, 0, vec![]).unwrap().stretched(3, 3).is_empty());
    }
}
