//! The shadow-width map and what it does to light [Kirsch03 §3, §4]: twin of `shadow_width_seed.comp`, `shadow_width_spread.comp` and
//! `shadow_width_visibility.comp`, operation by operation.

use glam::{IVec2, Vec2};

use super::receiver::Receiver;
use crate::shared::{Fit, View};
use crate::technique::{Neighbours, Settings};

/// A map of widths, row by row.
pub struct ShadowWidths {
    side: i32,
    widths: Vec<f32>,
}

const DIRECTIONS: [Vec2; 6] = [
    Vec2::new(1.0, 0.0),
    Vec2::new(0.5, 0.866_025_4),
    Vec2::new(-0.5, 0.866_025_4),
    Vec2::new(-1.0, 0.0),
    Vec2::new(-0.5, -0.866_025_4),
    Vec2::new(0.5, -0.866_025_4),
];

/// The length of a way over the map \[texel\].
fn width_of(view: &View, fit: &Fit, way: Vec2) -> f32 {
    let scaled = way * (fit.near / (Vec2::from(fit.focal) * Vec2::from(view.half_size)));
    (scaled.x * scaled.x + scaled.y * scaled.y).sqrt()
}

impl ShadowWidths {
    /// `depths`: the shadow map, row by row; `spreads`: passes that spread widths.
    pub fn new(view: &View, fit: &Fit, settings: &Settings, depths: &[f32], spreads: u32) -> Self {
        let side = view.map_size as i32;
        let widths = match settings.neighbours {
            Neighbours::Flood => flooded(view, fit, depths, spreads),
            Neighbours::Three => iterated(view, fit, settings.start, depths, spreads, 2),
            Neighbours::Six => iterated(view, fit, settings.start, depths, spreads, 1),
        };
        Self { side, widths }
    }

    pub fn widths(&self) -> &[f32] {
        &self.widths
    }

    /// \[0, 1\] Share of the light that is hidden from a receiver; `depth`: of the sample nearest to it.
    pub fn hidden_share(&self, settings: &Settings, receiver: &Receiver, depth: f32) -> f32 {
        let difference = (depth - receiver.d).max(1e-30);
        let width = self.width_at(receiver.t);
        let light =
            (1.0 + settings.shadow_bias - settings.scale * width / difference).clamp(0.0, 1.0);
        match depth > receiver.biased {
            true => 1.0 - light,
            false => 0.0,
        }
    }

    fn width_at(&self, t: Vec2) -> f32 {
        let held = t.clamp(Vec2::ZERO, Vec2::splat((self.side - 1) as f32));
        let first = held.as_ivec2().min(IVec2::splat(self.side - 2));
        let share = held - first.as_vec2();
        let row = (first.y * self.side + first.x) as usize;
        let next = row + self.side as usize;
        let mix = |a: f32, b: f32, share: f32| a * (1.0 - share) + b * share;
        mix(
            mix(self.widths[row], self.widths[row + 1], share.x),
            mix(self.widths[next], self.widths[next + 1], share.x),
            share.y,
        )
    }
}

fn texels(side: i32) -> impl Iterator<Item = IVec2> {
    (0..side).flat_map(move |y| (0..side).map(move |x| IVec2::new(x, y)))
}

/// The least width by way of neighbours, of which every `step`-th is asked.
fn iterated(
    view: &View,
    fit: &Fit,
    start: u32,
    depths: &[f32],
    spreads: u32,
    step: usize,
) -> Vec<f32> {
    let side = view.map_size as i32;
    let widest = width_of(view, fit, Vec2::new(start as f32, 0.0)).max(width_of(
        view,
        fit,
        Vec2::new(0.0, start as f32),
    ));
    let mut widths: Vec<f32> = depths
        .iter()
        .map(|&d| if d > 0.0 { widest } else { 0.0 })
        .collect();
    for level in 0..spreads {
        let distance = (1u32 << level) as f32;
        let least = |texel: IVec2| {
            let own = widths[(texel.y * side + texel.x) as usize];
            DIRECTIONS
                .iter()
                .step_by(step)
                .fold(own, |least, direction| {
                    let way = (distance * *direction + 0.5).floor();
                    let at = texel + way.as_ivec2();
                    let inside = at.cmpge(IVec2::ZERO).all() && at.cmplt(IVec2::splat(side)).all();
                    let known = if inside {
                        widths[(at.y * side + at.x) as usize]
                    } else {
                        0.0
                    };
                    least.min(known + width_of(view, fit, way))
                })
        };
        widths = texels(side).map(least).collect();
    }
    widths
}

