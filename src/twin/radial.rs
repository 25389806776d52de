//! What a view's occluders hide of its sub-light (algorithm.md §1–3), derived from the geometry in f64: no hierarchy,
//! no perimeter parameter, no sector table. Contour vertices are lifted to space and projected from the
//! receiver onto the light plane; what lies beyond a segment is a polygon, cut out of the light's outline.
//!
//! It takes over from the GPU only the f32 values that the contour hangs on: the map, t_p and the depths.

use glam::{DMat3, DVec2, DVec3};

use super::contour::{Segment, ShadowMap};
use super::receiver::{Receiver, extents};
use crate::scene::Corners;
use crate::shared::{Fit, View};
use crate::sub_light::Cut;

/// Share of the receiver's height over the light plane. Occluders no higher than this below the receiver's
/// own height project to where no light is, or to infinity.
const HEIGHT_MIN: f64 = 1e-9;

/// A sub-light, seen through a view's map.
pub struct SubLight<'a> {
    map: ShadowMap<'a>,
    near: f64,
    focal: DVec2,
    center: DVec2,
    /// From the face's frame to the light's: half sizes along u and v, height over the light plane.
    to_light: DMat3,
    /// [half sizes] Its box.
    extent: (DVec2, DVec2),
    /// [half sizes] What its edges leave of it.
    outline: Polygon,
    rim: Option<Rim>,
    area: f64,
}

#[derive(Clone, Copy)]
struct Rim {
    center: DVec2,
    radius: f64,
}

impl<'a> SubLight<'a> {
    /// `cut`: what bounds the sub-light within its box.
    pub fn new(view: &View, fit: &Fit, cut: &Cut, map: ShadowMap<'a>) -> Self {
        let double = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
        let to_world = DMat3::from_cols(double(view.right), double(view.up), double(view.forward));
        let from_world = DMat3::from_cols(
            double(view.light_u),
            double(view.light_v),
            double(view.light_n),
        )
        .transpose();
        let (low, high) = extents(view);
        let (low, high) = (low.as_dvec2(), high.as_dvec2());
        let rim = matches!(cut, Cut::Rim { .. }).then(|| Rim {
            center: DVec2::new(view.rim[0].into(), view.rim[1].into()),
            radius: view.rim[2].into(),
        });
        let mut outline = Polygon::new(&[
            low,
            DVec2::new(high.x, low.y),
            high,
            DVec2::new(low.x, high.y),
        ]);
        for edge in cut.edges() {
            outline = outline.left_of(&Line {
                through: edge.normal * edge.distance,
                along: edge.normal.perp(),
            });
        }
        Self {
            map,
            near: fit.near.into(),
            focal: DVec2::new(fit.focal[0].into(), fit.focal[1].into()),
            center: DVec2::new(fit.center[0].into(), fit.center[1].into()),
            to_light: from_world * to_world,
            area: outline.area(rim),
            extent: (low, high),
            outline,
            rim,
        }
    }

    /// [half sizes²]
    pub fn area(&self) -> f64 {
        self.area
    }

    /// [0, 1] The share that is hidden from a receiver, by the occluders in the cells first … last, inclusive.
    pub fn hidden_share(&self, receiver: &Receiver, first: [i32; 2], last: [i32; 2]) -> f64 {
        let t = receiver.t.as_dvec2();
        let eye = self.lifted(t, receiver.d.into());
        let mut beyond = 0.0;
        let limit = receiver.limit();
        self.map.for_each_segment(first, last, &limit, |segment| {
            if let Some(ends) = self.projected(eye, &segment) {
                let side = segment.side_of(t);
                beyond += side * self.area_beyond(ends, side);
            }
        });
        let center = if self.map.hides(t, &limit) {
            self.area
        } else {
            0.0
        };
        ((center - beyond) / self.area).clamp(0.0, 1.0)
    }

    /// The point of space that falls on `t` with depth `d`, in the light's frame.
    fn lifted(&self, t: DVec2, d: f64) -> DVec3 {
        self.to_light * ((t - self.center) / self.focal).extend(1.0) * (self.near / d)
    }

    /// [half sizes] Where lines from `eye` through the ends of a segment meet the light plane. None: all of
    /// the segment is as high over the light plane as `eye` or higher, where no line meets it.
    fn projected(&self, eye: DVec3, segment: &Segment) -> Option<[DVec2; 2]> {
        let [a, b] = [0, 1].map(|i| self.lifted(segment.ends[i], segment.depths[i].into()));
        let below = |point: DVec3| eye.z - point.z;
        let least = HEIGHT_MIN * eye.z;
        if below(a) <= least && below(b) <= least {
            return None;
        }
        let cut = |from: DVec3, to: DVec3| {
            if below(from) > least {
                return from;
            }
            from + (to - from) * ((least - below(from)) / (below(to) - below(from)))
        };
        let on_light = |point: DVec3| {
            (eye.z * point.truncate() - point.z * eye.truncate()) / below(point).max(least)
        };
        Some([on_light(cut(a, b)), on_light(cut(b, a))])
    }

