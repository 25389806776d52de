//! A convex polygon: what its corners leave of the rectangle around them.

use glam::{DVec2, DVec3};

use super::outline::Corners;
use super::{Form, Outline, is_sane, rect};
use crate::scene::LightShape;

/// [size] Corners that are no farther apart are one corner.
const SAME: f64 = 1e-9;
/// [size²] Least area.
const LEAST_AREA: f64 = 1e-12;
/// [size] How far corners may be off the plane that is nearest to them, as with the angle between a rectangle's half-axes.
const FLATNESS: f64 = 1e-4;
/// [half sizes²] By how much a triangle of corners may turn the other way: corners on a side are rounded.
const CONVEXITY: f64 = 1e-6;
/// Rectangles of less than this times the smallest's area are as small: where the first of them is taken, rounding does not turn a
/// regular polygon.
const AS_SMALL: f64 = 1.001;

pub fn form(u: DVec3, v: DVec3, corners: Corners) -> Form {
    Form {
        outline: Outline::Polygon(corners),
        ..rect::form(u, v)
    }
}

/// Does not allocate. The centre of the smallest rectangle around the corners that has one of their sides on its own, and the polygon in it. They run
/// counter-clockwise seen from where the light shines to.
pub fn around(corners: &[DVec3]) -> Result<(DVec3, LightShape), String> {
    let count = corners.len();
    if !(Corners::FEWEST..=Corners::MOST).contains(&count) {
        return Err(format!(
            "a polygon has {} to {} corners, not {count}",
            Corners::FEWEST,
            Corners::MOST
        ));
    }
    if let Some(index) = corners.iter().position(|corner| !is_sane(*corner)) {
        return Err(format!(
            "corner {index} of the polygon is not finite or beyond 1e18"
        ));
    }
    let origin = corners[0];
    let size = (corners.iter()).fold(0.0, |size: f64, corner| size.max(corner.distance(origin)));
    if let Some((first, second)) = doubled(corners, SAME * size) {
        return Err(format!(
            "corners {first} and {second} of the polygon are the same; leave one of them out"
        ));
    }
    // Relative to the first corner and to the size, so that products neither overflow nor lose what is small.
    let mut places = [DVec3::ZERO; Corners::MOST];
    let places = &mut places[..count];
    for (place, &corner) in places.iter_mut().zip(corners) {
        *place = (corner - origin) / size;
    }
    let area = area_vector(places);
    if area.length() <= LEAST_AREA {
        return Err("the polygon has no area; its corners must not lie on a line".into());
    }
    let normal = area.normalize();
    let mean = places.iter().sum::<DVec3>() / count as f64;
    let height = |at: &DVec3| normal.dot(*at - mean).abs();
    if places.iter().any(|at| height(at) > FLATNESS) {
        return Err("the polygon is not flat; its corners must lie in one plane".into());
    }
    let frame = Rectangle::smallest(places, normal);
    let flat = frame.corners(places);
    if !is_convex(&flat) {
        return Err(
            "the polygon is not convex; give its corners in order, and several lights for a form with notches"
                .into(),
        );
    }
    let center = origin + size * (frame.center() + normal * normal.dot(mean));
    let [u, v] = [frame.u * frame.half().x, frame.v * frame.half().y].map(|axis| axis * size);
    let corners = flat;
    Ok((center, LightShape::Polygon { u, v, corners }))
}

/// Two corners that are no farther apart.
fn doubled(corners: &[DVec3], distance: f64) -> Option<(usize, usize)> {
    let pairs = (0..corners.len()).flat_map(|second| (0..second).map(move |first| (first, second)));
    pairs
        .into_iter()
        .find(|&(first, second)| corners[first].distance(corners[second]) <= distance)
}

/// Along the normal, as long as the area is large; of corners that begin at 0.
fn area_vector(places: &[DVec3]) -> DVec3 {
    let triangles = places.windows(2).map(|side| side[0].cross(side[1]));
    0.5 * triangles.sum::<DVec3>()
}

/// No corner lies right of a side.
fn is_convex(corners: &[DVec2]) -> bool {
    let next = corners.iter().cycle().skip(1);
    let mut sides = corners.iter().zip(next);
    sides.all(|(from, to)| {
        let turn = |corner: &DVec2| (*to - *from).perp_dot(*corner - *from);
        corners.iter().all(|corner| turn(corner) >= -CONVEXITY)
    })
}

