//! What techniques with kernels share: a kernel for each pixel, and the lists of what is left to integrate, which are worked
//! off in rounds where a driver bounds loops.

use super::pass::{Domain, Pass, Work};
use super::resource::{Resource, Shape, Sizes};
use crate::shared::{
    Kernel, Lists, Packet, Progress, QUALITY_COARSER, QUALITY_FINER, Round, TILE_SIZE, Tile,
    TileBounds, WINDOW_PIXELS_MIN, Window,
};

/// Most windows of a tile.
const WINDOWS_PER_TILE: u64 = (TILE_SIZE * TILE_SIZE / WINDOW_PIXELS_MIN) as u64;

const CLEAR_LISTS: Pass = Pass::new(
    "clear_lists",
    Work::Clear(&["lists", "rounds", "occluded_by_view"]),
);

/// Bounds of what is visible in each tile.
const TILE_BOUNDS: Pass = Pass::dispatch("tile_bounds", "tile_bounds.comp", Domain::Image);

/// The tiles that a view has to look at.
pub const TILES: Pass = Pass::dispatch("tiles", "tiles.comp", Domain::Tiles);

/// The kernels of their pixels [GBP06, SS07; Yang09 eq. 1].
pub const KERNELS: Pass = Pass::dispatch("kernels", "kernels.comp", Domain::ListedTiles);

/// Each pixel's budget, where these differ [Schwarz08 §4.2].
const BUDGETS: Pass = Pass::dispatch("budgets", "budgets.comp", Domain::Image);

/// Levels of quality smoothed along rows, then along columns [Schwarz08 §4.2].
pub const SMOOTH_QUALITY: [Pass; 2] = [
    SMOOTH_ALONG.with(&[("COLUMNS", 0)]),
    SMOOTH_ALONG.with(&[("COLUMNS", 1)]),
];
const SMOOTH_ALONG: Pass = Pass::dispatch("smooth_quality", "smooth_quality.comp", Domain::Pixels);

/// A pass that integrates visibility, in the finer and in the coarser of the levels between which it is blended.
pub const fn blended(pass: Pass) -> [Pass; 2] {
    [
        pass.with(&[("QUALITY", QUALITY_FINER)]),
        pass.with(&[("QUALITY", QUALITY_COARSER)]),
    ]
}

/// Packets and pixels to their lists [Yang09 §4.3].
pub const CLASSIFY: Pass = Pass::dispatch("classify", "classify.comp", Domain::Packets);

/// The grids on which pixels have neighbours of the same surface.
const GRIDS: Pass = Pass::dispatch("grids", "grids.comp", Domain::Image);

/// What the view hides of pixels that are not integrated, from their neighbours.
pub const JOIN: Pass = Pass::dispatch("join", "join.comp", Domain::ListedTiles);

/// Once a frame, before the first view.
pub fn first_passes(
    has_lists: bool,
    budgets_vary: bool,
    joins: bool,
) -> impl Iterator<Item = Pass> {
    let first: &[Pass] = match has_lists {
        true => &[CLEAR_LISTS, TILE_BOUNDS],
        false => &[],
    };
    let budgets = budgets_vary.then_some(BUDGETS);
    let grids = joins.then_some(GRIDS);
    first.iter().copied().chain(budgets).chain(grids)
}

/// What views side by side have found.
pub const ADD_UP: Pass = Pass::dispatch("add_up", "add_up.comp", Domain::Image);

pub const RESOURCES: &[Resource] = &[
    Resource::new("tile_bounds", |s| {
        Shape::array::<TileBounds>(s.tiles()).when(s.kernels)
    }),
    Resource::new("tiles", |s| {
        Shape::array::<Tile>(s.tiles())
            .times(s.looked_at_once)
            .when(s.kernels)
    }),
    Resource::new("kernels", |s| {
        Shape::array::<Kernel>(s.pixels())
            .times(s.looked_at_once)
            .when(s.kernels)
    }),
    Resource::new("windows", |s| {
        Shape::array::<Window>(s.tiles() * WINDOWS_PER_TILE)
            .times(s.looked_at_once)
            .when(s.windows)
    }),
    Resource::new("grids", |s| Shape::array::<u32>(s.pixels()).when(s.joins)),
    Resource::new("packets", |s| {
        Shape::array::<Packet>(s.packets()).when(s.packet_lists)
    }),
    Resource::new("pixels", |s| {
        // A packet may leave a pixel to the list for each of the two levels that it is blended from.
        let each = if s.packet_lists && s.coarse_levels > 0 {
            2
        } else {
            1
        };
        Shape::array::<u32>(s.pixels() * each)
            .times(s.looked_at_once)
            .when(s.pixel_lists)
    }),
    Resource::new("budgets", |s| {
        Shape::array::<f32>(s.pixels()).when(s.budgets_vary)
    }),
    Resource::copied("budget_shares", |s| {
        Shape::array::<f32>(s.pixels()).when(s.budget_mapped)
    }),
    Resource::new("quality", |s| {
        Shape::array::<f32>(s.pixels()).when(s.coarse_levels > 0)
    }),
    Resource::new("quality_rows", |s| {
        Shape::array::<f32>(s.pixels()).when(s.coarse_levels > 0)
    }),
];

/// Their lengths, and where their entries go on in the next round.
pub const LIST_RESOURCES: &[Resource] = &[
    Resource::new("lists", |s| Shape::array::<Lists>(s.lists())),
    Resource::new("rounds", |s| {
        Shape::array::<Round>(s.lists() * u64::from(s.rounds))
    }),
    Resource::new("partial", |s| {
        Shape::array::<u32>(s.pixels() * u64::from(s.words))
            .times(s.looked_at_once)
            .when(s.rounds > 1)
    }),
    Resource::new("progress", |s| {
        Shape::array::<Progress>(entries(s))
            .times(s.looked_at_once)
            .when(s.rounds > 1 && s.words > 0)
    }),
    Resource::new("occluded_by_view", |s| {
        Shape::array::<f32>(s.pixels())
            .times(s.looked_at_once)
            .when(s.looked_at_once > 1 || s.joins)
    }),
];

/// One for each pixel, or for each lane of each packet.
fn entries(sizes: &Sizes) -> u64 {
    let lanes = u64::from(sizes.packet.0 * sizes.packet.1);
    (sizes.packets() * lanes).max(sizes.pixels())
}
