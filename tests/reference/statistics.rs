//! Whether deviations look like noise of the size that the image states.

use halfshade::reference::ReferenceImage;

use crate::stage::floor_points;

/// How the traced image deviates from a closed form, in standard deviations.
pub struct Deviation {
    /// Of the sum of all errors: is the image biased?
    bias: f64,
    /// Of the sum of (error² − stated variance): is the stated standard error right?
    spread: f64,
    penumbra: usize,
}

pub fn deviation(image: &ReferenceImage, truth: impl Fn(f64, f64) -> f64) -> Deviation {
    let (mut sum, mut variance, mut excess, mut excess_squares, mut penumbra) =
        (0.0, 0.0, 0.0, 0.0, 0);
    for (index, x, z) in floor_points() {
        let expected = truth(x, z);
        let value = f64::from(image.visibility.data[index]);
        let stated = f64::from(image.standard_error.data[index]).powi(2);
        let error = value - expected;
        // Umbra and light need no statistics (within rounding of the closed form at their borders).
        if !(1e-6..=1.0 - 1e-6).contains(&expected) {
            assert!(
                error.abs() < 1e-6 && stated == 0.0,
                "{value} is not {expected} at ({x}, {z})"
            );
            continue;
        }
        penumbra += 1;
        sum += error;
        variance += stated;
        excess += error * error - stated;
        excess_squares += (error * error - stated).powi(2);
    }
    Deviation {
        bias: sum / variance.sqrt(),
        spread: excess / excess_squares.sqrt(),
        penumbra,
    }
}

#[track_caller]
pub fn assert_agrees(image: &ReferenceImage, truth: impl Fn(f64, f64) -> f64) {
    let found = deviation(image, &truth);
    assert!(
        found.penumbra > 400,
        "only {} pixels are in penumbra",
        found.penumbra
    );
    assert!(
        found.bias.abs() < 4.0,
        "biased by {:.1} standard deviations",
        found.bias
    );
    assert!(
        found.spread.abs() < 4.0,
        "the stated error is off by {:.1} standard deviations",
        found.spread
    );
    // The test has teeth: it would notice a light that is wrong by half a per cent.
    let wrong = |x: f64, z: f64| match truth(x, z) {
        v if (1e-6..=1.0 - 1e-6).contains(&v) => (v + 0.005).min(1.0 - 2e-6),
        v => v,
    };
    assert!(deviation(image, wrong).bias.abs() > 10.0);
}
