//! What techniques with kernels share: a kernel for each pixel, and the lists of what is left to integrate, which are worked
//! off in rounds where a driver bounds loops.

use super::pass::{Domain, Pass, Work};
use super::resource::{Resource, Shape, Sizes};
use crate::shared::{Kernel, Lists, Packet, Progress, Round, TILE_SIZE, WINDOW_PIXELS_MIN, Window};

/// Most windows of a tile.
const WINDOWS_PER_TILE: u64 = (TILE_SIZE * TILE_SIZE / WINDOW_PIXELS_MIN) as u64;

const CLEAR_LISTS: Pass = Pass::new("clear_lists", Work::Clear(&["lists", "rounds"]));

/// The kernels of all pixels [GBP06, SS07; Yang09 eq. 1].
pub const KERNELS: Pass = Pass::dispatch("kernels", "kernels.comp", Domain::Pixels);

/// Packets and pixels to their lists [Yang09 §4.3].
pub const CLASSIFY: Pass = Pass::dispatch("classify", "classify.comp", Domain::Packets);

/// Once a frame, before the first view.
pub fn first_passes(has_lists: bool) -> impl Iterator<Item = Pass> {
    has_lists.then_some(CLEAR_LISTS).into_iter()
}

pub const RESOURCES: &[Resource] = &[
    Resource::new("kernels", |s| {
        Shape::array::<Kernel>(s.pixels()).when(s.kernels)
    }),
    Resource::new("windows", |s| {
        Shape::array::<Window>(s.tiles() * WINDOWS_PER_TILE).when(s.windows)
    }),
    Resource::new("packets", |s| {
        Shape::array::<Packet>(s.packets()).when(s.packet_lists)
    }),
    Resource::new("pixels", |s| {
        Shape::array::<u32>(s.pixels()).when(s.pixel_lists)
    }),
];

/// Their lengths, and where their entries go on in the next round.
pub const LIST_RESOURCES: &[Resource] = &[
    Resource::new("lists", |s| Shape::array::<Lists>(s.lists())),
    Resource::new("rounds", |s| {
        Shape::array::<Round>(s.lists() * u64::from(s.rounds))
    }),
    Resource::new("partial", |s| {
        Shape::array::<u32>(s.pixels() * u64::from(s.words)).when(s.rounds > 1)
    }),
    Resource::new("progress", |s| {
        Shape::array::<Progress>(entries(s)).when(s.rounds > 1 && s.words > 0)
    }),
];

/// One for each pixel, or for each lane of each packet.
fn entries(sizes: &Sizes) -> u64 {
    let lanes = u64::from(sizes.packet.0 * sizes.packet.1);
    (sizes.packets() * lanes).max(sizes.pixels())
}
