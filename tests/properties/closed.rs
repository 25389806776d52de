//! Closed bodies. A map holds what the centre of its part sees first; from elsewhere on the part a receiver close behind a
//! wall can see past its silhouette, where nothing is known of how the wall goes on. All light that gets in does so there,
//! give or take a texel: rays that know of nothing else let in as much.

use std::sync::atomic::AtomicBool;

use halfshade::reference::{ReferenceOptions, trace};
use halfshade::scene::{Camera, Shape};
use halfshade::shared::{Fit, View};
use halfshade::twin::receiver::in_view;

use super::*;

/// [cell] Of a part's side, for the rays of the bound.
const CELLS: usize = 12;
/// [pixel] That are looked at, of those that leak.
const LOOKED_AT: usize = 24;
const SIDE: u32 = 48;
/// [scene units] Of a receiver's f32 place, and more than that.
const ROUNDING: f64 = 1e-5;

/// A body on the ground, looked at from inside, under a square light of half width 0.5 at height 2.
fn shot_inside(body: &Shape, eye: Camera, settings: Settings) -> Shot {
    let parts = [
        (Shape::square(4.0), Vec3::ONE),
        (body.clone(), Vec3::splat(0.5)),
    ];
    let light = rectangle_light(DVec3::Y * 2.0, DVec2::splat(0.5));
    let scene = Arc::new(Scene::of_shapes(&parts));
    shot(scene, eye, light, SIDE, settings)
}

fn moved(mut shape: Shape, by: DVec3) -> Shape {
    shape.positions.iter_mut().for_each(|point| *point += by);
    shape
}

fn joined(shapes: &[Shape]) -> Shape {
    let mut all = Shape::default();
    shapes.iter().for_each(|shape| all.append(shape));
    all
}

fn block(half: f64, height: f64) -> Shape {
    Shape::cuboid(
        DVec3::new(-half, -0.1, -half),
        DVec3::new(half, height, half),
    )
}

fn overlapping_balls() -> Shape {
    let ball = |radius, x, y, z| moved(Shape::ball(radius, 16), DVec3::new(x, y, z));
    joined(&[
        ball(0.4, 0.0, -0.1, 0.0),
        ball(0.35, 0.35, 0.0, 0.1),
        ball(0.3, -0.3, 0.0, -0.2),
    ])
}

/// A can without a lid, and a larger lid that hangs over.
fn lidded_can() -> Shape {
    let can = Shape::lathe(&[(0.35, -0.1), (0.35, 0.8)], 20);
    let lid = Shape::lathe(&[(0.45, 0.7), (0.45, 0.75), (0.0, 0.75)], 20);
    joined(&[can, lid])
}

/// Four walls and a roof that reach beyond each other, each a box.
fn room(half: f64) -> Shape {
    let wall = |x: [f64; 2], y: [f64; 2], z: [f64; 2]| {
        Shape::cuboid(DVec3::new(x[0], y[0], z[0]), DVec3::new(x[1], y[1], z[1]))
    };
    let (across, outside) = ([-half - 0.1, half + 0.1], [half, half + 0.05]);
    let opposite = [-half - 0.05, -half];
    joined(&[
        wall(outside, [-0.1, 1.0], across),
        wall(opposite, [-0.1, 1.0], across),
        wall(across, [-0.1, 1.0], outside),
        wall(across, [-0.1, 1.0], opposite),
        wall(across, [0.95, 1.05], across),
    ])
}

/// All triangles of a scene, relative to the eye.
struct Walls(Vec<[DVec3; 3]>);

impl Walls {
    fn of(shot: &Shot) -> Self {
        let scene = &shot.scene;
        let corners = |index| scene.corners_around(shot.origin(), index);
        Self((0..scene.triangles.len()).map(corners).collect())
    }

    /// Where a ray meets them, in lengths of `way`, in no order.
    fn crossings(&self, from: DVec3, way: DVec3) -> impl Iterator<Item = f64> {
        self.0.iter().filter_map(move |[a, b, c]| {
            let (side, other) = (b - a, c - a);
            let normal = way.cross(other);
            let scale = side.dot(normal).recip();
            let u = (from - a).dot(normal) * scale;
            let across = (from - a).cross(side);
            let v = way.dot(across) * scale;
            let t = other.dot(across) * scale;
            let inside = u > -1e-9 && v > -1e-9 && u + v < 1.0 + 1e-9;
            (inside && t > 0.0).then_some(t)
        })
    }

    fn first(&self, from: DVec3, way: DVec3) -> f64 {
        self.crossings(from, way).fold(f64::INFINITY, f64::min)
    }
}

struct Receiver {
    point: DVec3,
    normal: DVec3,
}

