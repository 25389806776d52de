//! Rays against triangles, in f64.

use std::ops::{ControlFlow, Range};

use glam::{DVec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, builder::build_bvh2};

use crate::scene::Scene;
use crate::{Error, Result};

/// [scene units] Beyond this the squares in the builder's cost function could overflow f32.
const MAX_COORDINATE: f64 = 1e15;

/// How much boxes are enlarged, per largest coordinate of scene and ray: far more than the slab test's
/// rounding in f64, so that rays along a box's side and through flat boxes still enter.
const MARGIN: f64 = 1e-13;

/// A bounding volume hierarchy over a scene's triangles.
///
/// `obvhs` builds it: boxes are f32 bounds of the vertices, rounded outwards, its nodes are public and it speaks
/// glam. Its own traversal, in f32, is not used: `walk` tests the same boxes in f64 and
/// conservatively, and triangles are intersected in f64 by the watertight test of [Woop, Benthin,
/// Wald 2013], so a ray cannot slip between two triangles that share an edge.
pub struct Bvh {
    tree: Bvh2,
    /// The triangles in the order of the tree's leaves: corners, and index in the scene.
    corners: Vec<[DVec3; 3]>,
    triangles: Vec<u32>,
    /// [scene units] The largest coordinate of all boxes.
    reach: f64,
}

/// A ray, with what the intersection tests need of it worked out.
pub struct Ray {
    origin: DVec3,
    /// 1 / direction; components that are 0 count as 1e-300, so that no 0 · ∞ occurs.
    inverse: DVec3,
    /// The axis of the largest component of the direction comes last.
    axes: [usize; 3],
    /// Shears the direction to (0, 0, 1) [Woop13].
    shear: [f64; 3],
}

impl Ray {
    /// `direction` need not be normalised; its length is the unit of `Hit::t`. It must not be 0.
    pub fn new(origin: DVec3, direction: DVec3) -> Self {
        let kz = direction.abs().max_position();
        let (kx, ky) = ((kz + 1) % 3, (kz + 2) % 3);
        let along = direction[kz];
        let not_zero = |c: f64| if c.abs() < 1e-300 { 1e-300 } else { c };
        Self {
            origin,
            inverse: direction.map(not_zero).recip(),
            axes: [kx, ky, kz],
            shear: [direction[kx] / along, direction[ky] / along, 1.0 / along],
        }
    }

    /// Where the line through the ray meets the triangle, edges included.
    fn intersect(&self, corners: &[DVec3; 3]) -> Option<(f64, [f64; 3])> {
        let [kx, ky, kz] = self.axes;
        let [a, b, c] = corners.map(|corner| {
            let p = corner - self.origin;
            let [sx, sy, sz] = self.shear;
            [p[kx] - sx * p[kz], p[ky] - sy * p[kz], sz * p[kz]]
        });
        let edge = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - p[1] * q[0];
        let weights = [edge(c, b), edge(a, c), edge(b, a)];
        if weights.iter().any(|&w| w < 0.0) && weights.iter().any(|&w| w > 0.0) {
            return None;
        }
        let sum: f64 = weights.iter().sum();
        if sum == 0.0 {
            return None;
        }
        let weights = weights.map(|w| w / sum);
        Some((
            weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2],
            weights,
        ))
    }

    /// Where the ray enters a box, enlarged by `margin`, if it does so up to `limit`.
    fn enters(&self, aabb: &Aabb, margin: f64, limit: f64) -> Option<f64> {
        let a = (aabb.min.as_dvec3() - self.origin - margin) * self.inverse;
        let b = (aabb.max.as_dvec3() - self.origin + margin) * self.inverse;
        let near = a.min(b).max_element().max(0.0);
        let far = a.max(b).min_element().min(limit);
        (near <= far).then_some(near)
    }
}

/// A point of a triangle on a ray.
#[derive(Debug, Clone, Copy)]
pub struct Hit {
    /// Index into `Scene::triangles`.
    pub triangle: usize,
    /// > 0, in lengths of the ray's direction.
    pub t: f64,
    /// Weights of the triangle's corners; their sum is 1.
    pub weights: [f64; 3],
}

/// The box of a triangle in f32, rounded outwards.
fn bounds([a, b, c]: &[DVec3; 3]) -> Aabb {
    let outwards = |exact: DVec3, next: fn(f32) -> f32| Vec3A::from(exact.as_vec3()).map(next);
    Aabb {
        min: outwards(a.min(*b).min(*c), f32::next_down),
        max: outwards(a.max(*b).max(*c), f32::next_up),
    }
}

