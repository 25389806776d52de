//! Kernels [GBP06, SS07; Yang09 eq. 1, alg. 1 step 5]: twin of `kernels.comp` and of `lib/kernel.glsl`, in
//! f32 and operation by operation, because its results are integers.

use glam::Vec2;

use super::contour::ShadowMap;
use super::depth::{Receiver, extents};
use super::mssm::Mssm;
use crate::shared::{KERNEL_LIT, KERNEL_PENUMBRA, KERNEL_UMBRA, Kernel, View};

/// Rounds of query and shrinking.
const ROUNDS: u32 = 4;

/// [cell] Kernels no wider and no higher are looked at sample by sample.
const SAMPLED_SIDE: i32 = 2;

/// Dual cells, inclusive.
struct Cells {
    first: [i32; 2],
    last: [i32; 2],
    /// Nothing was cut off at the map's border.
    whole: bool,
}

/// x and y of a cell that a kernel or packet holds in one integer.
pub fn unpacked(cell: u32) -> [i32; 2] {
    [(cell & 0xffff) as i32, (cell >> 16) as i32]
}

fn packed(cell: [i32; 2]) -> u32 {
    cell[0] as u32 | (cell[1] as u32) << 16
}

/// The kernel of a receiver that the view has to look at, for contours.
pub fn kernel_of(
    view: &View,
    oblique: bool,
    receiver: &Receiver,
    map: &ShadowMap,
    mssm: &Mssm,
) -> Kernel {
    let lit = Kernel {
        status: KERNEL_LIT,
        ..Kernel::default()
    };
    // The projection's near plane is the nearest caster.
    let mut depth_max = 1.0;
    let mut found = None;
    for _ in 0..ROUNDS {
        if depth_max <= receiver.biased {
            return lit;
        }
        let cells = kernel_cells(view, oblique, receiver, depth_max);
        if (0..2).any(|axis| cells.first[axis] > cells.last[axis]) {
            return lit;
        }
        let range = mssm.query(cells.first, cells.last);
        found = Some((cells, range));
        if range[1] >= depth_max {
            break;
        }
        depth_max = range[1];
    }
    let Some((cells, range)) = found.filter(|_| depth_max > receiver.biased) else {
        return lit;
    };
    if nothing_occludes(receiver, map, &cells) {
        return lit;
    }
    let umbra = cells.whole && !receiver.behind && range[0] > highest_limit(receiver, &cells);
    Kernel {
        status: if umbra { KERNEL_UMBRA } else { KERNEL_PENUMBRA },
        first: packed(cells.first),
        last: packed(cells.last),
        depth_min: range[0],
        depth_max: range[1],
    }
}

/// Whether a kernel is small, and no sample in it occludes.
fn nothing_occludes(receiver: &Receiver, map: &ShadowMap, cells: &Cells) -> bool {
    let limit = receiver.limit();
    let is_small = (0..2).all(|axis| cells.last[axis] - cells.first[axis] < SAMPLED_SIDE);
    let samples = |axis: usize| cells.first[axis]..=cells.last[axis] + 1;
    let occludes = |x, y| limit.is_passed([x, y], map.depths[(y * map.size + x) as usize]);
    is_small && !samples(1).any(|y| samples(0).any(|x| occludes(x, y)))
}

/// The highest limit at the samples of the cells' corners.
fn highest_limit(receiver: &Receiver, cells: &Cells) -> f32 {
    receiver
        .limit()
        .highest(cells.first, cells.last.map(|i| i + 1))
}

/// The cells that occluders no nearer to the light than `depth_max` can project from.
fn kernel_cells(view: &View, oblique: bool, receiver: &Receiver, depth_max: f32) -> Cells {
    let near_side = depth_max - receiver.d;
    let (lower, upper) = if oblique {
        reach_of_corners(view, receiver, near_side)
    } else {
        let (lower, upper) = extents(view);
        let kappa = Vec2::new(receiver.ku.x, receiver.kv.y);
        (near_side * lower / kappa, near_side * upper / kappa)
    };
    let edge = view.map_size as i32 - 2;
    let cell = |t: Vec2| {
        let t = t
            .clamp(Vec2::splat(-2.0), Vec2::splat((edge + 2) as f32))
            .floor();
        [t.x as i32, t.y as i32]
    };
    let (first, last) = (cell(receiver.t + lower), cell(receiver.t + upper));
    let inside_first = first.map(|i| i.max(0));
    let inside_last = last.map(|i| i.min(edge));
    Cells {
        first: inside_first,
        last: inside_last,
        whole: first == inside_first && last == inside_last,
    }
}

/// [texel] Box round t_p of what the corners of the light's box project to at depth d_p + `near_side`, where
/// the map is not parallel to the light.
fn reach_of_corners(view: &View, receiver: &Receiver, near_side: f32) -> (Vec2, Vec2) {
    let Receiver { ku, kv, b, .. } = *receiver;
    let (low, high) = extents(view);
    let (mut lower, mut upper) = (Vec2::ZERO, Vec2::ZERO);
    let determinant = ku.x * kv.y - ku.y * kv.x;
    for q in [
        low,
        Vec2::new(high.x, low.y),
        Vec2::new(low.x, high.y),
        high,
    ] {
        let at = Vec2::new(q.x * kv.y - q.y * ku.y, q.y * ku.x - q.x * kv.x) / determinant;
        let share = 1.0 - b.dot(at);
        let dt = if share > 1e-4 {
            at * (near_side / share)
        } else {
            // Beyond the map's horizon: no bound.
            let sign = |x: f32| if x == 0.0 { 0.0 } else { x.signum() };
            Vec2::new(sign(at.x), sign(at.y)) * (2 * view.map_size) as f32
        };
        lower = lower.min(dt);
        upper = upper.max(dt);
    }
    (lower, upper)
}
