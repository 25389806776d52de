//! A sphere. A receiver sees it as the disc through its centre that faces the receiver; its maps are those of discs that each
//! face a cone of receivers.

use glam::DVec3;

use super::{Form, Outline, Spread, radius_fault, some_frame};
use crate::shared::{CONE_COUNT, CONE_SPLIT};

pub fn form(radius: f64) -> Form {
    Form {
        frame: some_frame(DVec3::NEG_Y),
        half_size: (radius, radius),
        outline: Outline::Disc,
        spread: match radius {
            0.0 => Spread::Point,
            _ => Spread::Sphere,
        },
    }
}

pub fn fault(radius: f64) -> Option<&'static str> {
    radius_fault(radius)
}

/// A cell of the sides of a cube around a light, seen from its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// Unit vectors: the first towards the cube's side.
    axes: [DVec3; 3],
    /// Tangents along the two others.
    lower: [f64; 2],
    upper: [f64; 2],
}

impl Cone {
    pub const COUNT: usize = CONE_COUNT as usize;

    /// As `cone_of` in `lib/cone.glsl` numbers them.
    pub fn new(index: usize) -> Self {
        let split = CONE_SPLIT as usize;
        let (side, cell) = (index / (split * split), index % (split * split));
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let sense = [1.0, -1.0][side % 2];
        let axis = |step: usize| axes[(side / 2 + step) % 3];
        let border = |line: usize| 2.0 * line as f64 / CONE_SPLIT as f64 - 1.0;
        let cell = [cell % split, cell / split];
        Self {
            axes: [axis(0) * sense, axis(1), axis(2)],
            lower: cell.map(border),
            upper: cell.map(|line| border(line + 1)),
        }
    }

    /// Unit vector through its middle.
    pub fn middle(&self) -> DVec3 {
        let along = |axis: usize| {
            let angle = 0.5 * (self.lower[axis].atan() + self.upper[axis].atan());
            self.axes[axis + 1] * angle.tan()
        };
        (self.axes[0] + along(0) + along(1)).normalize()
    }

    /// [radian] Between the middle and the farthest of its corners.
    pub fn half_angle(&self) -> f64 {
        let sides = [self.lower, self.upper];
        let corners = (0..4).map(|i| {
            let [first, second] = [sides[i & 1][0], sides[i >> 1][1]];
            (self.axes[0] + self.axes[1] * first + self.axes[2] * second).normalize()
        });
        let cosines = corners.map(|corner| corner.dot(self.middle()));
        cosines.fold(1.0, f64::min).acos()
    }

    /// How far a way from the centre is inside each of its four sides; ≥ 0 within and at what rounding makes of the border.
    pub fn distances(&self) -> [DVec3; 4] {
        const ROUNDING: f64 = 1e-5;
        let [forward, first, second] = self.axes;
        [
            first - forward * (self.lower[0] - ROUNDING),
            forward * (self.upper[0] + ROUNDING) - first,
            second - forward * (self.lower[1] - ROUNDING),
            forward * (self.upper[1] + ROUNDING) - second,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cones_share_the_directions() {
        for index in 0..Cone::COUNT {
            let middle = Cone::new(index).middle();
            let holding = (0..Cone::COUNT).filter(|&other| {
                let planes = Cone::new(other).distances();
                planes.iter().all(|plane| plane.dot(middle) > 0.0)
            });
            assert_eq!(holding.collect::<Vec<_>>(), [index]);
        }
    }
}
