//! How far an image of visibility is from its reference.

mod picture;

use serde::{Deserialize, Serialize};

use crate::image::Plane;
use crate::number::sum;
use crate::{Error, Result};

pub use picture::{PictureMetrics, compare_pictures};

/// A pixel's `facing` at or above this counts as 1: the whole light is in front of the surface.
const WHOLLY_FACING: f32 = 1.0 - 1e-6;

/// An error above this is plainly visible; `Metrics::share_over_0_05` counts how often it occurs.
const NOTICEABLE: f64 = 0.05;

/// The error at which the heat map reaches its full colour.
pub const HEATMAP_FULL: f32 = 0.5;

/// What the colours of [`heatmap`] mean, in one sentence.
pub const HEATMAP_LEGEND: &str = "white: equal; blue: too dark; red: too bright (square-root scale, full colour at \
     an error of 0.5); grey: no surface, or left out; green: a surface in only one of the images";

/// Error of an image of visibility, `image − reference`. All sums are made in f64.
///
/// The figures over *shadow pixels* (reference < 1) are 0 when `shadow_pixels` is 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Metrics {
    /// Pixels compared: a surface in both images and, where `facing` was given, facing = 1.
    pub pixels: usize,
    /// Those of them whose reference is below 1.
    pub shadow_pixels: usize,
    /// Pixels that are NaN in only one of the two images; they are left out of all other figures.
    pub mismatched: usize,
    /// Pixels left out because their `facing` is below 1 or NaN.
    pub left_out_by_facing: usize,
    /// Mean absolute error.
    pub mae: f64,
    /// Root of the mean squared error.
    pub rmse: f64,
    /// Signed mean error; above 0 = too bright.
    pub bias: f64,
    /// Largest absolute error.
    pub max: f64,
    /// [0, 1] Share of the pixels with an absolute error above 0.05.
    pub share_over_0_05: f64,
    /// Mean absolute error over the shadow pixels.
    pub mae_shadow: f64,
    /// Root of the mean squared error over the shadow pixels.
    pub rmse_shadow: f64,
    /// Signed mean error over the shadow pixels; above 0 = too bright.
    pub bias_shadow: f64,
    /// 99th percentile of the absolute error over the shadow pixels (nearest rank).
    pub p99: f64,
    /// [0, 1] Share of the shadow pixels with an absolute error above 0.05.
    pub share_over_0_05_shadow: f64,
}

/// Compares an image of visibility with its reference.
///
/// Pixels that are NaN in either are left out. With `facing`, the share of the light in front of the
/// surface, so are all pixels where it is not 1: there the definition of visibility, not the
/// technique, is what would be measured.
///
/// # Errors
/// When sizes differ, when a value is infinite, or when no pixel is left to compare.
pub fn compare(image: &Plane, reference: &Plane, facing: Option<&Plane>) -> Result<Metrics> {
    check_sizes(image, reference)?;
    facing.map_or(Ok(()), |facing| check_sizes(facing, reference))?;
    let (mut mismatched, mut left_out_by_facing) = (0, 0);
    let mut all = Errors::default();
    let mut shadow = Errors::default();
    for (index, (&value, &truth)) in image.data.iter().zip(&reference.data).enumerate() {
        if value.is_infinite() || truth.is_infinite() {
            let (x, y) = (index % image.width, index / image.width);
            return Err(Error::Invalid(format!(
                "the pixel at ({x}, {y}) is infinite in one of the images"
            )));
        }
        if value.is_nan() || truth.is_nan() {
            mismatched += usize::from(value.is_nan() != truth.is_nan());
            continue;
        }
        if left_out(facing, index) {
            left_out_by_facing += 1;
            continue;
        }
        let error = f64::from(value) - f64::from(truth);
        all.add(error);
        if truth < 1.0 {
            shadow.add(error);
        }
    }
    if all.absolute.is_empty() {
        return Err(Error::Invalid(
            "no pixel has a surface in both images, so there is nothing to compare".into(),
        ));
    }
    Ok(Metrics {
        pixels: all.absolute.len(),
        shadow_pixels: shadow.absolute.len(),
        mismatched,
        left_out_by_facing,
        mae: all.mean_absolute(),
        rmse: all.root_mean_square(),
        bias: all.mean(),
        max: all.absolute.iter().copied().fold(0.0, f64::max),
        share_over_0_05: all.share_over(NOTICEABLE),
        mae_shadow: shadow.mean_absolute(),
        rmse_shadow: shadow.root_mean_square(),
        bias_shadow: shadow.mean(),
        share_over_0_05_shadow: shadow.share_over(NOTICEABLE),
        p99: shadow.percentile(0.99),
    })
}

