//! Sector tables: the area that is swept around a sub-light's centre.

use glam::DVec2;

use super::cut::Remnant;
use crate::shared::SECTOR_STEPS;

/// [half sizes²] Area swept from direction 0 up to each of `SECTOR_STEPS` + 1 equally spaced perimeter parameters, 0 to 8.
pub fn sectors(part: &Remnant) -> Vec<f32> {
    const SUBSTEPS: u32 = 8;
    let mut table = vec![0.0f32];
    let mut swept = 0.0;
    let step = 8.0 / f64::from(SECTOR_STEPS * SUBSTEPS);
    for entry in 0..SECTOR_STEPS {
        for substep in 0..SUBSTEPS {
            let from = f64::from(entry * SUBSTEPS + substep) * step;
            // Simpson's rule on ½ ρ² dθ.
            swept += (density(part, from)
                + 4.0 * density(part, from + 0.5 * step)
                + density(part, from + step))
                * step
                / 6.0;
        }
        table.push(swept as f32);
    }
    table
}

/// ½ ρ² dθ/dP at perimeter parameter P: with a direction q on the unit square, ρ = s |q| where s q
/// lies on the border, and |q|² dθ/dP = 1.
fn density(part: &Remnant, parameter: f64) -> f64 {
    0.5 * border(part, direction(parameter)).powi(2)
}

/// How many times `direction` reaches from the centre to the border.
fn border(part: &Remnant, direction: DVec2) -> f64 {
    let (lower, upper) = part.extent;
    let mut reach = f64::INFINITY;
    for axis in 0..2 {
        if direction[axis] != 0.0 {
            let side = if direction[axis] > 0.0 {
                upper[axis]
            } else {
                lower[axis]
            };
            reach = reach.min(side / direction[axis]);
        }
    }
    reach.min(part.cut.border(direction))
}

/// The point of the unit square's border with perimeter parameter P: 0 at +x, 2 at +y, 4 at −x, 6 at −y.
pub fn direction(parameter: f64) -> DVec2 {
    let p = parameter.rem_euclid(8.0);
    match p {
        p if p < 1.0 => DVec2::new(1.0, p),
        p if p < 3.0 => DVec2::new(2.0 - p, 1.0),
        p if p < 5.0 => DVec2::new(-1.0, 4.0 - p),
        p if p < 7.0 => DVec2::new(p - 6.0, -1.0),
        p => DVec2::new(1.0, p - 8.0),
    }
}