/// The way to the nearest texel that nothing hides, as jump flooding finds it.
fn flooded(view: &View, fit: &Fit, depths: &[f32], spreads: u32) -> Vec<f32> {
    let side = view.map_size as i32;
    let seed = |texel: IVec2| (depths[(texel.y * side + texel.x) as usize] <= 0.0).then_some(texel);
    let mut seeds: Vec<Option<IVec2>> = texels(side).map(seed).collect();
    let far = |texel: IVec2, seed: Option<IVec2>| {
        seed.map_or(1e30, |seed| width_of(view, fit, (texel - seed).as_vec2()))
    };
    for level in 0..spreads {
        let distance = 1 << (spreads - 1 - level);
        let nearest = |texel: IVec2| {
            let mut best = (None, 1e30);
            for i in 0..9 {
                let at = texel + distance * IVec2::new(i % 3 - 1, i / 3 - 1);
                let held = at.clamp(IVec2::ZERO, IVec2::splat(side - 1));
                let known = seeds[(held.y * side + held.x) as usize];
                let width = far(texel, known);
                if width < best.1 {
                    best = (known, width);
                }
            }
            best.0
        };
        seeds = texels(side).map(nearest).collect();
    }
    texels(side)
        .zip(seeds)
        .map(|(texel, seed)| far(texel, seed))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A view and a fit with square texels of length 1.
    fn square(side: u32) -> (View, Fit) {
        let view = View {
            map_size: side,
            half_size: [1.0, 1.0],
            ..View::default()
        };
        let fit = Fit {
            near: 1.0,
            focal: [1.0, 1.0],
            ..Fit::default()
        };
        (view, fit)
    }

    /// A disc of hidden texels.
    fn disc(side: i32, radius: f32) -> Vec<f32> {
        let middle = Vec2::splat(0.5 * (side - 1) as f32);
        let hidden = |texel: IVec2| (texel.as_vec2() - middle).length() < radius;
        texels(side).map(|texel| f32::from(hidden(texel))).collect()
    }

    /// The distance to the nearest lit texel, by asking all.
    fn asked(side: i32, depths: &[f32]) -> Vec<f32> {
        let lit: Vec<IVec2> = (texels(side).zip(depths))
            .filter_map(|(texel, depth)| (*depth == 0.0).then_some(texel))
            .collect();
        let nearest = |texel: IVec2| {
            let ways = lit.iter().map(|lit| (texel - lit).as_vec2().length());
            ways.fold(f32::INFINITY, f32::min)
        };
        texels(side).map(nearest).collect()
    }

    #[test]
    fn flooding_finds_distances() {
        let (view, fit) = square(32);
        let depths = disc(32, 12.0);
        let found = flooded(&view, &fit, &depths, 5);
        for (found, asked) in found.iter().zip(asked(32, &depths)) {
            // Flooding misses the nearest texel now and then, by less than one.
            assert!(
                *found >= asked - 1e-5 && *found < asked + 1.0,
                "{found} for {asked}"
            );
        }
    }

    #[test]
    fn neighbours_never_tell_less_than_the_distance() {
        let (view, fit) = square(32);
        let depths = disc(32, 12.0);
        for step in [1, 2] {
            let found = iterated(&view, &fit, 64, &depths, 7, step);
            for (found, asked) in found.iter().zip(asked(32, &depths)) {
                assert!(*found >= asked - 1e-4, "{found} for {asked}");
                assert!((*found == 0.0) == (asked == 0.0));
            }
        }
    }
}
