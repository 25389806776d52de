//! PNG: images to look at.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use image::codecs::png::PngEncoder;
use image::{
    DynamicImage, ExtendedColorType, ImageDecoder, ImageEncoder, ImageFormat, ImageReader,
};

use super::{check_samples, write_atomically};
use crate::{Error, Result};

/// An 8-bit sRGB picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RgbImage {
    /// [pixel]
    pub width: u32,
    /// [pixel]
    pub height: u32,
    /// width × height × RGB, the top row first.
    pub rgb8: Vec<u8>,
}

impl RgbImage {
    /// Drops the alpha of width × height × RGBA bytes.
    pub fn from_rgba(width: u32, height: u32, rgba: &[u8]) -> Self {
        let rgb = rgba.chunks_exact(4).flat_map(|pixel| &pixel[..3]);
        Self {
            width,
            height,
            rgb8: rgb.copied().collect(),
        }
    }

    /// Writes the picture to a file.
    ///
    /// # Errors
    /// As for [`write_png`].
    pub fn write(&self, path: &Path) -> Result<()> {
        write_png(path, self.width, self.height, &self.rgb8)
    }
}

/// Writes width × height × RGB bytes (sRGB, the top row first).
///
/// # Errors
/// When `rgb8` has not that length, or the file cannot be written.
pub fn write_png(path: &Path, width: u32, height: u32, rgb8: &[u8]) -> Result<()> {
    if rgb8.is_empty() || rgb8.len() as u64 != u64::from(width) * u64::from(height) * 3 {
        let length = rgb8.len();
        return Err(Error::Invalid(format!(
            "a picture of {width}×{height} pixels cannot have {length} bytes"
        )));
    }
    write_atomically(path, |file| {
        PngEncoder::new(file)
            .write_image(rgb8, width, height, ExtendedColorType::Rgb8)
            .map_err(std::io::Error::other)
    })
}

/// Reads a picture; an alpha channel is dropped, grey becomes RGB, 16 bits become 8.
///
/// # Errors
/// When the file is missing, is not a PNG, is damaged, or claims more than `max_samples`.
pub fn read_png(path: &Path, max_samples: u64) -> Result<RgbImage> {
    let file = File::open(path).map_err(|source| Error::io(path, source))?;
    let unreadable = |error| Error::parse(path, format!("is not a readable PNG ({error})"));
    let mut reader = ImageReader::with_format(BufReader::new(file), ImageFormat::Png);
    // The limit is that on samples.
    reader.no_limits();
    let decoder = reader.into_decoder().map_err(unreadable)?;
    let (width, height) = decoder.dimensions();
    let channels = decoder.color_type().channel_count().max(3);
    check_samples([width.into(), height.into()], channels.into(), max_samples)
        .map_err(|message| Error::parse(path, message))?;
    let picture = DynamicImage::from_decoder(decoder).map_err(unreadable)?;
    let picture = picture.into_rgb8();
    let (width, height) = picture.dimensions();
    let rgb8 = picture.into_raw();
    Ok(RgbImage {
        width,
        height,
        rgb8,
    })
}

#[cfg(test)]
mod tests {
    use super::super::MAX_SAMPLES;
    use super::*;

    #[test]
    fn what_was_written_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let rgb8: Vec<u8> = (0..5 * 3 * 3).map(|i| i as u8 * 5).collect();
        write_png(&path, 5, 3, &rgb8).unwrap();
        let read = read_png(&path, MAX_SAMPLES).unwrap();
        assert_eq!((read.width, read.height, read.rgb8), (5, 3, rgb8));
    }

    #[test]
    fn wrong_lengths_and_other_files_are_errors() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        assert!(write_png(&path, 2, 2, &[0; 11]).is_err());
        assert!(write_png(&path, 0, 0, &[]).is_err());
        assert!(read_png(&path, MAX_SAMPLES).is_err());
        std::fs::write(&path, "not a picture").unwrap();
        assert!(
            read_png(&path, MAX_SAMPLES)
                .unwrap_err()
                .to_string()
                .contains("not a readable PNG")
        );
    }
}
