//! A light cut into split × split sub-lights (`algorithm.md` §1, §3).

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use glam::{DVec2, DVec3};

use crate::scene::AreaLight;
use crate::shared::SECTOR_STEPS;

/// One part of a light: the unit that has a shadow map of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct SubLight {
    /// [scene units, world]
    pub center: DVec3,
    /// [scene units] Half sizes along the light's u and v.
    pub half_size: DVec2,
    /// [half sizes] Lower and upper corner of its box, seen from its centre.
    pub extent: (DVec2, DVec2),
    /// [half sizes] Centre and radius of the disc that bounds it; None = the box alone does.
    pub rim: Option<(DVec2, f64)>,
    /// [half sizes²] Area swept from direction 0 up to each of `SECTOR_STEPS` + 1 equally spaced perimeter
    /// parameters, 0 to 8; empty without a rim.
    pub sectors: Arc<[f32]>,
    /// [half sizes²] Area.
    pub area: f64,
}

/// A part of a light of some shape, wherever the light stands and whatever its size: what of a cell of its grid lies in
/// it, in half sizes of the cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// From the middle of the light to that of the cell.
    middle: DVec2,
    /// From the middle of the cell to the centre of what is left of it.
    shift: DVec2,
    /// The cell's half sizes are the light's divided by this.
    split: f64,
    /// It has no extent.
    point: bool,
    rim: Option<(DVec2, f64)>,
    sectors: Arc<[f32]>,
    area: f64,
    /// Its weight among the light's parts: their areas stand in this proportion.
    weight: f64,
}

/// \[−1, 1)² Points that are evenly spread over the square and over its sides: Sobol's, scrambled [Owen95]. Lattices
/// and sequences of fixed steps are more even, but what repeats before a lamp, such as slats, resonates with them.
pub fn evenly_spread(count: u32) -> impl Iterator<Item = DVec2> {
    let coordinate = |index, dimension| f64::from(sobol_burley::sample(index, dimension, SCRAMBLE));
    (0..count).map(move |i| 2.0 * DVec2::new(coordinate(i, 0), coordinate(i, 1)) - 1.0)
}

/// Any number does; another scrambles otherwise.
const SCRAMBLE: u32 = 1;

/// A light's parts, row by row along u; of a disc those first that its rim does not cut. Those that a disc's rim leaves nothing of are left out.
/// A light without extent has one part without extent.
pub fn parts(light: &AreaLight, split: u32) -> Vec<Part> {
    match light.is_round() {
        _ if light.is_point() => vec![Part::point(DVec2::ZERO)],
        false => grid(split)
            .map(|middle| Part::whole(middle, f64::from(split)))
            .collect(),
        true => parts_of_disc(split).to_vec(),
    }
}

/// The middles of the cells of a grid, in half sizes of a cell seen from the middle of all.
fn grid(split: u32) -> impl Iterator<Item = DVec2> {
    let middle = move |column: u32, row: u32| {
        DVec2::new(f64::from(2 * column + 1), f64::from(2 * row + 1)) - f64::from(split)
    };
    (0..split).flat_map(move |row| (0..split).map(move |column| middle(column, row)))
}

/// The parts of a disc, which are the same for all discs: found once for each split, as their tables take
/// half a millisecond each.
fn parts_of_disc(split: u32) -> Arc<[Part]> {
    static FOUND: Mutex<BTreeMap<u32, Arc<[Part]>>> = Mutex::new(BTreeMap::new());
    let mut found = FOUND.lock().unwrap_or_else(PoisonError::into_inner);
    let find = || {
        let parts = grid(split).filter_map(|middle| Part::of_disc(middle, f64::from(split)));
        let mut parts: Vec<Part> = parts.collect();
        parts.sort_by_key(|part| part.rim.is_some());
        parts.into()
    };
    found.entry(split).or_insert_with(find).clone()
}

impl Part {
    /// A point, `place` half sizes of the light from its centre.
    pub fn point(place: DVec2) -> Self {
        Self {
            point: true,
            ..Self::whole(place, 1.0)
        }
    }

