//! The exact visibility of a light above flat occluders that are parallel to it, in f64.
#![allow(dead_code)] // Each test program uses a part of it.

use glam::{DVec2, DVec3};

/// The points c of a plane with normal · c ≥ offset.
#[derive(Debug, Clone, Copy)]
pub struct HalfPlane {
    pub normal: DVec2,
    pub offset: f64,
}

impl HalfPlane {
    /// With its edge through `at`, turned by `degrees`; it lies on the side of +x for 0.
    pub fn new(at: DVec2, degrees: f64) -> Self {
        let normal = DVec2::from_angle(degrees.to_radians());
        Self {
            normal,
            offset: normal.dot(at),
        }
    }

    /// Its edge moved outward.
    pub fn grown(self, by: f64) -> Self {
        Self {
            offset: self.offset - by,
            ..self
        }
    }

    /// A rectangle of it: `size` deep and twice as wide.
    pub fn corners(&self, size: f64) -> [DVec2; 4] {
        let (near, along) = (self.normal * self.offset, self.normal.perp() * size);
        let far = near + self.normal * size;
        [near - along, near + along, far + along, far - along]
    }
}

/// A horizontal, convex occluder: where all of its half-planes overlap.
#[derive(Debug, Clone)]
pub struct Occluder {
    pub height: f64,
    pub sides: Vec<HalfPlane>,
}

impl Occluder {
    pub fn half_plane(height: f64, side: HalfPlane) -> Self {
        Self {
            height,
            sides: vec![side],
        }
    }

    /// A square, turned by `degrees`.
    pub fn square(height: f64, center: DVec2, half: f64, degrees: f64) -> Self {
        let side = |turn: f64| {
            let side = HalfPlane::new(center, degrees + turn);
            side.grown(half)
        };
        Self {
            height,
            sides: [0.0, 90.0, 180.0, 270.0].map(side).to_vec(),
        }
    }

    pub fn grown(&self, by: f64) -> Self {
        Self {
            height: self.height,
            sides: self.sides.iter().map(|side| side.grown(by)).collect(),
        }
    }

    /// Its projection from a point onto the light's plane, seen from the light's centre.
    fn on_light(&self, from: DVec3, center: DVec3) -> Vec<HalfPlane> {
        let scale = (center.y - from.y) / (self.height - from.y);
        let at = DVec2::new(from.x, from.z);
        let middle = DVec2::new(center.x, center.z);
        let project = |side: &HalfPlane| {
            let along = side.normal.dot(at);
            HalfPlane {
                normal: side.normal,
                offset: along + (side.offset - along) * scale - side.normal.dot(middle),
            }
        };
        self.sides.iter().map(project).collect()
    }

    /// The corners of a square.
    pub fn corners(&self) -> Vec<DVec2> {
        let reach = self.sides.iter().map(|side| side.offset.abs()).sum::<f64>() + 1.0;
        let mut polygon = vec![
            DVec2::new(-reach, -reach),
            DVec2::new(reach, -reach),
            DVec2::new(reach, reach),
            DVec2::new(-reach, reach),
        ];
        self.sides.iter().for_each(|side| clip(&mut polygon, side));
        polygon
    }
}

/// The share of a rectangle that is visible from a point, half sizes along x and z.
pub fn rectangle_visibility(from: DVec3, center: DVec3, half: DVec2, occluder: &Occluder) -> f64 {
    let mut hidden = vec![
        -half,
        DVec2::new(half.x, -half.y),
        half,
        DVec2::new(-half.x, half.y),
    ];
    for side in occluder.on_light(from, center) {
        clip(&mut hidden, &side);
    }
    1.0 - area(&hidden) / (4.0 * half.x * half.y)
}

/// The share of a disc that is visible from a point beside one half-plane.
pub fn disc_visibility(from: DVec3, center: DVec3, radius: f64, occluder: &Occluder) -> f64 {
    let [edge] = occluder.on_light(from, center)[..] else {
        panic!("a disc's closed form is for one edge")
    };
    let s = (edge.offset / radius).clamp(-1.0, 1.0);
    0.5 + (s * (1.0 - s * s).sqrt() + s.asin()) / std::f64::consts::PI
}

fn clip(polygon: &mut Vec<DVec2>, side: &HalfPlane) {
    let distance = |p: DVec2| side.normal.dot(p) - side.offset;
    let Some(&last) = polygon.last() else { return };
    let mut kept = Vec::new();
    let mut previous = last;
    for &current in polygon.iter() {
        let (before, after) = (distance(previous), distance(current));
        if (before < 0.0) != (after < 0.0) {
            kept.push(previous.lerp(current, before / (before - after)));
        }
        if after >= 0.0 {
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
