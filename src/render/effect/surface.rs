//! What formats of a host's images tell: which can be what, and how exactly they hold a surface.

use ash::vk::Format;

use crate::error::{Error, Result};
use crate::frame::Surface;

/// By how much a number may be off that an image holds: a share of itself, and as much again whatever it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rounding {
    pub share: f32,
    pub step: f32,
}

/// What rasterisers and matrices in 32 bits round off a depth: four units in the last place of 1.
const ARITHMETIC: f32 = 1.0 / (1 << 22) as f32;

impl Rounding {
    const fn new(share: f32, step: f32) -> Self {
        Self { share, step }
    }

    /// A number without a sign of so many bits, that stands for a share of 1.
    const fn fixed(bits: u32) -> Self {
        Self::new(ARITHMETIC, 0.5 / ((1u32 << bits) - 1) as f32)
    }

    /// Of a surface in this format; None: it cannot hold one.
    fn of(format: Format, surface: Surface) -> Option<Self> {
        let half = Self::new(1.0 / 2048.0, 1.0 / (1 << 25) as f32);
        match (surface, format) {
            (Surface::Depths, Format::D32_SFLOAT | Format::D32_SFLOAT_S8_UINT) => {
                Some(Self::new(ARITHMETIC, 0.0))
            }
            (Surface::Depths, Format::R32_SFLOAT) => Some(Self::new(ARITHMETIC, 0.0)),
            (Surface::Depths, Format::R16_SFLOAT) => Some(half),
            (Surface::Depths, Format::D24_UNORM_S8_UINT | Format::X8_D24_UNORM_PACK32) => {
                Some(Self::fixed(24))
            }
            (
                Surface::Depths,
                Format::D16_UNORM | Format::D16_UNORM_S8_UINT | Format::R16_UNORM,
            ) => Some(Self::fixed(16)),
            // What 32 bits round off, the engine's own bias covers.
            (Surface::Positions, Format::R32G32B32A32_SFLOAT) => Some(Self::new(0.0, 0.0)),
            (Surface::Positions, Format::R16G16B16A16_SFLOAT) => Some(half),
            _ => None,
        }
    }
}

/// How exactly an image of this format holds a surface.
///
/// # Errors
/// It cannot hold one.
pub fn rounding(format: Format, surface: Surface) -> Result<Rounding> {
    Rounding::of(format, surface).ok_or_else(|| {
        let (what, formats) = match surface {
            Surface::Depths => ("depths", "a depth format, R32_SFLOAT, R16_SFLOAT or R16_UNORM"),
            Surface::Positions => (
                "positions",
                "R32G32B32A32_SFLOAT or R16G16B16A16_SFLOAT, with alpha more than 0 where there is a surface",
            ),
        };
        Error::Invalid(format!(
            "surface: {format:?} cannot hold {what}; lend an image in {formats}"
        ))
    })
}

/// Whether shaders read and write a format as fractions: it has no integers, and it is a colour.
pub fn is_fractional_color(format: Format) -> bool {
    let name = format!("{format:?}");
    let is_integer = ["UINT", "SINT", "USCALED", "SSCALED"]
        .iter()
        .any(|kind| name.contains(kind));
    let is_depth = name.starts_with('D') || name.starts_with("X8_D24") || name.starts_with("S8");
    !is_integer && !is_depth
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coarser_formats_are_off_by_more() {
        let step = |format| {
            rounding(format, Surface::Depths)
                .expect("a depth format")
                .step
        };
        assert!(step(Format::D16_UNORM) > 200.0 * step(Format::D24_UNORM_S8_UINT));
        assert_eq!(step(Format::D32_SFLOAT), 0.0);
        let positions = |format| rounding(format, Surface::Positions);
        assert!(
            positions(Format::R16G16B16A16_SFLOAT)
                .expect("it can")
                .share
                > 1e-4
        );
        for format in [
            Format::R32G32B32A32_UINT,
            Format::R32_UINT,
            Format::R32_SFLOAT,
            Format::D32_SFLOAT,
            Format::R8G8B8A8_UNORM,
        ] {
            let message = positions(format).expect_err("it cannot").to_string();
            assert!(message.starts_with("surface: "), "{message}");
        }
        assert!(rounding(Format::R32G32B32A32_SFLOAT, Surface::Depths).is_err());
    }

    #[test]
    fn what_is_a_color_of_fractions() {
        for format in [
            Format::R8_UNORM,
            Format::R16G16B16A16_SFLOAT,
            Format::B8G8R8A8_SRGB,
        ] {
            assert!(is_fractional_color(format), "{format:?}");
        }
        for format in [
            Format::R8_UINT,
            Format::R32G32_SINT,
            Format::D32_SFLOAT,
            Format::S8_UINT,
        ] {
            assert!(!is_fractional_color(format), "{format:?}");
        }
    }
}
