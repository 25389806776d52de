#version 460
#extension GL_GOOGLE_include_directive : require
// What a view hides of the pixels that are joined on a grid: what it hides of their neighbours there, between which it is taken to be
// linear along rows and along columns. Sparser grids come first, for such neighbours may be joined themselves. `kernels` says which pixels.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "receiver.glsl"
#include "grid.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(frame);
readonly BUFFER(lists);
readonly BUFFER(tiles);
readonly BUFFER(kernels);

#include "surface.glsl"
#include "part_of_view.glsl"
#include "occlusion.glsl"

// What the view hides of a pixel of a tile, from its neighbours.
float joined(uvec2 tile, uvec2 in_tile, uint grid) {
    vec4 hidden;
    for (uint i = 0u; i < 4u; ++i) hidden[i] = occluded_by_view[first_pixel() + index_of(tile + grid_neighbour(grid, in_tile, i))];
    uvec2 before = grid_before(grid, in_tile);
    vec2 share = vec2(in_tile - before) / vec2(max(grid_after(grid, in_tile) - before, 1u));
    vec2 in_rows = mix(hidden.xz, hidden.yw, share.x);
    return mix(in_rows.x, in_rows.y, share.y);
}

void main() {
    uint grid = push.level;
    uint at = gl_WorkGroupID.y * GROUPS_PER_ROW + gl_WorkGroupID.x;
    if (at >= lists[view_index()].tile_count || tiles[first_tile() + at].status != KERNEL_PENUMBRA) return;
    uvec2 tile = tiles[first_tile() + at].place * TILE_SIZE;
    uvec2 pixel = tile + gl_LocalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    uint index = index_of(pixel);
    Kernel kernel = kernels[first_pixel() + index];
    if (kernel.status == KERNEL_JOINED && kernel.first == grid) add_occluded(index, joined(tile, gl_LocalInvocationID.xy, grid));
}
