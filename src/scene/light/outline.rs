//! What bounds a light in its plane.

use std::f64::consts::PI;
use std::ops::Deref;

use glam::DVec2;

/// [half sizes] Corners of one polygon, however it stands.
const ROUNDING: f64 = 1e-6;

/// A convex outline in half sizes, seen from the light's centre.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "a host moves lights in every frame, which must not allocate"
)]
pub enum Outline {
    /// The square from −1 to 1.
    Square,
    /// The disc of radius 1.
    Disc,
    Polygon(Corners),
}

/// The corners of a convex polygon with an area, counter-clockwise, within the square from −1 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corners {
    places: [DVec2; Self::MOST],
    count: usize,
}

impl Outline {
    /// [half sizes²]
    pub fn area(&self) -> f64 {
        match self {
            Self::Square => 4.0,
            Self::Disc => PI,
            Self::Polygon(corners) => polygon_area(corners),
        }
    }

    /// How far it reaches from the centre along a direction, times the direction's length.
    pub fn reach(&self, direction: DVec2) -> f64 {
        match self {
            Self::Square => direction.x.abs() + direction.y.abs(),
            Self::Disc => direction.length(),
            Self::Polygon(corners) => {
                let along = corners.iter().map(|corner| corner.dot(direction));
                along.fold(f64::NEG_INFINITY, f64::max)
            }
        }
    }

    /// Whether it is the other one, but for what rounding makes of a light that is turned and moved.
    pub fn is_like(&self, other: &Self) -> bool {
        let (own, others) = (self.corners(), other.corners());
        let near = |(a, b): (&DVec2, &DVec2)| a.distance(*b) < ROUNDING;
        match (self, other) {
            (Self::Polygon(_), Self::Polygon(_)) => {
                own.len() == others.len() && own.iter().zip(others).all(near)
            }
            _ => self == other,
        }
    }

    /// A polygon's; none of other outlines.
    pub fn corners(&self) -> &[DVec2] {
        match self {
            Self::Square | Self::Disc => &[],
            Self::Polygon(corners) => corners,
        }
    }
}

impl Corners {
    pub const FEWEST: usize = 3;
    pub const MOST: usize = 16;

    /// Of no more places than a polygon may have.
    pub(super) fn new(places: impl Iterator<Item = DVec2>) -> Self {
        let mut corners = Self {
            places: [DVec2::ZERO; Self::MOST],
            count: 0,
        };
        for (corner, place) in corners.places.iter_mut().zip(places) {
            *corner = place;
            corners.count += 1;
        }
        corners
    }

    /// The polygon's point for a point of the square \[0, 1)²: equal areas for equal areas. `share.x` goes around the first corner,
    /// `share.y` away from it.
    pub fn place(&self, share: DVec2) -> DVec2 {
        let apex = self[0];
        let mut left = share.x * polygon_area(self);
        let mut triangles = self[1..].windows(2).peekable();
        while let Some(side) = triangles.next() {
            let [from, to] = [side[0] - apex, side[1] - apex];
            let area = 0.5 * from.perp_dot(to);
            if left < area || triangles.peek().is_none() {
                return apex + from.lerp(to, (left / area).clamp(0.0, 1.0)) * share.y.sqrt();
            }
            left -= area;
        }
        apex
    }
}

impl Deref for Corners {
    type Target = [DVec2];

    fn deref(&self) -> &[DVec2] {
        &self.places[..self.count]
    }
}

/// Of a polygon, counter-clockwise.
pub fn polygon_area(corners: &[DVec2]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    let doubled = corners.iter().zip(next).map(|(p, q)| p.perp_dot(*q));
    0.5 * doubled.sum::<f64>()
}
