//! A light cut into split × split sub-lights (`algorithm.md` §1, §3).

mod cut;
mod sweep;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use glam::{DVec2, DVec3};

use crate::scene::{AreaLight, Outline};
use crate::shared::SECTOR_STEPS;

use cut::Remnant;
pub use cut::{Cut, Edge};

/// [half sizes²] Parts of no more are left out.
const LEAST_AREA: f64 = 1e-6;

/// One part of a light: the unit that has a shadow map of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct SubLight {
    /// [scene units, world]
    pub center: DVec3,
    /// [scene units] Half sizes along the light's u and v.
    pub half_size: DVec2,
    /// [half sizes] Lower and upper corner of its box, seen from its centre.
    pub extent: (DVec2, DVec2),
    pub cut: Cut,
    /// [half sizes²] Area.
    pub area: f64,
}

/// A part of a light of some shape, wherever the light stands and whatever its size: what of a cell of its grid lies in
/// it, in half sizes of the cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// From the middle of the light to that of the cell.
    middle: DVec2,
    /// The cell's half sizes are the light's divided by this.
    split: f64,
    /// It has no extent.
    point: bool,
    left: Remnant,
    table: Arc<[f32]>,
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

/// A light's parts, row by row along u, those first that its outline does not cut: views in a row run the same. Those that its outline
/// leaves nothing of are left out. A light without extent has one part without extent.
pub fn parts(light: &AreaLight, split: u32) -> Vec<Part> {
    let mut parts = match light.outline() {
        _ if light.is_point() => vec![Part::point(DVec2::ZERO)],
        Outline::Square => grid(split)
            .map(|middle| Part::whole(middle, f64::from(split)))
            .collect(),
        Outline::Disc => parts_of_disc(split).to_vec(),
        Outline::Polygon(corners) => parts_of_polygon(&corners, split),
    };
    parts.sort_by_key(|part| part.left.cut != Cut::Nothing);
    parts
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
        let radius = f64::from(split);
        let part = |cell| Part::cut(cell, radius, Remnant::of_disc(cell, radius)?);
        grid(split).filter_map(part).collect()
    };
    found.entry(split).or_insert_with(find).clone()
}

/// The parts of a polygon. All that are cut have as many edges, so that they run the same.
fn parts_of_polygon(corners: &[DVec2], split: u32) -> Vec<Part> {
    let scale = f64::from(split);
    let left = |cell: DVec2| {
        let seen: Vec<DVec2> = corners.iter().map(|&at| at * scale - cell).collect();
        Some((cell, Remnant::of_polygon(&seen)?))
    };
    let cells: Vec<(DVec2, Remnant)> = grid(split).filter_map(left).collect();
    let counts = cells.iter().map(|(_, left)| left.cut.edges().len());
    let most = counts.max().unwrap_or(0);
    let part = |(cell, mut left): (DVec2, Remnant)| {
        left.cut = left.cut.padded(most);
        Part::cut(cell, scale, left)
    };
    cells.into_iter().filter_map(part).collect()
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
        let at = (self.middle + self.left.shift) * half_size;
        let center = light.center + u * at.x + v * at.y;
        if self.point {
            return SubLight::point(center);
        }
        SubLight {
            center,
            half_size,
            extent: self.left.extent,
            cut: self.left.cut.clone(),
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
            let at = at * self.split - self.middle - self.left.shift;
            let (lower, upper) = self.left.extent;
            at.cmpge(lower).all() && at.cmplt(upper).all() && self.left.cut.holds(at)
        };
        let mut places: Vec<DVec2> = on_light.iter().copied().filter(within).collect();
        if places.is_empty() {
            places.push((self.middle + self.left.shift) / self.split);
        }
        let weight = self.weight / places.len() as f64;
        let point = |place| Self {
            weight,
            ..Self::point(place)
        };
        places.into_iter().map(point).collect()
    }

    /// What cuts it out of its cell.
    pub fn cut_by(&self) -> &Cut {
        &self.left.cut
    }

    /// What the device looks up of a part that is cut: its sectors (`sub_light/sweep.rs`), then its edges, the normal and the distance of
    /// each. Empty where it is its cell.
    pub fn table(&self) -> &Arc<[f32]> {
        &self.table
    }

    fn whole(middle: DVec2, split: f64) -> Self {
        Self {
            middle,
            split,
            point: false,
            left: Remnant::whole(),
            table: Arc::default(),
            area: 4.0,
            weight: 4.0,
        }
    }

    /// None: nothing is left of the cell but what rounding makes.
    fn cut(middle: DVec2, split: f64, left: Remnant) -> Option<Self> {
        let mut part = Self::whole(middle, split);
        if left.cut != Cut::Nothing {
            let mut table = sweep::sectors(&left);
            part.area = table[SECTOR_STEPS as usize].into();
            part.weight = left.area.unwrap_or(part.area);
            let edges = left.cut.edges().iter();
            table.extend(edges.flat_map(|edge| {
                [edge.normal.x, edge.normal.y, edge.distance].map(|value| value as f32)
            }));
            part.table = table.into();
            part.left = left;
        }
        (part.area > LEAST_AREA).then_some(part)
    }
}

