//! Kernels [GBP06, SS07; Yang09 eq. 1, alg. 1 step 5]: twin of `kernels.comp` and of `lib/kernel.glsl`, in
//! f32 and operation by operation, because its results are integers.

use glam::Vec2;

use super::contour::ShadowMap;
use super::hierarchy::Hierarchy;
use super::quality::Budget;
use super::receiver::{Receiver, extents};
use crate::shared::{KERNEL_LIT, KERNEL_PENUMBRA, KERNEL_UMBRA, Kernel, View};

/// Rounds of query and shrinking.
const ROUNDS: u32 = 8;

/// The rounds from here on ask for smaller nodes, unless an earlier one has changed nothing.
const COARSE_ROUNDS: u32 = 2;

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

/// The kernel of a receiver that the view has to look at, for contours; `budget`: what limits its quality; `depth_max`: no occluder
/// is nearer to the light, 1 at most.
pub fn kernel_of(
    view: &View,
    oblique: bool,
    receiver: &Receiver,
    map: &ShadowMap,
    hierarchy: &Hierarchy,
    budget: Option<&Budget>,
    mut depth_max: f32,
) -> Kernel {
    let lit = Kernel {
        status: KERNEL_LIT,
        ..Kernel::default()
    };
    let mut found = None;
    let finest = u32::from(hierarchy.is_sparse());
    let mut finer = 0;
    for round in 1..=ROUNDS {
        if depth_max <= receiver.biased {
            return lit;
        }
        let cells = kernel_cells(view, oblique, receiver, depth_max);
        if (0..2).any(|axis| cells.first[axis] > cells.last[axis]) {
            return lit;
        }
        let (first, last) = budget.map_or((cells.first, cells.last), |budget| {
            budget.queried((cells.first, cells.last), map.size)
        });
        let range = hierarchy.query(first, last, finer);
        found = Some((cells, range));
        let stalls = range[1] >= depth_max;
        if stalls && finer == finest {
            break;
        }
        if stalls || round >= COARSE_ROUNDS {
            finer = finest;
        }
        depth_max = depth_max.min(range[1]);
    }
    let Some((cells, range)) = found.filter(|_| depth_max > receiver.biased) else {
        return lit;
    };
    let is_coarse = budget.is_some_and(|budget| budget.level((cells.first, cells.last)) > 0);
    if !is_coarse && nothing_occludes(receiver, map, &cells) {
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

/// [texel] Farther than any map reaches from where a receiver falls.
const ENDLESS: f32 = 1e9;

/// [texel] Box round t_p of what the corners of the light's box project to at depth d_p + `near_side`, where
/// the map is not parallel to the light.
fn reach_of_corners(view: &View, receiver: &Receiver, near_side: f32) -> (Vec2, Vec2) {
    let Receiver { ku, kv, b, .. } = *receiver;
    let (low, high) = extents(view);
    let (mut lower, mut upper) = (Vec2::ZERO, Vec2::ZERO);
    let mut unbounded = false;
    let determinant = ku.x * kv.y - ku.y * kv.x;
    for q in [
        low,
        Vec2::new(high.x, low.y),
        Vec2::new(low.x, high.y),
        high,
    ] {
        let at = Vec2::new(q.x * kv.y - q.y * ku.y, q.y * ku.x - q.x * kv.x) / determinant;
        let share = 1.0 - b.dot(at);
        let beyond_horizon = share <= 1e-4;
        let dt = if beyond_horizon {
            at
        } else {
            at * (near_side / share)
        };
        lower = lower.min(dt);
        upper = upper.max(dt);
        unbounded |= beyond_horizon;
    }
    if unbounded {
        let endless = |x: f32| if x == 0.0 { 0.0 } else { x.signum() * ENDLESS };
        lower = Vec2::new(endless(lower.x), endless(lower.y));
        upper = Vec2::new(endless(upper.x), endless(upper.y));
    }
    (lower, upper)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;
    use crate::shared::Fit;
    use crate::twin::receiver::project;

    const MAP: u32 = 128;

    /// The side face along u of a light round the origin that shines along z.
    fn side_face(half_size: f32) -> View {
        View {
            right: [0.0, 1.0, 0.0],
            up: [0.0, 0.0, 1.0],
            forward: [1.0, 0.0, 0.0],
            light_u: [1.0 / half_size, 0.0, 0.0],
            light_v: [0.0, 1.0 / half_size, 0.0],
            light_n: [0.0, 0.0, 1.0],
            half_size: [half_size; 2],
            extent: [-1.0, -1.0, 1.0, 1.0],
            face: 1,
            map_size: MAP,
            ..View::default()
        }
    }

    proptest! {
        /// Wherever on a line from a receiver to the light an occluder stands, its cell is in the kernel, also where
        /// the light reaches beyond the receiver and where the receiver falls far beside the map.
        #[test]
        fn kernels_of_side_faces_hold_what_lies_before_the_light(
            half_size in 0.1f32..50.0,
            receiver in prop::array::uniform3(0.1f32..1.0),
            q in prop::array::uniform2(-1.0f32..1.0),
            way in 0.01f32..0.99,
            room in 0.02f32..0.5,
            focal in 100f32..10_000.0,
            at in prop::array::uniform2(2f32..120.0),
        ) {
            let view = side_face(half_size);
            let receiver = Vec3::from(receiver) * Vec3::new(1.5 * half_size, half_size, 3.0);
            let light = Vec3::new(q[0], q[1], 0.0) * half_size;
            let occluder = receiver.lerp(light, way);
            // Nearer to the map's eye than the receiver, or it could not occlude, and before it.
            prop_assume!(occluder.x > 1e-3 * half_size && occluder.x < 0.99 * receiver.x);
            let tangents = |p: Vec3| Vec2::new(p.y, p.z) / p.x;
            let near = occluder.x * (1.0 - room);
            let fit = Fit {
                near,
                focal: [focal; 2],
                center: (Vec2::from(at) - focal * tangents(occluder)).into(),
                ..Fit::default()
            };
            let projected = project(&view, &fit, true, receiver, -Vec3::Z);
            let cells = kernel_cells(&view, true, &projected, 1.0);
            for axis in 0..2 {
                // The cell, give or take one for the rounding of places on the map.
                let cell = at[axis] as i32;
                prop_assert!(cells.first[axis] <= cell + 1 && cells.last[axis] >= cell - 1,
                    "{at:?} is not in {:?} to {:?}", cells.first, cells.last);
            }
        }
    }
}