/// A view of a map, in f64.
struct Eye<'a> {
    view: &'a View,
    fit: &'a Fit,
    walls: &'a Walls,
}

impl Eye<'_> {
    fn center(&self) -> DVec3 {
        Vec3::from(self.view.center).as_dvec3()
    }

    /// Whether the centre sees a wall's point `on_wall`, and within a texel round it nothing but what stands before the
    /// receiver and above its plane: then it lies inside of any contour that a map can have.
    fn knows(&self, receiver: &Receiver, on_wall: DVec3) -> bool {
        let axis = |axis: [f32; 3]| Vec3::from(axis).as_dvec3();
        let forward = axis(self.view.forward);
        let (center, way) = (self.center(), on_wall - self.center());
        if self.walls.first(center, way) < 1.0 - 1e-6 {
            return false;
        }
        let slopes = way / way.dot(forward);
        let aside = |x: f64, y: f64| {
            let texel = DVec2::new(x, y) / DVec2::from_array(self.fit.focal.map(f64::from));
            slopes + axis(self.view.right) * texel.x + axis(self.view.up) * texel.y
        };
        let depth = (receiver.point - center).dot(forward);
        let occludes = |way: DVec3| {
            let z = self.walls.first(center, way);
            let above = (center + way * z - receiver.point).dot(receiver.normal);
            z < depth - ROUNDING && above > ROUNDING
        };
        let around = (0..9).map(|i| aside(f64::from(i % 3 - 1), f64::from(i / 3 - 1)));
        around.into_iter().all(occludes)
    }

    /// Whether such a wall hides the part's point at (u, v) of its half sizes. What is below the horizon is not hidden.
    fn hides(&self, receiver: &Receiver, u: f64, v: f64) -> bool {
        let along = |axis: [f32; 3], half: f32| {
            Vec3::from(axis).as_dvec3() * f64::from(half) * f64::from(half)
        };
        let on_light = self.center()
            + along(self.view.light_u, self.view.half_size[0]) * u
            + along(self.view.light_v, self.view.half_size[1]) * v;
        let start = receiver.point + receiver.normal * ROUNDING;
        let way = on_light - start;
        let mut on_walls = self.walls.crossings(start, way).filter(|&t| t < 1.0);
        way.dot(receiver.normal) > 0.0 && on_walls.any(|t| self.knows(receiver, start + way * t))
    }

    /// [0, 1] The part's share in cells that are hidden at all their corners.
    fn hidden_share(&self, receiver: &Receiver) -> f64 {
        let at = |i: usize| 2.0 * i as f64 / CELLS as f64 - 1.0;
        let row = CELLS + 1;
        let hidden: Vec<bool> = (0..row * row)
            .map(|i| self.hides(receiver, at(i % row), at(i / row)))
            .collect();
        let is_hidden = |cell: &usize| {
            let corner = cell / CELLS * row + cell % CELLS;
            [0, 1, row, row + 1]
                .iter()
                .all(|offset| hidden[corner + offset])
        };
        (0..CELLS * CELLS).filter(is_hidden).count() as f64 / (CELLS * CELLS) as f64
    }
}

/// What a body lets in, and what it may.
struct Leaks {
    /// [pixel] That face the whole light, and to which the rays find no way.
    dark: usize,
    /// Visibility of those where it is not 0, and its bound for some of them.
    all: Vec<f32>,
    bounded: Vec<(f32, f64)>,
}

impl Leaks {
    fn largest(&self) -> f32 {
        self.all.iter().copied().fold(0.0, f32::max)
    }
}

fn leaks(gpu: &Arc<Gpu>, shot: &Shot, bounded: usize) -> Leaks {
    let options = ReferenceOptions {
        samples: 256,
        seed: 0,
    };
    let truth = trace(shot, 0, options, &|_| {}, &AtomicBool::new(false)).expect("rays");
    let mut renderer = renderer(gpu, shot);
    let frame = renderer.render().expect("a frame");
    let (image, fits) = (renderer.visibility(0), renderer.fits().expect("fits"));
    let image = image.expect("visibility");
    let vectors =
        |name: &str| -> Vec<[f32; 4]> { renderer.read_image(name, image.len()).expect("an image") };
    let (positions, normals) = (vectors("position_world"), vectors("normal_world"));
    let dark: Vec<usize> = (0..image.len())
        .filter(|&i| truth.facing.data[i] > 0.999 && truth.visibility.data[i] == 0.0)
        .collect();
    let mut leaking: Vec<usize> = dark.iter().copied().filter(|&i| image[i] > 0.0).collect();
    leaking.sort_by(|&a, &b| image[b].total_cmp(&image[a]));
    let step = leaking.len().div_ceil(bounded.max(1)).max(1);
    let walls = Walls::of(shot);
    let bound = |pixel: usize| {
        let vector = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
        let (point, normal) = (vector(positions[pixel]), vector(normals[pixel]));
        let receiver = Receiver {
            point: point.as_dvec3(),
            normal: normal.as_dvec3(),
        };
        let views = frame.plan.views().zip(&fits);
        let seen = views.filter(|(planned, _)| in_view(&planned.view, point, normal));
        let hidden: f64 = seen
            .map(|(planned, fit)| {
                let (view, walls) = (&planned.view, &walls);
                f64::from(view.weight) * Eye { view, fit, walls }.hidden_share(&receiver)
            })
            .sum();
        1.0 - hidden / f64::from(frame.plan.lights[0].light.weight_sum)
    };
    let looked_at = leaking.iter().step_by(step).take(bounded);
    Leaks {
        dark: dark.len(),
        all: leaking.iter().map(|&pixel| image[pixel]).collect(),
        bounded: looked_at
            .map(|&pixel| (image[pixel], bound(pixel)))
            .collect(),
    }
}