/// A rectangle in the plane.
#[derive(Clone, Copy)]
struct Rectangle {
    /// Unit vectors; u × v = normal.
    u: DVec3,
    v: DVec3,
    lower: DVec2,
    upper: DVec2,
}

impl Rectangle {
    fn smallest(places: &[DVec3], normal: DVec3) -> Self {
        let next = places.iter().cycle().skip(1);
        let sides = places.iter().zip(next).map(|(from, to)| *to - *from);
        let around =
            sides.map(|side| Self::along(side.reject_from_normalized(normal), normal, places));
        let areas = around.clone().map(|one| one.area());
        let least = areas.fold(f64::INFINITY, f64::min);
        let smallest = |found: Self, next: Self| match found.area() <= AS_SMALL * least {
            true => found,
            false => next,
        };
        around
            .reduce(smallest)
            .unwrap_or_else(|| Self::along(DVec3::X, normal, places))
    }

    fn along(side: DVec3, normal: DVec3, places: &[DVec3]) -> Self {
        let u = side.normalize();
        let mut around = Self {
            u,
            v: normal.cross(u),
            lower: DVec2::INFINITY,
            upper: DVec2::NEG_INFINITY,
        };
        for &place in places {
            let at = around.in_plane(place);
            (around.lower, around.upper) = (around.lower.min(at), around.upper.max(at));
        }
        around
    }

    fn in_plane(&self, place: DVec3) -> DVec2 {
        DVec2::new(self.u.dot(place), self.v.dot(place))
    }

    fn half(&self) -> DVec2 {
        0.5 * (self.upper - self.lower)
    }

    fn area(&self) -> f64 {
        4.0 * self.half().element_product()
    }

    fn center(&self) -> DVec3 {
        let middle = 0.5 * (self.lower + self.upper);
        self.u * middle.x + self.v * middle.y
    }

