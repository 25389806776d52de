//! Coherent packets and single pixels [Yang09 §4.3, eq. 4–6]: twin of `classify.comp`, in f32 and operation by
//! operation, because its results are lists.

use glam::{Vec2, Vec4};

use super::kernels::unpacked;
use super::receiver::Receiver;
use crate::shared::{Costs, Kernel, Packet};

/// T_d of [Yang09 §4.3].
const DIVERGENCE_MAX: f32 = 0.8;
/// Relative distance from its threshold within which a decision may go either way: `log2` and `pow` are
/// the only operations that Vulkan does not define to the ulp, and a sum of them may differ in a few.
const UNDECIDED: f32 = 1e-5;

/// What becomes of a packet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Decision {
    /// Its pixels share a traversal.
    Coherent,
    /// Each of its penumbra pixels goes to the list of pixels.
    Incoherent,
    /// The cost model's values are too close to tell.
    Either,
}

/// A packet with its penumbra pixels and what the cost model makes of it.
#[derive(Debug, Clone, Copy)]
pub struct Classified {
    pub packet: Packet,
    pub decision: Decision,
}

struct Survey {
    first: [i32; 2],
    last: [i32; 2],
    count: u32,
    kernel_depths: [f32; 2],
    pixel_cost: f32,
    behind: bool,
}

/// Surveys a packet's penumbra pixels, in the order of the packet's rows. None: it has none.
///
/// `index`: its position in the grid of packets.
pub fn classify(index: u32, pixels: &[(Kernel, Receiver)], costs: &Costs) -> Option<Classified> {
    let mut packet = Packet {
        index,
        depth_min: 1e30,
        depth_far: 1e30,
        ..Packet::default()
    };
    let mut survey = Survey {
        first: [i32::MAX; 2],
        last: [-1; 2],
        count: 0,
        kernel_depths: [1e30, 0.0],
        pixel_cost: 0.0,
        behind: pixels.iter().any(|(_, receiver)| receiver.behind),
    };
    let (mut lower, mut upper) = (Vec2::splat(1e30), Vec2::splat(-1e30));
    let (mut planes, mut plane_depths) = ((lower, upper), (1e30f32, -1e30f32));
    let origin = pixels.first()?.1.t;
    for (kernel, receiver) in pixels {
        packet.depth_min = packet.depth_min.min(receiver.biased);
        packet.depth_max = packet.depth_max.max(receiver.biased);
        packet.depth_far = packet.depth_far.min(receiver.d);
        let way = origin - receiver.t;
        let at_origin = receiver.biased + (receiver.plane.x * way.x + receiver.plane.y * way.y);
        plane_depths = (plane_depths.0.min(at_origin), plane_depths.1.max(at_origin));
        planes = (planes.0.min(receiver.plane), planes.1.max(receiver.plane));
        lower = lower.min(receiver.t);
        upper = upper.max(receiver.t);
        survey.include(kernel, costs);
    }
    let cell = |[x, y]: [i32; 2]| x as u32 | (y as u32) << 16;
    packet.first = cell(survey.first);
    packet.last = cell(survey.last);
    packet.centers = Vec4::new(lower.x, lower.y, upper.x, upper.y).into();
    packet.origin = origin.into();
    packet.plane_depths = plane_depths.into();
    packet.planes = [planes.0.x, planes.0.y, planes.1.x, planes.1.y];
    let decision = survey.decide(&packet, costs);
    Some(Classified { packet, decision })
}

fn node_cost(width: f32) -> f32 {
    width.max(2.0).log2() * width
}

fn width_of(first: [i32; 2], last: [i32; 2]) -> f32 {
    (last[0] - first[0]).max(last[1] - first[1]) as f32 + 1.0
}

impl Survey {
    fn include(&mut self, kernel: &Kernel, costs: &Costs) {
        let (first, last) = (unpacked(kernel.first), unpacked(kernel.last));
        self.first = [0, 1].map(|axis| self.first[axis].min(first[axis]));
        self.last = [0, 1].map(|axis| self.last[axis].max(last[axis]));
        self.kernel_depths[0] = self.kernel_depths[0].min(kernel.depth_min);
        self.kernel_depths[1] = self.kernel_depths[1].max(kernel.depth_max);
        let width = width_of(first, last);
        self.pixel_cost += node_cost(width) + (costs.edge + costs.visibility) * width;
        self.count += 1;
    }

    fn decide(&self, packet: &Packet, costs: &Costs) -> Decision {
        if self.behind {
            return Decision::Incoherent;
        }
        let width = width_of(self.first, self.last);
        let [near_end, far_end] = [self.kernel_depths[1], self.kernel_depths[0]];
        let overlap = packet.depth_max.min(near_end) - packet.depth_min.max(far_end);
        // Eq. 4 and 5.
        let origin = Vec2::from(packet.origin);
        let cell = |[x, y]: [i32; 2]| (Vec2::new(x as f32, y as f32) - origin).abs();
        let reach = cell(self.first).max(cell(self.last));
        let [least_x, least_y, most_x, most_y] = packet.planes;
        let tilts = (Vec2::new(most_x, most_y) - Vec2::new(least_x, least_y)) * reach;
        let apart = (packet.plane_depths[1] - packet.plane_depths[0]) + (tilts.x + tilts.y);
        let null = (overlap.max(apart) / (near_end - far_end).max(1e-30)).clamp(0.0, 1.0);
        let divergence = 1.0 - (1.0 - null).powf(width * width);
        // Eq. 6.
        let shared = node_cost(width) + (costs.edge + costs.visibility * self.count as f32) * width;
        let diverges = exceeds(divergence, DIVERGENCE_MAX);
        // A single pixel costs the same either way, to the bit: both sides are one expression.
        let costs_more = if self.count == 1 {
            Some(false)
        } else {
            exceeds(shared, self.pixel_cost)
        };
        match (diverges, costs_more) {
            (Some(true), _) | (_, Some(true)) => Decision::Incoherent,
            (Some(false), Some(false)) => Decision::Coherent,
            _ => Decision::Either,
        }
    }
}

/// Whether a value exceeds its threshold; None where they are too close to tell.
fn exceeds(value: f32, threshold: f32) -> Option<bool> {
    let close = (value - threshold).abs() <= UNDECIDED * threshold;
    (!close).then_some(value > threshold)
}