    /// The part of a light that stands somewhere. Takes no memory.
    pub fn of(&self, light: &AreaLight) -> SubLight {
        let (u, v, _) = light.frame();
        let half_size = DVec2::from(light.half_size()) / self.split;
        let at = (self.middle + self.shift) * half_size;
        let center = light.center + u * at.x + v * at.y;
        if self.point {
            return SubLight::point(center);
        }
        SubLight {
            center,
            half_size,
            extent: (DVec2::NEG_ONE - self.shift, DVec2::ONE - self.shift),
            rim: self.rim,
            sectors: self.sectors.clone(),
            area: self.area,
        }
    }

    /// Its weight among the light's parts.
    pub fn weight(&self) -> f64 {
        self.weight
    }

    /// [half sizes of the light] Lower and upper corner of its cell, from the middle of the light.
    pub fn cell(&self) -> (DVec2, DVec2) {
        let (lower, upper) = (self.middle - 1.0, self.middle + 1.0);
        (lower / self.split, upper / self.split)
    }

    /// Those of the points \[half sizes of the light\] that lie in it, or else the point that it is centred on; they share
    /// its weight.
    pub fn points(&self, on_light: &[DVec2]) -> Vec<Self> {
        let within = |&at: &DVec2| {
            // From the part's centre.
            let at = at * self.split - self.middle - self.shift;
            let (lower, upper) = (DVec2::NEG_ONE - self.shift, DVec2::ONE - self.shift);
            let in_rim = |(center, radius): (DVec2, f64)| at.distance(center) < radius;
            at.cmpge(lower).all() && at.cmplt(upper).all() && self.rim.is_none_or(in_rim)
        };
        let mut places: Vec<DVec2> = on_light.iter().copied().filter(within).collect();
        if places.is_empty() {
            places.push((self.middle + self.shift) / self.split);
        }
        let weight = self.weight / places.len() as f64;
        let point = |place| Self {
            weight,
            ..Self::point(place)
        };
        places.into_iter().map(point).collect()
    }

    /// See [`SubLight::sectors`].
    pub fn sectors(&self) -> &Arc<[f32]> {
        &self.sectors
    }

    fn whole(middle: DVec2, split: f64) -> Self {
        Self {
            middle,
            shift: DVec2::ZERO,
            split,
            point: false,
            rim: None,
            sectors: Arc::default(),
            area: 4.0,
            weight: 4.0,
        }
    }

    /// None: nothing of the cell lies in the disc.
    fn of_disc(middle: DVec2, radius: f64) -> Option<Self> {
        let (shift, rim) = cut_by_disc(middle, radius)?;
        let mut part = Self {
            shift,
            rim,
            ..Self::whole(middle, radius)
        };
        if rim.is_some() {
            part.sectors = part.sweep().into();
            part.area = part.sectors[SECTOR_STEPS as usize].into();
            part.weight = part.area;
        }
        (part.area > 1e-6).then_some(part)
    }
}

/// Where the centre of a cell of a disc's grid has to move, and the disc seen from there. None: nothing
/// of the cell lies in the disc. `cell`: its centre; it reaches 1 to each side; `radius`: the disc's.
fn cut_by_disc(cell: DVec2, radius: f64) -> Option<(DVec2, Option<(DVec2, f64)>)> {
    if (cell.abs() + DVec2::ONE).length() <= radius {
        return Some((DVec2::ZERO, None));
    }
    // A centre inside the part is all that the radial integration asks for: the centroid of samples.
    const SAMPLES: u32 = 64;
    let (mut sum, mut count) = (DVec2::ZERO, 0);
    for i in 0..SAMPLES * SAMPLES {
        let at = (DVec2::new(f64::from(i % SAMPLES), f64::from(i / SAMPLES)) + 0.5)
            * (2.0 / f64::from(SAMPLES))
            - 1.0;
        if (cell + at).length() < radius {
            sum += at;
            count += 1;
        }
    }
    if count == 0 {
        return None;
    }
    let shift = sum / f64::from(count);
    Some((shift, Some((-cell - shift, radius))))
}

impl SubLight {
    /// A part without extent: a point in the middle of half sizes that can be divided by.
    fn point(center: DVec3) -> Self {
        Self {
            center,
            half_size: DVec2::ONE,
            extent: (DVec2::ZERO, DVec2::ZERO),
            rim: None,
            sectors: Arc::default(),
            area: 4.0,
        }
    }
}

