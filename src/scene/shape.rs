//! Scenes built in code: indexed triangle meshes, counter-clockwise seen from outside, y up.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};

use super::{Material, Scene};

/// Points and the triangles between them.
#[derive(Debug, Clone, Default)]
pub struct Shape {
    /// [scene units]
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

    /// The (2, 3) torus knot, upright, standing on y = 0: a tube of this radius round a ring of radius `ring` and
    /// `winding` away from it, of `rings` × `segments` quads.
    pub fn torus_knot(ring: f64, winding: f64, radius: f64, rings: u32, segments: u32) -> Self {
        let frame = |t: f64| {
            let (sin_p, cos_p) = (2.0 * TAU * t).sin_cos();
            let (sin_q, cos_q) = (3.0 * TAU * t).sin_cos();
            let radial = DVec3::new(cos_p, sin_p, 0.0);
            // The torus's own normal is perpendicular to every curve on it.
            let normal = radial * cos_q + DVec3::Z * sin_q;
            let along = DVec3::new(-sin_p, cos_p, 0.0) * 2.0 * (ring + winding * cos_q)
                + (radial * -sin_q + DVec3::Z * cos_q) * 3.0 * winding;
            [
                radial * ring + normal * winding,
                normal,
                along.normalize().cross(normal),
            ]
        };
        Self::closed_tube(frame, radius, rings, segments).set_down()
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

    /// The corners of the box around all points; both 0 without any.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let Some((&first, rest)) = self.positions.split_first() else {
            return (DVec3::ZERO, DVec3::ZERO);
        };
        rest.iter()
            .fold((first, first), |(lo, hi), &p| (lo.min(p), hi.max(p)))
    }

    /// Enlarged or shrunk so that the longest side of its box is `size`, with the box's middle at `center`.
    pub fn fitted(mut self, size: f64, center: DVec3) -> Self {
        let (lo, hi) = self.bounds();
        let scale = size / (hi - lo).max_element();
        for p in &mut self.positions {
            *p = center + (*p - 0.5 * (lo + hi)) * scale;
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

impl Scene {
    /// The same scene, of whose shapes only those of the given numbers cast shadows.
    #[must_use]
    pub fn with_casters(mut self, shapes: &[u32]) -> Self {
        let materials = self.triangle_materials.iter();
        self.casts = materials.map(|shape| shapes.contains(shape)).collect();
        self
    }

    /// Opaque, two-sided shapes, each of its linear colour.
    pub fn of_shapes(parts: &[(Shape, Vec3)]) -> Self {
        let mut whole = Shape::default();
        let mut scene = Self::default();
        for (index, (shape, color)) in parts.iter().enumerate() {
            whole.append(shape);
            let materials = std::iter::repeat_n(index as u32, shape.triangles.len());
            scene.triangle_materials.extend(materials);
            scene.materials.push(Material {
                name: String::new(),
                base_color: color.extend(1.0),
                texture: None,
                alpha_cutoff: None,
                double_sided: true,
            });
        }
        scene.positions = whole.positions;
        scene.opaque_count = whole.triangles.len();
        scene.triangles = whole.triangles;
        scene
    }
}
