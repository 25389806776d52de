//! What a light's outline leaves of a cell of its grid.

use std::sync::Arc;

use glam::DVec2;

use crate::scene::polygon_area;

/// What cuts a part out of its cell \[half sizes of the cell, from the part's centre\].
#[derive(Debug, Clone, PartialEq)]
pub enum Cut {
    /// It is its cell.
    Nothing,
    /// The disc that bounds it.
    Rim { center: DVec2, radius: f64 },
    /// The sides of a polygon.
    Edges(Arc<[Edge]>),
}

/// A line that bounds what is within it: all q with normal · q ≤ distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Unit vector; 0 with a distance of 1: it bounds nothing.
    pub normal: DVec2,
    pub distance: f64,
}

/// What is left of a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Remnant {
    /// From the middle of the cell to the centre of what is left: a place inside is all that the radial integration asks for.
    pub shift: DVec2,
    /// Lower and upper corner of its box, seen from its centre.
    pub extent: (DVec2, DVec2),
    pub cut: Cut,
    /// None: the end of its sector table.
    pub area: Option<f64>,
}

/// [half sizes of the cell] What rounding makes of a line through a corner.
const ROUNDING: f64 = 1e-9;

impl Cut {
    pub fn holds(&self, at: DVec2) -> bool {
        match self {
            Self::Nothing => true,
            Self::Rim { center, radius } => at.distance(*center) < *radius,
            Self::Edges(edges) => edges.iter().all(|edge| edge.height(at) > 0.0),
        }
    }

    /// How many times `direction` reaches from the centre to it.
    pub fn border(&self, direction: DVec2) -> f64 {
        match self {
            Self::Nothing => f64::INFINITY,
            Self::Rim { center, radius } => {
                let along = center.dot(direction);
                let square = direction.length_squared();
                let root = along * along - square * (center.length_squared() - radius * radius);
                (along + root.max(0.0).sqrt()) / square
            }
            Self::Edges(edges) => {
                let ahead = |edge: &Edge| match edge.normal.dot(direction) {
                    towards if towards > 0.0 => edge.distance / towards,
                    _ => f64::INFINITY,
                };
                edges.iter().map(ahead).fold(f64::INFINITY, f64::min)
            }
        }
    }

    pub fn edges(&self) -> &[Edge] {
        match self {
            Self::Nothing | Self::Rim { .. } => &[],
            Self::Edges(edges) => edges,
        }
    }

    /// With so many edges, where there are some.
    pub fn padded(self, count: usize) -> Self {
        let nothing = Edge {
            normal: DVec2::ZERO,
            distance: 1.0,
        };
        match self {
            Self::Edges(edges) => {
                let all = edges.iter().copied().chain(std::iter::repeat(nothing));
                Self::Edges(all.take(count).collect())
            }
            other => other,
        }
    }
}

impl Edge {
    /// Along a side of a polygon that is counter-clockwise.
    fn along(from: DVec2, to: DVec2) -> Self {
        let normal = -(to - from).normalize().perp();
        Self {
            normal,
            distance: normal.dot(from),
        }
    }

    /// How far within it a place is.
    pub(super) fn height(&self, at: DVec2) -> f64 {
        self.distance - self.normal.dot(at)
    }

    fn seen_from(self, place: DVec2) -> Self {
        Self {
            distance: self.height(place),
            ..self
        }
    }
}

impl Remnant {
    pub fn whole() -> Self {
        Self {
            shift: DVec2::ZERO,
            extent: (DVec2::NEG_ONE, DVec2::ONE),
            cut: Cut::Nothing,
            area: Some(4.0),
        }
    }

    /// None: nothing of the cell lies in the disc. `cell`: its middle, seen from that of the disc; it reaches 1 to each side.
    pub fn of_disc(cell: DVec2, radius: f64) -> Option<Self> {
        if (cell.abs() + DVec2::ONE).length() <= radius {
            return Some(Self::whole());
        }
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
        Some(Self {
            shift,
            extent: (DVec2::NEG_ONE - shift, DVec2::ONE - shift),
            cut: Cut::Rim {
                center: -cell - shift,
                radius,
            },
            area: None,
        })
    }

    /// None: nothing of the cell lies in the polygon. `corners`: seen from the middle of the cell, which reaches 1 to each side.
    pub fn of_polygon(corners: &[DVec2]) -> Option<Self> {
        let mut left = corners.to_vec();
        for axis in [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y] {
            left = clipped(&left, |at| 1.0 - axis.dot(at));
        }
        let area = polygon_area(&left);
        if area <= ROUNDING {
            return None;
        }
        let shift = centroid(&left, area);
        let edges: Vec<Edge> = (sides(corners))
            .map(|(from, to)| Edge::along(from, to))
            .filter(|edge| edge.cuts(&left))
            .map(|edge| edge.seen_from(shift))
            .collect();
        if edges.is_empty() {
            return Some(Self::whole());
        }
        let lower = left.iter().copied().reduce(DVec2::min)?;
        let upper = left.iter().copied().reduce(DVec2::max)?;
        Some(Self {
            shift,
            extent: (lower - shift, upper - shift),
            cut: Cut::Edges(edges.into()),
            area: Some(area),
        })
    }
}

impl Edge {
    /// Whether it bounds what is left of the cell and leaves a part of the cell out.
    fn cuts(&self, left: &[DVec2]) -> bool {
        let farthest = self.normal.abs().element_sum();
        self.distance < farthest - ROUNDING && left.iter().any(|&at| self.height(at) < ROUNDING)
    }
}

fn sides(corners: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> {
    let next = corners.iter().cycle().skip(1);
    corners.iter().copied().zip(next.copied())
}

/// The part of a convex polygon where `height` ≥ 0 (Sutherland and Hodgman).
pub(super) fn clipped(corners: &[DVec2], height: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (from, to) in sides(corners) {
        let (before, after) = (height(from), height(to));
        if before >= 0.0 {
            kept.push(from);
        }
        if (before < 0.0) != (after < 0.0) {
            kept.push(from.lerp(to, before / (before - after)));
        }
    }
    kept
}

fn centroid(corners: &[DVec2], area: f64) -> DVec2 {
    // Around one of the corners, so that small ones far from the middle keep their precision.
    let apex = corners[0];
    let parts = sides(corners).map(|(from, to)| {
        let (from, to) = (from - apex, to - apex);
        (from + to) * from.perp_dot(to)
    });
    apex + parts.sum::<DVec2>() / (6.0 * area)
}