/// The errors of some pixels; every figure is 0 when there are none.
#[derive(Default)]
struct Errors {
    sum: f64,
    absolute: Vec<f64>,
}

impl Errors {
    fn add(&mut self, error: f64) {
        self.sum += error;
        self.absolute.push(error.abs());
    }

    /// `sum` divided by the number of pixels.
    fn per_pixel(&self, sum: f64) -> f64 {
        sum / self.absolute.len().max(1) as f64
    }

    fn mean(&self) -> f64 {
        self.per_pixel(self.sum)
    }

    fn mean_absolute(&self) -> f64 {
        self.per_pixel(sum(self.absolute.iter().copied()))
    }

    fn root_mean_square(&self) -> f64 {
        self.per_pixel(sum(self.absolute.iter().map(|error| error * error)))
            .sqrt()
    }

    fn share_over(&self, threshold: f64) -> f64 {
        self.per_pixel(
            self.absolute
                .iter()
                .filter(|&&error| error > threshold)
                .count() as f64,
        )
    }

    /// The smallest error that at least `share` of the pixels do not exceed.
    fn percentile(mut self, share: f64) -> f64 {
        let rank = (share * self.absolute.len() as f64).ceil() as usize;
        if rank == 0 {
            return 0.0;
        }
        *self
            .absolute
            .select_nth_unstable_by(rank - 1, f64::total_cmp)
            .1
    }
}

fn check_sizes(a: &Plane, b: &Plane) -> Result<()> {
    if (a.width, a.height) == (b.width, b.height) {
        return Ok(());
    }
    Err(sizes_differ([a.width, a.height], [b.width, b.height]))
}

fn sizes_differ([wa, ha]: [usize; 2], [wb, hb]: [usize; 2]) -> Error {
    Error::Invalid(format!(
        "the images differ in size ({wa}×{ha} and {wb}×{hb} pixels), so they cannot be compared"
    ))
}

/// A picture of the signed error, colours as in [`HEATMAP_LEGEND`]; with `facing`, what [`compare`]
/// leaves out is grey. The square-root scale keeps small errors in sight: 0.02 has a fifth of the
/// full colour.
///
/// # Errors
/// When the sizes differ.
pub fn heatmap(image: &Plane, reference: &Plane, facing: Option<&Plane>) -> Result<Vec<u8>> {
    check_sizes(image, reference)?;
    facing.map_or(Ok(()), |facing| check_sizes(facing, reference))?;
    let color = |(index, (&value, &truth))| match left_out(facing, index) {
        true => heat(f32::NAN, f32::NAN),
        false => heat(value, truth),
    };
    let pixels = image.data.iter().zip(&reference.data).enumerate();
    Ok(pixels.flat_map(color).collect())
}

/// Whether the surface in a pixel does not face the whole light, or is none.
fn left_out(facing: Option<&Plane>, index: usize) -> bool {
    facing.is_some_and(|facing| !faces_wholly(facing.data[index]))
}

/// Whether a pixel with this `facing` has a surface that faces the whole light.
pub(crate) fn faces_wholly(facing: f32) -> bool {
    facing >= WHOLLY_FACING
}

