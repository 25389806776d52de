//! Images of what is left of a budget of micro-occluders [Schwarz08 §4.2].

use std::io::Cursor;
use std::path::Path;

use image::{ImageReader, Limits};

use super::MAX_SIZE;
use crate::image::Plane;
use crate::scene::file;
use crate::{Error, Result};

/// [byte] That decoding may take: a few times what an image of the largest side and 1:4 takes in 32 bits.
const MAX_BYTES: u64 = 1 << 30;

/// [0, 1] Shares, of a PNG, JPEG or WebP: white is 1, black 0, grey values in between are proportional. Colours count by
/// their luma.
///
/// # Errors
/// The file cannot be read, or is no such image.
pub(super) fn read(path: &Path) -> Result<Plane> {
    let broken = |error: image::ImageError| {
        Error::parse(path, format!("is not an image of budgets: {error}"))
    };
    let bytes = file::read(path)?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIZE);
    limits.max_image_height = Some(MAX_SIZE);
    limits.max_alloc = Some(MAX_BYTES);
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|source| Error::io(path, source))?;
    reader.limits(limits);
    let grey = reader.decode().map_err(broken)?.into_luma16();
    let share = |value: &u16| f32::from(*value) / f32::from(u16::MAX);
    let (width, height) = grey.dimensions();
    let shares = grey.as_raw().iter().map(share).collect();
    Plane::new(width as usize, height as usize, shares)
}