impl SubLight {
    /// A part without extent: a point in the middle of half sizes that can be divided by.
    fn point(center: DVec3) -> Self {
        Self {
            center,
            half_size: DVec2::ONE,
            extent: (DVec2::ZERO, DVec2::ZERO),
            cut: Cut::Nothing,
            area: 4.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::sweep::direction;
    use super::*;
    use crate::scene::{LightShape, polygon_area};
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
        let part = &parts(&disc(1.0), 1)[0];
        for (i, swept) in part.table().iter().enumerate() {
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

    /// Polygons, from a needle to what is nearly a disc.
    fn polygons() -> Vec<AreaLight> {
        let regular = |count: u32| {
            let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(count);
            let corner = |i| DVec3::new(angle(i).cos(), 1.0, -angle(i).sin());
            (0..count).map(corner).collect::<Vec<_>>()
        };
        let needle = [[0.0, 0.0], [-3e-4, 0.4], [2e-4, 7.0]].map(|[x, z]| DVec3::new(x, 2.0, z));
        let skewed =
            [[0.0, 0.0], [1.0, 5.0], [3.0, 6.0], [4.0, 0.5]].map(|[x, z]| DVec3::new(x, z, 0.0));
        let all = (3..=16)
            .map(regular)
            .chain([needle.to_vec(), skewed.to_vec()]);
        let light = |corners: Vec<DVec3>| {
            let (center, shape) = LightShape::polygon(&corners).expect("a polygon");
            AreaLight {
                center,
                shape,
                ..disc(1.0)
            }
        };
        all.map(light).collect()
    }

    /// Exact clipping adds up to the polygon but for rounding and for parts too small to count, 1e-6 of a cell each; the device's areas,
    /// of tables in f32 by Simpson's rule over kinks, are off by up to 2e-6 of a cell.
    #[test]
    fn parts_of_a_polygon_add_up_to_it() {
        for light in polygons() {
            for split in 1..=16 {
                let parts = parts(&light, split);
                let cells = f64::from(split * split);
                let weight: f64 = parts.iter().map(Part::weight).sum();
                let wanted = light.outline().area() * cells;
                assert!(
                    (weight - wanted).abs() < 1e-6 * f64::from(4 * split),
                    "{weight} {wanted}, split {split}"
                );
                for part in &parts {
                    assert!(
                        (part.area - part.weight).abs() < 2e-6,
                        "{} {}",
                        part.area,
                        part.weight
                    );
                }
            }
        }
    }

    /// A cell that a polygon does not cut is a rectangle's.
    #[test]
    fn a_rectangle_of_corners_has_the_parts_of_a_rectangle() {
        let (u, v) = (DVec3::X * 3.0, DVec3::NEG_Z * 0.7);
        let (center, shape) =
            LightShape::polygon(&[-u - v, u - v, u + v, v - u]).expect("a polygon");
        let polygon = AreaLight {
            center,
            shape,
            ..disc(1.0)
        };
        let rectangle = AreaLight {
            shape: LightShape::Rect { u, v },
            ..polygon.clone()
        };
        for split in [1, 2, 5, 16] {
            assert_eq!(parts(&polygon, split), parts(&rectangle, split));
        }
    }

    /// The corners of what is left of a cell, from its edges and its box alone.
    #[test]
    fn edges_and_box_are_the_part() {
        for light in polygons() {
            for part in parts(&light, 4) {
                let (lower, upper) = part.left.extent;
                let mut corners = vec![
                    lower,
                    DVec2::new(upper.x, lower.y),
                    upper,
                    DVec2::new(lower.x, upper.y),
                ];
                for edge in part.left.cut.edges() {
                    corners = cut::clipped(&corners, |at| edge.height(at));
                }
                assert!((polygon_area(&corners) - part.weight).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn centres_lie_inside_their_parts() {
        let lights: Vec<_> = polygons().into_iter().chain([disc(1.0)]).collect();
        for split in 1..=16 {
            for part in lights.iter().flat_map(|light| sub_lights(light, split)) {
                let (lower, upper) = part.extent;
                assert!(lower.max_element() < 0.0 && upper.min_element() > 0.0);
                assert!(part.cut.holds(DVec2::ZERO));
            }
        }
    }
}
