//! How different two pictures look.

use serde::Serialize;

use super::sizes_differ;
use crate::image::RgbImage;
use crate::{Error, Result};

/// Error between two pictures for looking at.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PictureMetrics {
    pub pixels: usize,
    /// [0, 1] Mean FLIP: the difference that an observer notices when the two pictures alternate, at 67
    /// pixels per degree (a 0.7 m wide 4K monitor seen from 0.7 m) [Andersson20].
    pub flip: f64,
    /// [0, 1] Root of the mean squared difference over all channels of the stored (sRGB) values / 255.
    pub rmse: f64,
}

/// Compares two pictures by FLIP and RMSE, and returns the FLIP map in the magma colours as well.
///
/// # Errors
/// When the sizes differ, or when a picture has no pixels.
pub fn compare_pictures(
    image: &RgbImage,
    reference: &RgbImage,
) -> Result<(PictureMetrics, Vec<u8>)> {
    let size = |picture: &RgbImage| [picture.width as usize, picture.height as usize];
    if size(image) != size(reference) {
        return Err(sizes_differ(size(image), size(reference)));
    }
    let [width, height] = size(image);
    let pixels = width * height;
    if pixels == 0
        || [image, reference]
            .iter()
            .any(|picture| picture.rgb8.len() != pixels * 3)
    {
        return Err(Error::Invalid(
            "a picture without pixels cannot be compared".into(),
        ));
    }
    let squares = image.rgb8.iter().zip(&reference.rgb8).map(|(&a, &b)| {
        let difference = (f64::from(a) - f64::from(b)) / 255.0;
        difference * difference
    });
    let rmse = (squares.sum::<f64>() / image.rgb8.len() as f64).sqrt();
    let upload = |picture: &RgbImage| {
        nv_flip::FlipImageRgb8::with_data(picture.width, picture.height, &picture.rgb8)
    };
    let map = nv_flip::flip(
        upload(reference),
        upload(image),
        nv_flip::DEFAULT_PIXELS_PER_DEGREE,
    );
    let flip = map.to_vec().iter().map(|&v| f64::from(v)).sum::<f64>() / pixels as f64;
    let colours = map.apply_color_lut(&nv_flip::magma_lut()).to_vec();
    Ok((PictureMetrics { pixels, flip, rmse }, colours))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures() {
        let picture = |value: u8| RgbImage {
            width: 16,
            height: 16,
            rgb8: vec![value; 16 * 16 * 3],
        };
        let (same, map) = compare_pictures(&picture(90), &picture(90)).unwrap();
        assert_eq!((same.pixels, same.rmse), (256, 0.0));
        assert!(same.flip < 1e-6, "{}", same.flip);
        assert_eq!(map.len(), 256 * 3);
        let (opposite, _) = compare_pictures(&picture(0), &picture(255)).unwrap();
        assert_eq!(opposite.rmse, 1.0);
        assert!(opposite.flip > 0.9, "{}", opposite.flip);
        let narrow = RgbImage {
            width: 8,
            height: 32,
            rgb8: vec![0; 16 * 16 * 3],
        };
        assert!(compare_pictures(&picture(0), &narrow).is_err());
    }
}