    /// [half sizes²] Area of the part of the light that lies beyond the segment a→b, seen from the centre, within
    /// its angle. `side`: +1 where the centre lies left of it, −1 right.
    fn area_beyond(&self, [a, b]: [DVec2; 2], side: f64) -> f64 {
        let (low, high) = self.extent;
        let (least, most) = (a.min(b), a.max(b));
        if least.cmpge(high).any() || most.cmple(low).any() {
            return 0.0;
        }
        // Three half planes: beyond the ray to a, short of the ray to b, beyond the segment.
        let angle_from = Line {
            through: DVec2::ZERO,
            along: side * a,
        };
        let angle_to = Line {
            through: DVec2::ZERO,
            along: -side * b,
        };
        let segment = Line {
            through: a,
            along: side * (a - b),
        };
        self.outline
            .left_of(&angle_from)
            .left_of(&angle_to)
            .left_of(&segment)
            .area(self.rim)
    }
}

/// Bounds the half plane on its left.
struct Line {
    through: DVec2,
    along: DVec2,
}

/// A convex polygon, counter-clockwise: a box, cut by up to 16 edges and three lines.
#[derive(Clone, Copy)]
struct Polygon {
    corners: [DVec2; Self::MOST],
    count: usize,
}

impl Polygon {
    const MOST: usize = 4 + Corners::MOST + 3;

    fn new(corners: &[DVec2]) -> Self {
        let mut polygon = Self {
            corners: [DVec2::ZERO; Self::MOST],
            count: 0,
        };
        corners.iter().for_each(|&corner| polygon.push(corner));
        polygon
    }

    fn push(&mut self, corner: DVec2) {
        self.corners[self.count] = corner;
        self.count += 1;
    }

    fn edges(&self) -> impl Iterator<Item = (DVec2, DVec2)> {
        let next = |i| if i + 1 < self.count { i + 1 } else { 0 };
        (0..self.count).map(move |i| (self.corners[i], self.corners[next(i)]))
    }

    /// The part on the left of a line.
    fn left_of(&self, line: &Line) -> Self {
        let height = |p: DVec2| line.along.perp_dot(p - line.through);
        let mut part = Self::new(&[]);
        for (p, q) in self.edges() {
            let (from, to) = (height(p), height(q));
            if from >= 0.0 {
                part.push(p);
            }
            if (from >= 0.0) != (to >= 0.0) {
                part.push(p + (q - p) * (from / (from - to)));
            }
        }
        part
    }

    /// Area of the part within the rim, if there is one.
    fn area(&self, rim: Option<Rim>) -> f64 {
        self.edges()
            .map(|(p, q)| match rim {
                None => 0.5 * p.perp_dot(q),
                Some(rim) => rim.swept(p - rim.center, q - rim.center),
            })
            .sum()
    }
}

impl Rim {
    /// Signed area of the part of the triangle (0, p, q) that lies within the circle round 0.
    fn swept(self, p: DVec2, q: DVec2) -> f64 {
        let way = q - p;
        let (square, along) = (way.length_squared(), p.dot(way));
        let root = along * along - square * (p.length_squared() - self.radius * self.radius);
        if square == 0.0 || root <= 0.0 {
            return self.sector(p, q);
        }
        // Where p→q enters the circle and where it leaves it.
        let enter = ((-along - root.sqrt()) / square).clamp(0.0, 1.0);
        let leave = ((-along + root.sqrt()) / square).clamp(0.0, 1.0);
        if enter >= leave {
            return self.sector(p, q);
        }
        let (m, n) = (p + enter * way, p + leave * way);
        self.sector(p, m) + 0.5 * m.perp_dot(n) + self.sector(n, q)
    }

    fn sector(self, p: DVec2, q: DVec2) -> f64 {
        0.5 * self.radius * self.radius * p.perp_dot(q).atan2(p.dot(q))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn areas_within_a_rim_by_hand() {
        let rim = Some(Rim {
            center: DVec2::new(0.5, -0.25),
            radius: 1.0,
        });
        let square = |half: f64| {
            [(-half, -half), (half, -half), (half, half), (-half, half)]
                .map(|(x, y)| DVec2::new(x + 0.5, y - 0.25))
        };
        let lit_area = |corners: &[DVec2], rim| Polygon::new(corners).area(rim);
        assert!((lit_area(&square(2.0), rim) - PI).abs() < 1e-12);
        assert!((lit_area(&square(0.5), rim) - 1.0).abs() < 1e-12);
        assert!((lit_area(&square(0.5), None) - 1.0).abs() < 1e-12);
        // A disc less four segments at 0.8 of its radius.
        let segment = 0.8f64.acos() - 0.8 * 0.6;
        assert!((lit_area(&square(0.8), rim) - (PI - 4.0 * segment)).abs() < 1e-12);
    }
}
