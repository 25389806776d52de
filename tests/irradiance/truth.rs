//! Irradiance in f64, from its definition: an adaptive quadrature over the visible part of the light's area.

use glam::{DVec2, DVec3, Vec3};
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
}

impl Scene {
    pub fn new(light: &Light, position: Vec3, normal: Vec3) -> Self {
        let of = |vector: [f32; 3]| Vec3::from(vector).as_dvec3();
        let n = of(light.n).normalize();
        let u = of(light.u).reject_from_normalized(n).normalize();
        Self {
            way: of(light.center) - position.as_dvec3(),
            normal: normal.as_dvec3(),
            axes: [u, n.cross(u), n],
            half: DVec2::from(light.half_size.map(f64::from)),
            disc: light.round != 0,
        }
    }

    pub fn area(&self) -> f64 {
        let shape = if self.disc { std::f64::consts::PI } else { 4.0 };
        shape * self.half.x * self.half.y
    }

    /// The height of the light's highest point over the sum of distance and half sizes.
    pub fn highest_cosine(&self) -> f64 {
        let along = DVec2::new(self.normal.dot(self.axes[0]), self.normal.dot(self.axes[1])).abs()
            * self.half;
        let reach = if self.disc {
            along.length()
        } else {
            along.x + along.y
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
            let border = if self.disc {
                (1.0 - s * s).max(0.0).sqrt()
            } else {
                1.0
            };
            let horizon = -(height + rise.x * s) / rise.y;
            let (low, high) = match rise.y {
                0.0 if height + rise.x * s <= 0.0 => return 0.0,
                0.0 => (-border, border),
                rise if rise > 0.0 => (horizon.max(-border), border),
                _ => (-border, horizon.min(border)),
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
        let shape = if self.disc { std::f64::consts::PI } else { 4.0 };
        integral(along_v, [-1.0, 1.0], &breaks) / shape
    }

    /// [half sizes] Where the horizon meets the rim.
    fn crossings_of_disc(&self, height: f64, rise: DVec2) -> [f64; 2] {
        let offset = -height / rise.length();
        let chord = (1.0 - offset * offset).max(0.0).sqrt();
        let up = rise / rise.length();
        [offset * up.x - chord * up.y, offset * up.x + chord * up.y]
    }
}