impl Bvh {
    /// The scene relative to `origin` \[scene units, world\].
    ///
    /// # Errors
    /// When a coordinate is so large that f32 bounds could overflow.
    pub fn new(scene: &Scene, origin: DVec3) -> Result<Self> {
        let (low, high) = scene.bounds();
        let reach = (low - origin)
            .abs()
            .max((high - origin).abs())
            .max_element();
        if reach.is_nan() || reach > MAX_COORDINATE {
            return Err(Error::Invalid("the scene is too large to be traced".into()));
        }
        let corners: Vec<_> = (0..scene.triangles.len())
            .map(|index| scene.corners_around(origin, index))
            .collect();
        let boxes: Vec<Aabb> = corners.iter().map(bounds).collect();
        let tree = build_bvh2(
            &boxes,
            BvhBuildParams::medium_build(),
            &mut Default::default(),
        );
        Ok(Self {
            corners: tree
                .primitive_indices
                .iter()
                .map(|&i| corners[i as usize])
                .collect(),
            triangles: tree.primitive_indices.clone(),
            tree,
            reach,
        })
    }

    /// The first point along the ray that `accept` takes. `stack` is scratch memory.
    pub fn nearest(
        &self,
        ray: &Ray,
        stack: &mut Vec<u32>,
        accept: impl Fn(&Hit) -> bool,
    ) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        self.walk(ray, stack, f64::INFINITY, |slots, limit| {
            for slot in slots {
                if let Some(hit) = self.test(ray, slot, *limit).filter(&accept) {
                    *limit = hit.t;
                    best = Some(hit);
                }
            }
            ControlFlow::Continue(())
        });
        best
    }

    /// A triangle that `accept` takes on the ray before `limit`, if there is any: its place in leaf
    /// order, which `test_again` takes.
    pub fn any(
        &self,
        ray: &Ray,
        stack: &mut Vec<u32>,
        limit: f64,
        accept: impl Fn(&Hit) -> bool,
    ) -> Option<usize> {
        let mut found = None;
        self.walk(ray, stack, limit, |mut slots, limit| {
            found =
                slots.find(|&slot| self.test(ray, slot, *limit).is_some_and(|hit| accept(&hit)));
            match found {
                Some(_) => ControlFlow::Break(()),
                None => ControlFlow::Continue(()),
            }
        });
        found
    }

    /// The ray against the one triangle at a place that `any` returned.
    pub fn test(&self, ray: &Ray, slot: usize, limit: f64) -> Option<Hit> {
        let (t, weights) = ray.intersect(&self.corners[slot])?;
        let triangle = self.triangles[slot] as usize;
        (t > 0.0 && t < limit).then_some(Hit {
            triangle,
            t,
            weights,
        })
    }

    /// Calls `visit` with the triangles of each leaf that the ray may touch before the limit, which
    /// `visit` may lower; nearer boxes first.
    fn walk(
        &self,
        ray: &Ray,
        stack: &mut Vec<u32>,
        mut limit: f64,
        mut visit: impl FnMut(Range<usize>, &mut f64) -> ControlFlow<()>,
    ) {
        let nodes = &self.tree.nodes;
        let margin = MARGIN * (self.reach + ray.origin.abs().max_element());
        let enters = |node: u32, limit| ray.enters(&nodes[node as usize].aabb, margin, limit);
        stack.clear();
        if !nodes.is_empty() && enters(0, limit).is_some() {
            stack.push(0);
        }
        while let Some(index) = stack.pop() {
            let node = &nodes[index as usize];
            let first = node.first_index;
            if node.is_leaf() {
                let slots = first as usize..(first + node.prim_count) as usize;
                if visit(slots, &mut limit).is_break() {
                    return;
                }
                continue;
            }
            match (enters(first, limit), enters(first + 1, limit)) {
                (Some(a), Some(b)) if a <= b => stack.extend([first + 1, first]),
                (Some(_), Some(_)) => stack.extend([first, first + 1]),
                (Some(_), None) => stack.push(first),
                (None, Some(_)) => stack.push(first + 1),
                (None, None) => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Shape;
    use glam::Vec3;
    use proptest::prelude::*;

    /// A bumpy height field of 2 × `side`² triangles that share all their edges, over [−1, 1]².
    fn terrain(side: usize) -> Scene {
        let grid = |i: usize| 2.0 * i as f64 / side as f64 - 1.0;
        let row = side + 1;
        let position = |i: usize| {
            let (x, z) = (grid(i % row), grid(i / row));
            DVec3::new(x, 0.2 * (7.0 * x + 3.0 * z).sin(), z)
        };
        let cell = |i: usize| {
            let corner = (i / side * row + i % side) as u32;
            let [a, b, c, d] = [
                corner,
                corner + 1,
                corner + row as u32,
                corner + row as u32 + 1,
            ];
            [[a, c, b], [b, c, d]]
        };
        Scene {
            positions: (0..row * row).map(position).collect(),
            triangles: (0..side * side).flat_map(cell).collect(),
            triangle_materials: vec![0; side * side * 2],
            opaque_count: side * side * 2,
            ..Scene::default()
        }
    }

    #[test]
    fn rays_at_edges_and_corners_do_not_slip_through() {
        let scene = terrain(32);
        let bvh = Bvh::new(&scene, DVec3::ZERO).unwrap();
        let mut stack = Vec::new();
        let row = 33;
        for eye in [DVec3::new(0.0, 3.0, 0.0), DVec3::new(0.9, 5.0, -2.0)] {
            for (index, corner) in scene.positions.iter().enumerate() {
                let inner = (1..32).contains(&(index % row)) && (1..32).contains(&(index / row));
                if !inner {
                    continue;
                }
                // At the vertex, and halfway to its neighbours along the three kinds of edges.
                for other in [index, index + 1, index + row, index + row - 1] {
                    let target = (corner + scene.positions[other]) / 2.0;
                    let ray = Ray::new(eye, target - eye);
                    let hit = bvh.nearest(&ray, &mut stack, |_| true);
                    assert!(hit.is_some_and(|hit| hit.t < 1.0 + 1e-9), "{index} {other}");
                }
            }
        }
    }

    /// From points inside of closed bodies, along all edges' points and at all corners: not one ray gets out.
    #[test]
    fn no_ray_leaves_a_closed_body() {
        let bodies = [
            (Shape::ball(0.6, 48), DVec3::new(0.0, 0.6, 0.0)),
            (
                Shape::cuboid(DVec3::new(-0.6, 0.0, -0.6), DVec3::new(0.6, 1.1, 0.6)),
                DVec3::new(0.0, 0.5, 0.0),
            ),
        ];
        for (shape, middle) in bodies {
            let scene = Scene::of_shapes(&[(shape, Vec3::ONE)]);
            let bvh = Bvh::new(&scene, DVec3::ZERO).unwrap();
            let mut stack = Vec::new();
            let offsets = [DVec3::ZERO, DVec3::new(0.31, 0.17, -0.23), DVec3::X * 0.5];
            let mut rays = 0;
            for eye in offsets.map(|offset| middle + offset) {
                for triangle in 0..scene.triangles.len() {
                    let corners = scene.corners(triangle);
                    for (from, share) in (0..3).flat_map(|i| [0.0, 0.25, 0.5].map(|t| (i, t))) {
                        let target = corners[from].lerp(corners[(from + 1) % 3], share);
                        let ray = Ray::new(eye, target - eye);
                        rays += 1;
                        assert!(
                            bvh.any(&ray, &mut stack, f64::INFINITY, |_| true).is_some(),
                            "from {eye} at {target}"
                        );
                    }
                }
            }
            assert!(rays >= 300, "{rays} rays");
        }
    }

    #[test]
    fn a_scene_without_triangles_is_never_hit() {
        let bvh = Bvh::new(&Scene::default(), DVec3::ZERO).unwrap();
        assert!(
            bvh.nearest(&Ray::new(DVec3::ZERO, DVec3::X), &mut Vec::new(), |_| true)
                .is_none()
        );
    }

    #[test]
    fn a_scene_too_large_is_an_error() {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::splat(1e30)];
        let scene = Scene {
            positions,
            triangles: vec![[0, 1, 2]],
            ..Scene::default()
        };
        assert!(Bvh::new(&scene, DVec3::ZERO).is_err());
    }

    proptest! {
        /// The tree finds what trying every triangle finds, in flat scenes and along axes as well.
        #[test]
        fn the_tree_leaves_nothing_out(
            corners in prop::collection::vec(prop::array::uniform9(-4i8..=4), 1..40),
            origin in prop::array::uniform3(-6i8..=6),
            direction in prop::array::uniform3(-2i8..=2),
            flat in any::<bool>(),
        ) {
            prop_assume!(direction != [0, 0, 0]);
            let vector = |v: [i8; 3]| DVec3::from_array(v.map(f64::from));
            let vertex = |c: &[i8]| DVec3::new(c[0].into(), if flat { 0.0 } else { c[1].into() }, c[2].into());
            let positions: Vec<_> = corners.iter().flat_map(|c| c.chunks(3).map(vertex)).collect();
            let triangles = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            let scene = Scene { positions, triangles, ..Scene::default() };
            let bvh = Bvh::new(&scene, DVec3::ZERO).unwrap();
            let ray = Ray::new(vector(origin), vector(direction));
            let distances = (0..corners.len()).filter_map(|i| ray.intersect(&scene.corners(i)));
            let expected = distances.map(|(t, _)| t).filter(|&t| t > 0.0).reduce(f64::min);
            let mut stack = Vec::new();
            let found = bvh.nearest(&ray, &mut stack, |_| true).map(|hit| hit.t);
            prop_assert_eq!(found, expected);
            let any = bvh.any(&ray, &mut stack, f64::INFINITY, |_| true);
            prop_assert_eq!(any.is_some(), expected.is_some());
        }
    }
}
