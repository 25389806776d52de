//! Soft shadow maps [Atty06 §3.3, §3.4]: twin of `soft_shadow_map.glsl`, `scatter.vert`, `scatter.frag` and
//! `soft_visibility.comp`. Of each texel it asks all patches, so that extents are put to the test as well.

use glam::{DVec2, DVec4, IVec2, Vec2};

use super::receiver::Receiver;
use crate::shared::{Fit, View};

/// Places of texels: t = focal · tangent + center.
#[derive(Debug, Clone, Copy)]
pub struct Grid {
    pub focal: DVec2,
    pub center: DVec2,
}

/// What a soft shadow map is made of, in depths d = near / z, row by row; 0 = empty.
#[derive(Debug, Clone, Copy)]
pub struct Maps<'a> {
    pub occluders: &'a [f32],
    /// Of the patches below the occluders'; none where there are none.
    pub bottoms: &'a [f32],
    pub receivers: &'a [f32],
}

/// A soft shadow map.
pub struct SoftShadowMap {
    side: i32,
    fit: Grid,
    grid: Grid,
    /// Shares of the light that are hidden, of which some are more than 1.
    sums: Vec<f64>,
}

/// The depth that is stored as 1 − d; 0 = empty.
pub fn farthest_of(stored: f32) -> f32 {
    match stored > 0.0 {
        true => 1.0 - stored,
        false => 0.0,
    }
}

/// The float of a bound that `atomicMax` has reduced.
fn value_of(bound: u32) -> f64 {
    let bits = match bound >> 31 {
        0 => !bound,
        _ => bound & 0x7fff_ffff,
    };
    f64::from(f32::from_bits(bits))
}

/// The rectangle that stands for the sub-light \[half sizes\]: its lower and its upper corner.
pub fn light_box(view: &View) -> (DVec2, DVec2) {
    let [x0, y0, x1, y1] = view.extent.map(f64::from);
    let (lower, upper) = (DVec2::new(x0, y0), DVec2::new(x1, y1));
    let size = upper - lower;
    let reach = 0.5 * size * (f64::from(view.area) / (size.x * size.y)).sqrt();
    let middle = 0.5 * (lower + upper);
    (middle - reach, middle + reach)
}

fn half_size(view: &View) -> DVec2 {
    DVec2::from_array(view.half_size.map(f64::from))
}

impl Grid {
    fn of_fit(fit: &Fit) -> Self {
        Self {
            focal: DVec2::from_array(fit.focal.map(f64::from)),
            center: DVec2::from_array(fit.center.map(f64::from)),
        }
    }

    /// The soft shadow map's.
    pub fn new(view: &View, fit: &Fit) -> Self {
        let (box_lower, box_upper) = light_box(view);
        let receivers = fit.receiver_bounds.map(value_of);
        let casters = fit.caster_bounds.map(value_of);
        let (most, least) = (receivers[2], -receivers[5]);
        let spread = half_size(view) * (1.0 / f64::from(fit.near) - 1.0 / most).max(0.0);
        let tangent = |side: f64| side / if side > 0.0 { least } else { most }.max(1e-30);
        let upper = |axis: usize| {
            let reached = casters[axis] - box_lower[axis] * spread[axis];
            reached.min(tangent(receivers[axis]))
        };
        let lower = |axis: usize| {
            let reached = casters[axis + 2] + box_upper[axis] * spread[axis];
            (-reached).max(-tangent(receivers[axis + 3]))
        };
        let (upper, lower) = (
            DVec2::new(upper(0), upper(1)),
            DVec2::new(lower(0), lower(1)),
        );
        let side = f64::from(view.map_size);
        let focal = (side - 2.0) / (upper - lower).max(DVec2::splat(1e-5));
        Self {
            focal,
            center: 0.5 * (side - 1.0) - focal * 0.5 * (lower + upper),
        }
    }

    fn tangent(&self, texel: DVec2) -> DVec2 {
        (texel - self.center) / self.focal
    }
}

/// A micropatch as a receiver sees it.
struct Patch {
    /// Tangents under which the light's centre sees its corners.
    lower: DVec2,
    upper: DVec2,
    depth: f64,
}