#[test]
fn light_gets_into_closed_bodies_only_where_no_centre_sees_the_wall() {
    let from_above = || camera(DVec3::new(0.0, 0.5, 0.2), DVec3::new(0.0, 0.2, -0.3), 80.0);
    let in_the_middle = || {
        camera(
            DVec3::new(0.0, 0.4, 0.1),
            DVec3::new(0.0, 0.35, -0.3),
            100.0,
        )
    };
    let bodies = [
        ("a ball", Shape::ball(0.5, 20), in_the_middle()),
        (
            "a block narrower than the light",
            block(0.4, 1.1),
            from_above(),
        ),
        ("balls that overlap", overlapping_balls(), in_the_middle()),
        ("a can under a lid", lidded_can(), from_above()),
    ];
    with_gpu(|gpu| {
        for (name, body, eye) in bodies {
            let found = leaks(gpu, &shot_inside(&body, eye, settings(256, 4)), LOOKED_AT);
            let count = found.bounded.len();
            assert!(found.dark > 300 && count > 0, "{name}");
            let (light, allowed) = (found.bounded.iter())
                .fold((0.0, 0.0), |sum, &(light, bound)| {
                    (sum.0 + f64::from(light), sum.1 + bound)
                });
            println!(
                "{name}: {} of {} leak, {:.4} at most; {count} have {:.4} in the mean, {:.4} allowed",
                found.all.len(),
                found.dark,
                found.largest(),
                light / count as f64,
                allowed / count as f64
            );
            for (light, bound) in &found.bounded {
                assert!(
                    f64::from(*light) <= bound + 1e-4,
                    "{name}: {light} of {bound}"
                );
            }
        }
    });
}

/// Walls that the whole light is on one side of; walls and a roof that reach beyond each other.
#[test]
fn bodies_with_the_same_silhouettes_from_all_of_the_light_are_tight() {
    let eye = || camera(DVec3::new(0.0, 0.5, 0.3), DVec3::new(0.0, 0.2, -0.3), 80.0);
    let bodies = [
        ("a block wider than the light", block(0.6, 1.1)),
        ("a room of boxes", room(0.6)),
        ("a narrow room of boxes", room(0.45)),
    ];
    with_gpu(|gpu| {
        for (name, body) in bodies {
            let found = leaks(gpu, &shot_inside(&body, eye(), settings(128, 4)), 0);
            assert!(found.dark > 300, "{name}: {} are dark", found.dark);
            assert_eq!(found.all.len(), 0, "{name}: {}", found.largest());
        }
    });
}

/// Inside a ball a ray that is γ above the wall's tangent meets the wall again an arc of 2γ further on. A receiver at an
/// arc of β below the silhouette that a part's centre sees has the centre β above its tangent: light at less than β / 2
/// gets in. Of a part that it faces wholly, whose centre is then φ above its tangent, φ being half the part's angle,
/// that is a quarter at most, and other parts than those of the outer row are too high.
#[test]
fn a_ball_lets_in_at_most_a_quarter_of_the_outer_row() {
    with_gpu(|gpu| {
        for split in [1, 2, 4] {
            let eye = camera(
                DVec3::new(0.0, 0.55, 0.35),
                DVec3::new(0.0, 0.45, -0.2),
                40.0,
            );
            let shot = shot_inside(&Shape::ball(0.6, 48), eye, settings(512, split));
            let found = leaks(gpu, &shot, 0);
            let bound = 0.25 / split as f32;
            println!("{split} a side: {} of {bound}", found.largest());
            assert!(found.dark > 1000 && found.largest() <= bound);
        }
    });
}
