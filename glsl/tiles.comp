#version 460
#extension GL_GOOGLE_include_directive : require
// The tiles of the image that a view has to look at, from their bounds: what is so in all of a tile is decided here, pixels are
// looked at where they may differ. Never decided wrongly, whatever rounding does. One invocation for each tile.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "receiver.glsl"
#include "quadtree.glsl"
#include "hierarchy.glsl"
#include "kernel.glsl"
#include "shrink.glsl"
#include "coarse_map.glsl"
#include "quality.glsl"
#include "interval.glsl"
#include "tile_sight.glsl"
#include "tile_view.glsl"
#include "rounds.glsl"

layout(local_size_x = GROUP_SIZE) in;

readonly BUFFER(frame);
#include "part_of_view.glsl"
readonly BUFFER(views);
readonly BUFFER(fits);
readonly BUFFER(tile_bounds);
writeonly BUFFER(tiles);
BUFFER(lists);

// What nothing has to be done for is not listed: kernels are read where they are listed.
const bool LEAVES_OUT = WINDOWS && !COUNT && BUDGET == 0u;

// [node] A query takes no more along a side. What is so much wider than the view's kernels is the border of something near before
// something far, and undecided.
const int NODES_ALONG = 8;

bool is_too_wide(Cells cells, int level_count) {
    ivec2 side = cells.last - cells.first + 1;
    return max(side.x, side.y) > NODES_ALONG << query_level(side, level_count, 0);
}

// What all of the tile's pixels in the view are; KERNEL_PENUMBRA: they may differ. depth_max: no occluder is nearer to the light.
uint status_of(View view, Fit fit, TileBounds bounds, out float depth_max) {
    // The projection's near plane is the nearest caster: depth 1.
    depth_max = 1.0;
    if (bounds.lower.x > bounds.upper.x || misses_view(view, bounds)) return KERNEL_NONE;
    // Within a budget, queries hold more than kernels do.
    if (OBLIQUE || BUDGET > 0u) return KERNEL_PENUMBRA;
    TileSight sight = sight_of(view, fit, bounds);
    if (!sight.bounded) return KERNEL_PENUMBRA;
    Cells cells;
    vec2 range = vec2(0.0);
    int finer = 0;
    for (int round = 1; round <= ROUNDS_MAX; ++round) {
        if (depth_max <= sight.depths.x) return KERNEL_LIT;
        cells = tile_cells(view, sight, depth_max);
        if (any(greaterThan(cells.first, cells.last))) return KERNEL_LIT;
        if (is_too_wide(cells, int(fit.level_count))) return KERNEL_PENUMBRA;
        range = hierarchy_query(view, cells.first, cells.last, int(fit.level_count), finer);
        if (!shrinks(range.y, round, depth_max, finer)) break;
    }
    if (depth_max <= sight.depths.x) return KERNEL_LIT;
    bool umbra = cells.whole && sight.before && range.x > highest_limit(sight, cells.first, cells.last + 1);
    return umbra ? KERNEL_UMBRA : KERNEL_PENUMBRA;
}

void main() {
    uint columns = (frame.size.x + TILE_SIZE - 1u) / TILE_SIZE;
    uint rows = (frame.size.y + TILE_SIZE - 1u) / TILE_SIZE;
    uint index = gl_WorkGroupID.y * GROUPS_PER_ROW * GROUP_SIZE + gl_GlobalInvocationID.x;
    Fit fit = fits[view_index()];
    if (index >= columns * rows || fit.level_count == 0u) return;
    float depth_max;
    uint status = status_of(views[view_index()], fit, tile_bounds[index], depth_max);
    if (LEAVES_OUT && status != KERNEL_PENUMBRA && status != KERNEL_UMBRA) return;
    uint at = atomicAdd(lists[view_index()].tile_count, 1u);
    tiles[first_tile() + at] = Tile(uvec2(index % columns, index / columns), status, depth_max);
    REACH(lists[push.index].tile_groups, at);
}