/// The colour of one pixel. The ramps are ColorBrewer's RdBu (safe for the colour-blind) with white
/// in the middle.
fn heat(value: f32, truth: f32) -> [u8; 3] {
    const NEITHER: [u8; 3] = [128, 128, 128];
    const ONLY_ONE: [u8; 3] = [0, 150, 60];
    const TOO_DARK: [[f32; 3]; 3] = [[255.0; 3], [103.0, 169.0, 207.0], [5.0, 48.0, 97.0]];
    const TOO_BRIGHT: [[f32; 3]; 3] = [[255.0; 3], [239.0, 138.0, 98.0], [103.0, 0.0, 31.0]];
    match (value.is_nan(), truth.is_nan()) {
        (true, true) => return NEITHER,
        (false, false) => {}
        _ => return ONLY_ONE,
    }
    let error = value - truth;
    let ramp = if error < 0.0 { TOO_DARK } else { TOO_BRIGHT };
    let position = 2.0 * (error.abs() / HEATMAP_FULL).sqrt().min(1.0);
    let (from, share) = if position < 1.0 {
        (0, position)
    } else {
        (1, position - 1.0)
    };
    let mix = |c: usize| ramp[from][c] + (ramp[from + 1][c] - ramp[from][c]) * share;
    [mix(0), mix(1), mix(2)].map(|v| v.round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAN: f32 = f32::NAN;

    fn row(values: &[f32]) -> Plane {
        Plane::new(values.len(), 1, values.to_vec()).unwrap()
    }

    #[test]
    fn figures_by_hand() {
        // Errors: 0, +0.25, −0.5, (lit) −0.25; dyadic numbers, so that the sums are exact.
        let image = row(&[0.5, 0.75, 0.25, 0.75]);
        let reference = row(&[0.5, 0.5, 0.75, 1.0]);
        let m = compare(&image, &reference, None).unwrap();
        assert_eq!(
            (
                m.pixels,
                m.shadow_pixels,
                m.mismatched,
                m.left_out_by_facing
            ),
            (4, 3, 0, 0)
        );
        assert_eq!(
            (m.mae, m.bias, m.max, m.share_over_0_05),
            (0.25, -0.125, 0.5, 0.75)
        );
        assert_eq!(m.rmse, (0.375f64 / 4.0).sqrt());
        assert_eq!(
            (m.mae_shadow, m.bias_shadow, m.p99),
            (0.25, -0.25 / 3.0, 0.5)
        );
        assert_eq!(m.rmse_shadow, (0.3125f64 / 3.0).sqrt());
        assert_eq!(m.share_over_0_05_shadow, 2.0 / 3.0);
    }

    #[test]
    fn pixels_without_surface_are_left_out_and_counted() {
        let image = row(&[NAN, NAN, 0.5, 0.5]);
        let reference = row(&[NAN, 1.0, NAN, 0.25]);
        let m = compare(&image, &reference, None).unwrap();
        assert_eq!(
            (m.pixels, m.shadow_pixels, m.mismatched, m.mae),
            (1, 1, 2, 0.25)
        );
    }

    #[test]
    fn only_pixels_that_face_the_whole_light_count() {
        let image = row(&[1.0, 1.0, 1.0, 0.5]);
        let reference = row(&[0.0, 0.0, 0.5, 0.5]);
        let facing = row(&[0.999, NAN, 1.0, 0.9999999]);
        let m = compare(&image, &reference, Some(&facing)).unwrap();
        assert_eq!((m.pixels, m.left_out_by_facing, m.mae), (2, 2, 0.25));
    }

    #[test]
    fn the_percentile_is_the_nearest_rank() {
        let reference = row(&[0.0; 200]);
        let image = row(&(0..200).map(|i| i as f32 / 256.0).collect::<Vec<_>>());
        // 99 % of 200 pixels are 198: the 198th smallest error.
        assert_eq!(
            compare(&image, &reference, None).unwrap().p99,
            197.0 / 256.0
        );
    }

    #[test]
    fn without_shadow_the_shadow_figures_are_zero() {
        let m = compare(&row(&[0.5, 1.0]), &row(&[1.0, 1.0]), None).unwrap();
        assert_eq!(
            (m.shadow_pixels, m.mae_shadow, m.rmse_shadow, m.p99),
            (0, 0.0, 0.0, 0.0)
        );
        let text = serde_json::to_string(&m).unwrap();
        assert!(!text.contains("-0.0"), "{text}");
        assert_eq!(m.mae, 0.25);
    }

    #[test]
    fn what_cannot_be_compared_is_an_error() {
        let one = row(&[1.0]);
        assert!(compare(&one, &row(&[1.0, 1.0]), None).is_err());
        assert!(compare(&one, &one, Some(&row(&[1.0, 1.0]))).is_err());
        assert!(compare(&row(&[f32::INFINITY]), &one, None).is_err());
        assert!(compare(&row(&[NAN]), &one, None).is_err());
        assert!(heatmap(&one, &row(&[1.0, 1.0]), None).is_err());
    }

    #[test]
    fn the_heat_map_says_which_way_and_how_far() {
        let image = row(&[0.5, 0.0, 1.0, 0.375, NAN, NAN]);
        let reference = row(&[0.5, 1.0, 0.0, 0.5, NAN, 1.0]);
        let map = heatmap(&image, &reference, None).unwrap();
        let colours: Vec<_> = map.chunks(3).collect();
        assert_eq!(colours[0], [255, 255, 255]);
        assert_eq!(colours[1], [5, 48, 97]);
        assert_eq!(colours[2], [103, 0, 31]);
        // A quarter of the full error has half the full colour.
        assert_eq!(colours[3], [103, 169, 207]);
        assert_eq!(colours[4], [128, 128, 128]);
        assert_eq!(colours[5], [0, 150, 60]);
        let facing = row(&[1.0, 0.5, 1.0, 1.0, NAN, 1.0]);
        let masked = heatmap(&image, &reference, Some(&facing)).unwrap();
        assert_eq!(masked[3..6], [128; 3]);
        assert_eq!(masked[6..12], map[6..12]);
    }
}
