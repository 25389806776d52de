//! Irradiance in f64, from its definition: an adaptive quadrature over the visible part of the light's area.

use glam::{DVec2, DVec3, Vec2, Vec3};
use halfshade::shared::Light;

/// Positive nodes and weights of Gauss and Legendre's rule of five.
const PAIRS: [[f64; 2]; 2] = [
    [0.538_469_310_105_683_1, 0.478_628_670_499_366_5],
    [0.906_179_845_938_664, 0.236_926_885_056_189_1],
];
const MIDDLE: f64 = 0.568_888_888_888_888_9;
/// Relative error of a piece, estimated by halving it.
const TOLERANCE: f64 = 1e-7;
/// Pieces are halved this often at most, which at the root-shaped ends of a disc leaves a share of 2^-30.
const HALVINGS: u32 = 20;

fn gauss(f: &impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let pairs =
        PAIRS.map(|[node, weight]| weight * (f(middle - half * node) + f(middle + half * node)));
    half * (MIDDLE * f(middle) + pairs[0] + pairs[1])
}

fn refined(f: &impl Fn(f64) -> f64, from: f64, to: f64, whole: f64, halvings: u32) -> f64 {
    let middle = 0.5 * (from + to);
    let (left, right) = (gauss(f, from, middle), gauss(f, middle, to));
    if halvings == 0 || (left + right - whole).abs() <= TOLERANCE * (left + right).abs() {
        return left + right;
    }
    refined(f, from, middle, left, halvings - 1) + refined(f, middle, to, right, halvings - 1)
}

/// The integral of a positive function over the pieces between `ends` and those of `breaks` that lie between them.
fn integral(f: impl Fn(f64) -> f64, ends: [f64; 2], breaks: &[f64]) -> f64 {
    let mut places = vec![ends[0], ends[1]];
    places.extend(breaks.iter().filter(|at| ends[0] < **at && **at < ends[1]));
    places.sort_by(f64::total_cmp);
    let pieces = places.windows(2);
    pieces
        .map(|piece| {
            refined(
                &f,
                piece[0],
                piece[1],
                gauss(&f, piece[0], piece[1]),
                HALVINGS,
            )
        })
        .sum()
}

/// A light and a receiver in f64, the light's axes made orthonormal.
pub struct Scene {
    /// From the receiver to the light's centre.
    pub way: DVec3,
    pub normal: DVec3,
    axes: [DVec3; 3],
    half: DVec2,
    disc: bool,
    /// [half sizes] Of a polygon, counter-clockwise.
    corners: Vec<DVec2>,
}

impl Scene {
    pub fn new(light: &Light, corners: &[[f32; 2]], position: Vec3, normal: Vec3) -> Self {
        let of = |vector: [f32; 3]| Vec3::from(vector).as_dvec3();
        let n = of(light.n).normalize();
        let u = of(light.u).reject_from_normalized(n).normalize();
        Self {
            way: of(light.center) - position.as_dvec3(),
            normal: normal.as_dvec3(),
            axes: [u, n.cross(u), n],
            half: DVec2::from(light.half_size.map(f64::from)),
            disc: light.round != 0,
            corners: (corners.iter())
                .map(|&corner| Vec2::from(corner).as_dvec2())
                .collect(),
        }
    }

    pub fn area(&self) -> f64 {
        self.outline_area() * self.half.x * self.half.y
    }

    /// [half sizes²]
    fn outline_area(&self) -> f64 {
        match (self.disc, self.corners.is_empty()) {
            (true, _) => std::f64::consts::PI,
            (_, true) => 4.0,
            _ => 0.5 * self.sides().map(|(p, q)| p.perp_dot(q)).sum::<f64>(),
        }
    }

    fn sides(&self) -> impl Iterator<Item = (DVec2, DVec2)> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().copied().zip(next.copied())
    }

    /// [half sizes] The light's ends on the line x = s.
    fn ends(&self, s: f64) -> (f64, f64) {
        if self.disc {
            let chord = (1.0 - s * s).max(0.0).sqrt();
            return (-chord, chord);
        }
        if self.corners.is_empty() {
            return (-1.0, 1.0);
        }
        let mut ends = (f64::INFINITY, f64::NEG_INFINITY);
        for (from, to) in self.sides() {
            if (from.x <= s) != (to.x <= s) {
                let at = from.y + (to.y - from.y) * ((s - from.x) / (to.x - from.x));
                ends = (ends.0.min(at), ends.1.max(at));
            }
        }
        ends
    }

    /// The height of the light's highest point over the sum of distance and half sizes.
    pub fn highest_cosine(&self) -> f64 {
        let along =
            DVec2::new(self.normal.dot(self.axes[0]), self.normal.dot(self.axes[1])) * self.half;
        let reach = match (self.disc, self.corners.is_empty()) {
            (true, _) => along.length(),
            (_, true) => along.x.abs() + along.y.abs(),
            _ => (self.corners.iter()).fold(f64::NEG_INFINITY, |reach, corner| {
                reach.max(corner.dot(along))
            }),
        };
        (self.normal.dot(self.way) + reach) / (self.way.length() + self.half.x + self.half.y)
    }

    /// The mean over the light's area of cos · cos / r².
    pub fn irradiance(&self) -> f64 {
        let [u, v, n] = self.axes;
        let distance = -self.way.dot(n);
        if distance <= 0.0 {
            return 0.0;
        }
        let foot = -DVec2::new(self.way.dot(u), self.way.dot(v)) / self.half;
        let height = self.normal.dot(self.way);
        let rise = DVec2::new(self.normal.dot(u), self.normal.dot(v)) * self.half;
        let along_v = |s: f64| {
            let (first, last) = self.ends(s);
            let horizon = -(height + rise.x * s) / rise.y;
            let (low, high) = match rise.y {
                0.0 if height + rise.x * s <= 0.0 => return 0.0,
                0.0 => (first, last),
                rise if rise > 0.0 => (horizon.max(first), last),
                _ => (first, horizon.min(last)),
            };
            let at = |t: f64| {
                let to_light = self.way + u * (s * self.half.x) + v * (t * self.half.y);
                let square = to_light.length_squared();
                let above = height + rise.x * s + rise.y * t;
                above.max(0.0) * distance / (square * square)
            };
            if low < high {
                integral(at, [low, high], &[foot.y])
            } else {
                0.0
            }
        };
        let mut breaks = vec![foot.x];
        if rise.x != 0.0 {
            let crossings = match self.disc {
                false => [(-height - rise.y) / rise.x, (rise.y - height) / rise.x],
                true => self.crossings_of_disc(height, rise),
            };
            breaks.extend(crossings);
        }
        breaks.extend(self.corners.iter().map(|corner| corner.x));
        breaks.extend(self.sides().map(|(from, to)| {
            let (before, after) = (height + rise.dot(from), height + rise.dot(to));
            from.x + (to.x - from.x) * (before / (before - after))
        }));
        breaks.extend(self.sides().map(|(from, to)| {
            // Where a side passes the foot.
            let along = (foot - from).dot(to - from) / (to - from).length_squared();
            from.x + (to.x - from.x) * along
        }));
        integral(along_v, [-1.0, 1.0], &breaks) / self.outline_area()
    }

    /// [half sizes] Where the horizon meets the rim.
    fn crossings_of_disc(&self, height: f64, rise: DVec2) -> [f64; 2] {
        let offset = -height / rise.length();
        let chord = (1.0 - offset * offset).max(0.0).sqrt();
        let up = rise / rise.length();
        [offset * up.x - chord * up.y, offset * up.x + chord * up.y]
    }
}
