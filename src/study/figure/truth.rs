//! What counts as true in an experiment, and where.

use glam::{DVec2, DVec3};

use crate::reference::bvh::{Bvh, Ray};
use crate::reference::pinhole::Pinhole;
use crate::shot::Shot;
use crate::technique::Settings;
use crate::{Error, Result};

use super::super::subject::Subject;

/// What the candidates of a trial are compared with.
#[derive(Debug, Clone, PartialEq)]
pub enum Truth {
    /// Rays, in all pixels.
    Rays,
    /// Rays, in the pixels that see the ground y = 0.
    OnGround,
    /// The closed form of a square's shadow, in the pixels that see the ground y = 0.
    Square(Square),
    /// What the renderer makes of these settings: what is found is how candidates differ from them.
    Rendered(Box<Settings>),
}

/// A horizontal square over the ground y = 0, under a square light that is parallel to it, with sides along x and z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Square {
    /// [scene units] Its centre.
    pub center: DVec3,
    /// [scene units] Half its side.
    pub half: f64,
    /// [radian] By which it is turned about y.
    pub turn: f64,
    /// [scene units] The light's centre, and half its side.
    pub light: DVec3,
    pub light_half: f64,
}

/// [scene units] What is no higher is ground: far above the rounding of its f32 coordinates.
const GROUND_HEIGHT: f64 = 1e-5;

impl Square {
    /// [0, 1] The share of the light that a point of the ground sees.
    pub fn visibility(&self, from: DVec3) -> f64 {
        let flat = |p: DVec3| DVec2::new(p.x, p.z);
        // Seen from the point, the square covers a larger square of the light's plane.
        let scale = self.light.y / self.center.y;
        let middle = flat(from) + (flat(self.center) - flat(from)) * scale - flat(self.light);
        let side = self.light_half;
        let mut hidden = vec![
            DVec2::new(-side, -side),
            DVec2::new(side, -side),
            DVec2::new(side, side),
            DVec2::new(-side, side),
        ];
        let along = DVec2::from_angle(self.turn);
        for normal in [along, along.perp(), -along, -along.perp()] {
            clip(&mut hidden, normal, normal.dot(middle) + self.half * scale);
        }
        1.0 - area(&hidden) / (4.0 * side * side)
    }
}

/// Leaves of a convex polygon the points p with normal · p ≤ limit.
fn clip(polygon: &mut Vec<DVec2>, normal: DVec2, limit: f64) {
    let beyond = |p: DVec2| normal.dot(p) - limit;
    let Some(&last) = polygon.last() else { return };
    let mut kept = Vec::new();
    let mut previous = last;
    for &current in polygon.iter() {
        let (before, after) = (beyond(previous), beyond(current));
        if (before > 0.0) != (after > 0.0) {
            kept.push(previous.lerp(current, before / (before - after)));
        }
        if after <= 0.0 {
            kept.push(current);
        }
        previous = current;
    }
    *polygon = kept;
}

fn area(polygon: &[DVec2]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    let twice: f64 = polygon.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum();
    0.5 * twice.abs()
}

impl Truth {
    /// Puts this truth in the place of the traced one, unless it is rendered, and leaves out the pixels where it says nothing. Returns how far
    /// the rays were off a closed form, on the mean over shadow pixels.
    ///
    /// # Errors
    /// The shot has more than one light, or cannot be traced.
    pub(super) fn apply(&self, subject: &mut Subject) -> Result<Option<f64>> {
        if matches!(self, Self::Rays | Self::Rendered(_)) {
            return Ok(None);
        }
        if subject.shot.lights.len() != 1 {
            return Err(Error::Invalid(
                "an experiment on the ground has one light".into(),
            ));
        }
        let (mut sum, mut count) = (0.0, 0usize);
        for (index, point) in ground(&subject.shot)?.into_iter().enumerate() {
            let Some(point) = point else {
                subject.facing.data[index] = f32::NAN;
                continue;
            };
            if let Self::Square(square) = self {
                let exact = square.visibility(point);
                if exact < 1.0 {
                    sum += (f64::from(subject.visibility.data[index]) - exact).abs();
                    count += 1;
                }
                subject.visibility.data[index] = exact as f32;
            }
        }
        Ok((count > 0).then(|| sum / count as f64))
    }
}

/// The point of the ground that each pixel sees, row by row from the top; None: it sees something else.
fn ground(shot: &Shot) -> Result<Vec<Option<DVec3>>> {
    let scene = &*shot.scene;
    let bvh = Bvh::new(scene, shot.origin())?;
    let pinhole = Pinhole::new(&shot.camera, shot.width, shot.height)?;
    let mut stack = Vec::new();
    let mut point = |x, y| {
        let (start, direction) = pinhole.ray(x, y);
        let hit = bvh.nearest(&Ray::new(start, direction), &mut stack, |_| true)?;
        let point = shot.origin() + start + direction * hit.t;
        (point.y.abs() <= GROUND_HEIGHT).then_some(point)
    };
    let (width, height) = (shot.width as usize, shot.height as usize);
    Ok((0..width * height)
        .map(|index| point(index % width, index / width))
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The plate of `scenes/plate.json`, whose shadow is known by hand.
    #[test]
    fn a_square_by_hand() {
        let square = Square {
            center: DVec3::new(0.0, 1.5, 0.0),
            half: 0.5,
            turn: 0.0,
            light: DVec3::new(0.0, 3.0, 0.0),
            light_half: 0.75,
        };
        let hidden = |s: f64| ((1.75 - s.abs()) / 1.5).clamp(0.0, 1.0);
        for (x, z) in [(0.0, 0.0), (0.5, -0.2), (1.0, 1.2), (1.8, 0.0), (-0.9, 0.3)] {
            let exact = 1.0 - hidden(x) * hidden(z);
            let found = square.visibility(DVec3::new(x, 0.0, z));
            assert!(
                (found - exact).abs() < 1e-12,
                "{found} at {x}, {z}: {exact}"
            );
        }
    }
}
