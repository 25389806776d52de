//! Alpha of a texture at a point, as the GPU looks it up at mip level 0.

use crate::scene::{Texture, Wrap};

/// [0, 1] Alpha at texture coordinates `u`, `v`. The centre of texel i is at (i + ½) / width; between
/// centres alpha is bilinear where the texture is `linear`, else that of the nearest texel.
/// Coordinates that are not finite count as 0.
pub fn alpha(texture: &Texture, u: f64, v: f64) -> f64 {
    let [x, y] = [
        (u, texture.width, texture.wrap[0]),
        (v, texture.height, texture.wrap[1]),
    ]
    .map(|(coordinate, size, wrap)| Axis::new(coordinate, size, wrap));
    let texel = |[column, row]: [u32; 2]| {
        let index = (row as usize * texture.width as usize + column as usize) * 4 + 3;
        f64::from(texture.rgba.get(index).copied().unwrap_or(255)) / 255.0
    };
    if !texture.linear {
        return texel([x.nearest, y.nearest]);
    }
    let row = |row| mix(texel([x.pair[0], row]), texel([x.pair[1], row]), x.share);
    mix(row(y.pair[0]), row(y.pair[1]), y.share)
}

fn mix(a: f64, b: f64, share: f64) -> f64 {
    a + (b - a) * share
}

/// Where a coordinate falls along one axis.
struct Axis {
    /// [texel] The texel that holds the coordinate.
    nearest: u32,
    /// [texel] The two texels whose centres are left and right of it.
    pair: [u32; 2],
    /// [0, 1] How far it is from the first of them to the second.
    share: f64,
}

impl Axis {
    fn new(coordinate: f64, size: u32, wrap: Wrap) -> Self {
        let finite = if coordinate.is_finite() {
            coordinate
        } else {
            0.0
        };
        // Into one period first, so that no integer below can overflow.
        let inside = match wrap {
            Wrap::Repeat => finite.rem_euclid(1.0),
            Wrap::Mirror => finite.rem_euclid(2.0),
            Wrap::Clamp => finite.clamp(0.0, 1.0),
        };
        let position = inside * f64::from(size);
        let left = (position - 0.5).floor();
        let fold = |index: f64| fold(index as i64, i64::from(size.max(1)), wrap);
        Self {
            nearest: fold(position.floor()),
            pair: [fold(left), fold(left + 1.0)],
            share: position - 0.5 - left,
        }
    }
}

fn fold(index: i64, size: i64, wrap: Wrap) -> u32 {
    let folded = match wrap {
        Wrap::Repeat => index.rem_euclid(size),
        Wrap::Mirror => {
            let index = index.rem_euclid(2 * size);
            index.min(2 * size - 1 - index)
        }
        Wrap::Clamp => index.clamp(0, size - 1),
    };
    folded as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four texels in a row with the given alphas.
    fn row(alphas: [u8; 4], wrap: Wrap, linear: bool) -> Texture {
        let rgba = alphas.iter().flat_map(|&a| [0, 0, 0, a]).collect();
        Texture {
            width: 4,
            height: 1,
            rgba,
            wrap: [wrap; 2],
            linear,
        }
    }

    #[test]
    fn texel_centres_and_halfway() {
        let linear = row([0, 51, 102, 255], Wrap::Repeat, true);
        for (u, expected) in [
            (0.125, 0.0),
            (0.375, 0.2),
            (0.25, 0.1),
            (0.75, 0.7),
            (0.0, 0.5),
        ] {
            assert!((alpha(&linear, u, 0.3) - expected).abs() < 1e-12, "{u}");
        }
        let nearest = row([0, 51, 102, 255], Wrap::Repeat, false);
        for (u, expected) in [
            (0.0, 0.0),
            (0.24, 0.0),
            (0.26, 0.2),
            (0.99, 1.0),
            (1.0, 0.0),
        ] {
            assert_eq!(alpha(&nearest, u, 7.5), expected, "{u}");
        }
    }

    #[test]
    fn beyond_the_border() {
        let at = |wrap, u| alpha(&row([0, 51, 102, 255], wrap, false), u, 0.5);
        for (u, repeat, mirror, clamp) in [
            (-0.1, 1.0, 0.0, 0.0),
            (1.1, 0.0, 1.0, 1.0),
            (1.3, 0.2, 0.4, 1.0),
            (2.3, 0.2, 0.2, 1.0),
        ] {
            assert_eq!(at(Wrap::Repeat, u), repeat, "{u}");
            assert_eq!(at(Wrap::Mirror, u), mirror, "{u}");
            assert_eq!(at(Wrap::Clamp, u), clamp, "{u}");
        }
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
            for u in [f64::NAN, f64::INFINITY, -1e300, 1e300, -1e-300] {
                for linear in [false, true] {
                    let a = alpha(&row([0, 51, 102, 255], wrap, linear), u, u);
                    assert!((0.0..=1.0).contains(&a), "{wrap:?} {u}");
                }
            }
        }
    }
}