    /// [half sizes] From its centre.
    fn corners(&self, places: &[DVec3]) -> Corners {
        let middle = 0.5 * (self.lower + self.upper);
        let corner = |place: &DVec3| (self.in_plane(*place) - middle) / self.half();
        Corners::new(places.iter().map(corner))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::AreaLight;
    use glam::{DQuat, Vec3};

    fn at(corners: &[[f64; 2]]) -> Vec<DVec3> {
        let place = |[x, z]: &[f64; 2]| DVec3::new(*x, 5.0, *z);
        corners.iter().map(place).collect()
    }

    fn light(corners: &[DVec3]) -> AreaLight {
        let (center, shape) = around(corners).expect("a polygon");
        AreaLight {
            name: String::new(),
            center,
            shape,
            color: Vec3::ONE,
            intensity: None,
            beam: None,
        }
    }

    #[test]
    fn every_fault_has_its_sentence() {
        let regular = |count: u32, step: u32| -> Vec<DVec3> {
            let angle = |i: u32| std::f64::consts::TAU * f64::from(step * i) / f64::from(count);
            let corner = |i| DVec3::new(angle(i).cos(), 0.0, angle(i).sin());
            (0..count).map(corner).collect()
        };
        let square = at(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        let with = |index: usize, corner: DVec3| {
            let mut corners = square.clone();
            corners[index] = corner;
            corners
        };
        for (corners, wanted) in [
            (vec![], "3 to 16 corners, not 0"),
            (square[..2].to_vec(), "3 to 16 corners, not 2"),
            (regular(17, 1), "3 to 16 corners, not 17"),
            (with(2, DVec3::NAN), "corner 2 of the polygon is not finite"),
            (with(1, DVec3::X * 1e19), "corner 1 of the polygon"),
            (
                with(3, square[1]),
                "corners 1 and 3 of the polygon are the same",
            ),
            (
                vec![DVec3::ONE; 4],
                "corners 0 and 1 of the polygon are the same",
            ),
            (at(&[[0.0, 0.0], [1.0, 2.0], [2.0, 4.0]]), "no area"),
            (with(2, square[2] + DVec3::Y * 0.1), "not flat"),
            (with(2, DVec3::new(0.1, 5.0, 0.1)), "not convex"),
            (regular(5, 2), "not convex"),
            (
                [0, 2, 1, 3]
                    .map(|i| square[i] * DVec3::new(1.0, 1.0, 1.0 + i as f64))
                    .to_vec(),
                "not convex",
            ),
        ] {
            let found = around(&corners).expect_err(wanted);
            assert!(found.contains(wanted), "{found:?} for {wanted:?}");
        }
    }

    #[test]
    fn a_rectangle_is_its_own_frame() {
        let (center, u, v) = (
            DVec3::new(3.0, -2.0, 7.0),
            DVec3::new(0.6, 0.8, 0.0) * 2.0,
            DVec3::Z * 0.25,
        );
        let light = light(&[
            center - u - v,
            center + u - v,
            center + u + v,
            center - u + v,
        ]);
        let rectangle = AreaLight {
            center,
            shape: LightShape::Rect { u, v },
            ..light.clone()
        };
        assert!(light.validate().is_ok());
        assert!(light.center.distance(center) < 1e-14);
        let (found, wanted) = (light.frame(), rectangle.frame());
        for (found, wanted) in [
            (found.0, wanted.0),
            (found.1, wanted.1),
            (found.2, wanted.2),
        ] {
            assert!(found.distance(wanted) < 1e-14);
        }
        assert!((light.area() - rectangle.area()).abs() < 1e-14);
    }

    /// Wherever and however a polygon stands, its rectangle has an edge on one of its sides and its corners on all of its own; it
    /// shines to where they run counter-clockwise.
    #[test]
    fn corners_come_back() {
        let hexagon: Vec<DVec3> = (0..6)
            .map(|i| DQuat::from_rotation_z(f64::from(i).to_radians() * 60.0) * DVec3::X)
            .collect();
        let needle = [[0.0, 0.0], [1e-6, 1.0], [-2e-6, 0.5]].map(|[x, y]| DVec3::new(x, y, 0.0));
        // What 64 bits round off, over the width: a narrow one's plane is as uncertain.
        for (corners, width) in [(&hexagon[..], 1.0), (&needle, 1e-6)] {
            let mut frames = Vec::new();
            for turn in 0..20 {
                let turn =
                    DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), f64::from(turn));
                let place = |corner: &DVec3| turn * *corner * 3.0 + DVec3::new(10.0, -20.0, 5.0);
                let placed: Vec<DVec3> = corners.iter().map(place).collect();
                let light = light(&placed);
                let ((u, v, n), (half_u, half_v)) = (light.frame(), light.half_size());
                assert!(n.dot(turn * DVec3::Z) > 1.0 - 1e-9);
                let outline = light.outline();
                for (corner, wanted) in outline.corners().iter().zip(&placed) {
                    let found = light.center + u * (half_u * corner.x) + v * (half_v * corner.y);
                    assert!(
                        found.distance(*wanted) < 30.0 * 1e-15 / width,
                        "{found} {wanted}"
                    );
                }
                for axis in [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y] {
                    assert!((outline.reach(axis) - 1.0).abs() < 1e-9);
                }
                frames.push(turn.inverse() * u);
            }
            let same = |u: &DVec3| u.distance(frames[0]) < 1e-6;
            assert!(
                frames.iter().all(same),
                "a turned polygon has another frame"
            );
        }
    }

    #[test]
    fn places_fill_a_polygon_evenly() {
        let corners = at(&[[0.0, 0.0], [3.0, 0.0], [4.0, 2.0], [1.0, 3.0], [-1.0, 1.0]]);
        let light = light(&corners);
        let Outline::Polygon(corners) = light.outline() else {
            panic!("a polygon")
        };
        // The mean over a grid of the square is the centroid, and as much lies left of it as right.
        let (mut sum, side) = (DVec2::ZERO, 400);
        for i in 0..side * side {
            let share = DVec2::new(f64::from(i % side), f64::from(i / side)) + 0.5;
            sum += corners.place(share / f64::from(side));
        }
        let triangles = corners[1..].windows(2).map(|side| {
            let area = 0.5 * (side[0] - corners[0]).perp_dot(side[1] - corners[0]);
            (side[0] + side[1] + corners[0]) / 3.0 * area
        });
        let centroid = triangles.sum::<DVec2>() / light.outline().area();
        let mean = sum / f64::from(side * side);
        assert!(mean.distance(centroid) < 1e-4, "{mean} {centroid}");
    }
}
