//! Indexed triangle meshes, counter-clockwise seen from outside, y up.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

/// Points and the triangles between them.
#[derive(Default)]
pub struct Shape {
    pub positions: Vec<DVec3>,
    /// Indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// The axis-aligned box between two corners, 8 points. The four points at the top come last.
    pub fn cuboid(lo: DVec3, hi: DVec3) -> Self {
        let mut shape = Self::default();
        for y in [lo.y, hi.y] {
            for (x, z) in [(lo.x, hi.z), (hi.x, hi.z), (hi.x, lo.z), (lo.x, lo.z)] {
                shape.positions.push(DVec3::new(x, y, z));
            }
        }
        for side in 0..4 {
            let next = (side + 1) % 4;
            shape.quad([side, next, next + 4, side + 4]);
        }
        shape.quad([4, 5, 6, 7]);
        shape.quad([3, 2, 1, 0]);
        shape
    }

    /// A horizontal square of this half width at y = 0, facing up.
    pub fn square(half: f64) -> Self {
        let corners = [(-half, half), (half, half), (half, -half), (-half, -half)];
        Self {
            positions: corners.map(|(x, z)| DVec3::new(x, 0.0, z)).into(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        }
    }

    /// A profile of (radius, height), from the bottom to the top, turned round the y axis. Where the
    /// radius is 0 the surface closes in a point.
    pub fn lathe(profile: &[(f64, f64)], segments: u32) -> Self {
        let mut shape = Self::default();
        let mut below: Option<(u32, u32)> = None;
        for &(radius, y) in profile {
            let first = shape.positions.len() as u32;
            let count = if radius == 0.0 { 1 } else { segments };
            for i in 0..count {
                let (sin, cos) = (TAU * f64::from(i) / f64::from(segments)).sin_cos();
                shape
                    .positions
                    .push(DVec3::new(radius * cos, y, -radius * sin));
            }
            if let Some((lower, lower_count)) = below {
                for i in 0..segments {
                    let corner = |ring: u32, count: u32, i: u32| ring + i % count;
                    shape.quad([
                        corner(lower, lower_count, i),
                        corner(lower, lower_count, i + 1),
                        corner(first, count, i + 1),
                        corner(first, count, i),
                    ]);
                }
            }
            below = Some((first, count));
        }
        shape
    }

    /// A ball that stands on the origin.
    pub fn ball(radius: f64, segments: u32) -> Self {
        let rings = segments / 2;
        let profile: Vec<_> = (0..=rings)
            .map(|i| match i {
                0 => (0.0, 0.0),
                i if i == rings => (0.0, 2.0 * radius),
                i => {
                    let (sin, cos) = (PI * f64::from(i) / f64::from(rings)).sin_cos();
                    (radius * sin, radius * (1.0 - cos))
                }
            })
            .collect();
        Self::lathe(&profile, segments)
    }

    /// A truncated cone without caps from `a` to `b`.
    pub fn limb(a: DVec3, b: DVec3, radii: (f64, f64), segments: u32) -> Self {
        let axis = (b - a).normalize();
        let (x, z) = axis.any_orthonormal_pair();
        let side = if x.cross(axis).dot(z) > 0.0 { z } else { -z };
        let mut shape = Self::lathe(&[(radii.0, 0.0), (radii.1, (b - a).length())], segments);
        for p in &mut shape.positions {
            *p = a + x * p.x + axis * p.y + side * p.z;
        }
        shape
    }

    /// A tube along a closed curve. `frame(t)` for t in [0, 1) gives the curve's point and two unit
    /// vectors, perpendicular to the curve and to each other, whose cross product points along it.
    pub fn closed_tube(
        frame: impl Fn(f64) -> [DVec3; 3],
        radius: f64,
        rings: u32,
        segments: u32,
    ) -> Self {
        let mut shape = Self::default();
        for ring in 0..rings {
            let [center, x, y] = frame(f64::from(ring) / f64::from(rings));
            let next = (ring + 1) % rings * segments;
            for i in 0..segments {
                let (sin, cos) = (TAU * f64::from(i) / f64::from(segments)).sin_cos();
                shape.positions.push(center + (x * cos + y * sin) * radius);
                let after = (i + 1) % segments;
                let this = ring * segments;
                shape.quad([this + i, this + after, next + after, next + i]);
            }
        }
        shape
    }

    /// Adds another shape's triangles.
    pub fn append(&mut self, other: &Self) {
        let first = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        let moved = other.triangles.iter().map(|t| t.map(|i| i + first));
        self.triangles.extend(moved);
    }

    /// Moves every point so that the lowest one has y = 0.
    pub fn set_down(mut self) -> Self {
        let lowest = self
            .positions
            .iter()
            .map(|p| p.y)
            .fold(f64::INFINITY, f64::min);
        for p in &mut self.positions {
            p.y -= lowest;
        }
        self
    }

    /// The corners of all triangles, three points each.
    pub fn soup(&self) -> Vec<DVec3> {
        let corners = self.triangles.iter().flatten();
        corners.map(|&i| self.positions[i as usize]).collect()
    }

    /// Two triangles, or one where two neighbouring corners are the same.
    pub fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        for triangle in [[a, b, c], [a, c, d]] {
            let [i, j, k] = triangle;
            if i != j && j != k && k != i {
                self.triangles.push(triangle);
            }
        }
    }
}