/// What a patch's back-projection leaves of the light, \[0, 1\]²: lower and upper corner.
fn on_light(view: &View, near: f64, patch: &Patch, receiver: (DVec2, f64)) -> DVec4 {
    let (tangent, depth) = receiver;
    if patch.depth <= depth {
        return DVec4::ZERO;
    }
    let (lower, upper) = light_box(view);
    let place = |corner: DVec2| {
        let q = near * (corner - tangent) / (half_size(view) * (patch.depth - depth));
        ((q - lower) / (upper - lower)).clamp(DVec2::ZERO, DVec2::ONE)
    };
    let (lower, upper) = (place(patch.lower), place(patch.upper));
    DVec4::new(lower.x, lower.y, upper.x, upper.y)
}

fn area_of(part: DVec4) -> f64 {
    (part.z - part.x).max(0.0) * (part.w - part.y).max(0.0)
}

impl SoftShadowMap {
    pub fn new(view: &View, fit: &Fit, maps: Maps) -> Self {
        let side = view.map_size as i32;
        let (of_fit, grid) = (Grid::of_fit(fit), Grid::new(view, fit));
        let patches: Vec<(Patch, Patch)> = texels(side)
            .zip(maps.occluders)
            .enumerate()
            .filter(|(_, (_, depth))| **depth > 0.0)
            .map(|(index, (texel, &depth))| {
                let patch = |depth: f32| Patch {
                    lower: of_fit.tangent(texel.as_dvec2() - 0.5),
                    upper: of_fit.tangent(texel.as_dvec2() + 0.5),
                    depth: depth.into(),
                };
                let bottom = maps.bottoms.get(index).copied().unwrap_or(0.0);
                (patch(depth), patch(bottom))
            })
            .collect();
        let near = f64::from(fit.near);
        let sum = |(texel, &depth): (IVec2, &f32)| {
            let receiver = (grid.tangent(texel.as_dvec2()), f64::from(depth));
            let hidden = |(top, bottom): &(Patch, Patch)| {
                let (top, bottom) = (
                    on_light(view, near, top, receiver),
                    on_light(view, near, bottom, receiver),
                );
                let both = DVec4::new(
                    top.x.max(bottom.x),
                    top.y.max(bottom.y),
                    top.z.min(bottom.z),
                    top.w.min(bottom.w),
                );
                area_of(top) + area_of(bottom) - area_of(both)
            };
            match depth > 0.0 {
                true => patches.iter().map(hidden).sum(),
                false => 0.0,
            }
        };
        Self {
            side,
            fit: of_fit,
            grid,
            sums: texels(side).zip(maps.receivers).map(sum).collect(),
        }
    }

    pub fn sums(&self) -> &[f64] {
        &self.sums
    }

    /// \[0, 1\] Share of the light that is hidden from a pixel. `receivers`: as in [`Maps`]; `sums`: of this map and of others
    /// with the same grid, of which the darkest counts.
    pub fn hidden_share(&self, pixel: &Receiver, receivers: &[f32], sums: &[&[f64]]) -> f64 {
        let t = self.grid.focal * self.fit.tangent(pixel.t.as_dvec2()) + self.grid.center;
        let t = t.clamp(DVec2::ZERO, DVec2::splat(f64::from(self.side - 1)));
        let first = t.as_ivec2().min(IVec2::splat(self.side - 2));
        let share = t - first.as_dvec2();
        let (mut sum, mut weight) = (0.0, 0.0);
        for corner in [IVec2::ZERO, IVec2::X, IVec2::Y, IVec2::ONE] {
            let texel = first + corner;
            let index = (texel.y * self.side + texel.x) as usize;
            let along = DVec2::select(corner.cmpeq(IVec2::ONE), share, 1.0 - share);
            let at = self.fit.focal * self.grid.tangent(texel.as_dvec2()) + self.fit.center;
            if receives(pixel, at.as_vec2(), receivers[index]) {
                let hidden = sums.iter().map(|sums| sums[index]).fold(0.0, f64::max);
                sum += along.x * along.y * hidden;
                weight += along.x * along.y;
            }
        }
        match weight > 0.0 {
            true => (sum / weight).clamp(0.0, 1.0),
            false => 0.0,
        }
    }
}

/// Whether the pixel's plane lies no nearer to the light than the receiver of a texel.
fn receives(pixel: &Receiver, at: Vec2, depth: f32) -> bool {
    const SLACK: f32 = 0.01;
    const TOLERANCE: f32 = 1e-3;
    let rise = pixel.plane.dot(at - pixel.t);
    let own = pixel.d + rise.max(-SLACK * pixel.d);
    depth > 0.0 && own <= (1.0 + TOLERANCE) * depth
}