impl Part {
    /// See [`SubLight::sectors`].
    fn sweep(&self) -> Vec<f32> {
        const SUBSTEPS: u32 = 8;
        let mut table = vec![0.0f32];
        let mut swept = 0.0;
        let step = 8.0 / f64::from(SECTOR_STEPS * SUBSTEPS);
        for entry in 0..SECTOR_STEPS {
            for substep in 0..SUBSTEPS {
                let from = f64::from(entry * SUBSTEPS + substep) * step;
                // Simpson's rule on ½ ρ² dθ.
                swept += (self.density(from)
                    + 4.0 * self.density(from + 0.5 * step)
                    + self.density(from + step))
                    * step
                    / 6.0;
            }
            table.push(swept as f32);
        }
        table
    }

    /// ½ ρ² dθ/dP at perimeter parameter P: with a direction q on the unit square, ρ = s |q| where s q
    /// lies on the border, and |q|² dθ/dP = 1.
    fn density(&self, parameter: f64) -> f64 {
        0.5 * self.border(direction(parameter)).powi(2)
    }

    /// How many times `direction` reaches from the centre to the border.
    fn border(&self, direction: DVec2) -> f64 {
        let (lower, upper) = (DVec2::NEG_ONE - self.shift, DVec2::ONE - self.shift);
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
        if let Some((center, radius)) = self.rim {
            let along = center.dot(direction);
            let square = direction.length_squared();
            let root = along * along - square * (center.length_squared() - radius * radius);
            reach = reach.min((along + root.max(0.0).sqrt()) / square);
        }
        reach
    }
}

/// The point of the unit square's border with perimeter parameter P: 0 at +x, 2 at +y, 4 at −x, 6 at −y.
fn direction(parameter: f64) -> DVec2 {
    let p = parameter.rem_euclid(8.0);
    match p {
        p if p < 1.0 => DVec2::new(1.0, p),
        p if p < 3.0 => DVec2::new(2.0 - p, 1.0),
        p if p < 5.0 => DVec2::new(-1.0, 4.0 - p),
        p if p < 7.0 => DVec2::new(p - 6.0, -1.0),
        p => DVec2::new(1.0, p - 8.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::LightShape;
    use glam::Vec3;

    fn sub_lights(light: &AreaLight, split: u32) -> Vec<SubLight> {
        let parts = parts(light, split);
        parts.iter().map(|part| part.of(light)).collect()
    }

    fn disc(radius: f64) -> AreaLight {
        AreaLight {
            name: String::new(),
            center: DVec3::new(1.0, 2.0, 3.0),
            shape: LightShape::Disc {
                normal: DVec3::NEG_Y,
                radius,
            },
            color: Vec3::ONE,
            intensity: None,
            beam: None,
        }
    }

    #[test]
    fn parts_of_a_disc_add_up_to_it() {
        for split in 1..=16 {
            let parts = sub_lights(&disc(0.5), split);
            let area: f64 = parts
                .iter()
                .map(|p| p.area * p.half_size.x * p.half_size.y)
                .sum();
            // The sector tables are f32 and Simpson's rule meets kinks: 1e-6 of the whole.
            assert!(
                (area - std::f64::consts::PI * 0.25).abs() < 1e-6,
                "split {split}: {area}"
            );
        }
    }

    #[test]
    fn the_sectors_of_a_whole_disc_are_angles() {
        let part = &sub_lights(&disc(1.0), 1)[0];
        for (i, swept) in part.sectors.iter().enumerate() {
            let parameter = 8.0 * i as f64 / f64::from(SECTOR_STEPS);
            let q = direction(parameter);
            let angle = if i as u32 == SECTOR_STEPS {
                std::f64::consts::TAU
            } else {
                q.y.atan2(q.x).rem_euclid(std::f64::consts::TAU)
            };
            assert!((f64::from(*swept) - 0.5 * angle).abs() < 1e-6);
        }
    }

    #[test]
    fn centres_lie_inside_their_parts() {
        for split in 2..=16 {
            for part in sub_lights(&disc(1.0), split) {
                let (lower, upper) = part.extent;
                assert!(lower.max_element() < 0.0 && upper.min_element() > 0.0);
                if let Some((center, radius)) = part.rim {
                    assert!(center.length() < radius);
                }
            }
        }
    }
}