fn texels(side: i32) -> impl Iterator<Item = IVec2> {
    (0..side).flat_map(move |y| (0..side).map(move |x| IVec2::new(x, y)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square light of half size 1, and a map whose texels are 0.1 wide in tangents.
    fn stage(side: u32) -> (View, Fit) {
        let view = View {
            map_size: side,
            half_size: [1.0, 1.0],
            extent: [-1.0, -1.0, 1.0, 1.0],
            area: 4.0,
            ..View::default()
        };
        let bound = |value: f32| value.to_bits() | 0x8000_0000;
        let negated = |value: f32| !(-value).to_bits();
        let fit = Fit {
            near: 1.0,
            focal: [10.0, 10.0],
            center: [0.5 * (side as f32 - 1.0); 2],
            // Receivers at z = 4 far to all sides, casters within a tangent of 1.
            receiver_bounds: [
                bound(100.0),
                bound(100.0),
                bound(4.0),
                bound(100.0),
                bound(100.0),
                negated(4.0),
            ],
            caster_bounds: [bound(1.0), bound(1.0), bound(1.0), bound(1.0), negated(1.0)],
            ..Fit::default()
        };
        (view, fit)
    }

    #[test]
    fn the_grid_reaches_as_far_as_penumbrae() {
        let (view, fit) = stage(32);
        let grid = Grid::new(&view, &fit);
        // 1 + 1 · (1/1 − 1/4), and a texel of margin.
        let (lower, upper) = (
            grid.tangent(DVec2::splat(0.5)),
            grid.tangent(DVec2::splat(30.5)),
        );
        assert!(lower.abs_diff_eq(DVec2::splat(-1.75), 1e-12), "{lower}");
        assert!(upper.abs_diff_eq(DVec2::splat(1.75), 1e-12), "{upper}");
    }

    /// Patches of one depth join on the light without gap or overlap, so that together they hide what their square hides.
    #[test]
    fn patches_of_one_depth_are_one_square() {
        let (view, fit) = stage(16);
        let occluders: Vec<f32> = texels(16)
            .map(|texel| f32::from(texel.max_element() < 12 && texel.min_element() >= 4) * 0.5)
            .collect();
        let receivers = [0.25; 256];
        let map = SoftShadowMap::new(
            &view,
            &fit,
            Maps {
                occluders: &occluders,
                bottoms: &[],
                receivers: &receivers,
            },
        );
        // Its half size in tangents is 0.4; seen from the axis its back-projection has 0.4 / (0.5 − 0.25).
        let grid = Grid::new(&view, &fit);
        for (texel, sum) in texels(16).zip(map.sums()) {
            let at = grid.tangent(texel.as_dvec2());
            let along = |at: f64| {
                let (lower, upper) = ((-0.4 - at) / 0.25, (0.4 - at) / 0.25);
                (upper.min(1.0) - lower.max(-1.0)).max(0.0) / 2.0
            };
            let wanted = along(at.x) * along(at.y);
            assert!((sum - wanted).abs() < 1e-12, "{sum} for {wanted}");
        }
    }

    /// A patch and its bottom hide no more than the light, and no less than either of them.
    #[test]
    fn a_bottom_counts_once() {
        let (view, fit) = stage(16);
        let at = |depth: f32| -> Vec<f32> {
            let here = |texel: IVec2| f32::from(texel == IVec2::splat(8)) * depth;
            texels(16).map(here).collect()
        };
        let (top, bottom, receivers) = (at(0.9), at(0.3), [0.25; 256]);
        let sums = |occluders: &[f32], bottoms: &[f32]| {
            let maps = Maps {
                occluders,
                bottoms,
                receivers: &receivers,
            };
            SoftShadowMap::new(&view, &fit, maps).sums().to_vec()
        };
        let (tops, bottoms, both) = (sums(&top, &[]), sums(&bottom, &[]), sums(&top, &bottom));
        for ((top, bottom), both) in tops.iter().zip(&bottoms).zip(&both) {
            assert!(*both >= top.max(*bottom) - 1e-12 && *both <= (top + bottom).min(1.0) + 1e-12);
        }
        assert!(both.iter().zip(&tops).any(|(both, top)| *both > top + 0.05));
    }
}
