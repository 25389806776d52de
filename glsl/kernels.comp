#version 460
#extension GL_GOOGLE_include_directive : require
// A kernel for each pixel of the tiles that a view has to look at, shrunk by repeated queries of the hierarchy, and the pixels that
// need no integration [SS07; Yang09 alg. 1, step 5]: lit where no sample of the kernel occludes, umbra where all do. A kernel holds
// every cell that adds to the pixel's integral. Where not all pixels are evaluated, some of those that are left are joined from others
// (join.comp).
#include "pass.glsl"
#include "side_by_side.glsl"
#include "receiver.glsl"
#include "quadtree.glsl"
#include "hierarchy.glsl"
#include "kernel.glsl"
#include "shrink.glsl"
#include "coarse_map.glsl"
#include "quality.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(frame);
readonly BUFFER(views);
readonly BUFFER(fits);
readonly BUFFER(tiles);
writeonly BUFFER(kernels);
writeonly BUFFER(quality);
readonly BUFFER(grids);
BUFFER(counters);
#include "shadow_map.glsl"
#include "surface.glsl"
#include "part_of_view.glsl"
#include "occlusion.glsl"
#include "grid.glsl"
#include "window.glsl"
#include "rounds.glsl"

writeonly BUFFER(windows);
BUFFER(lists);

shared uint penumbra[2];
shared Kernel kernels_of_tile[EVALUATE > 0u ? TILE_SIZE * TILE_SIZE : 1u];

// [cell] Kernels no wider and no higher are looked at sample by sample. A tilted surface without occluders has such a
// kernel of its own, for bounds do not tell it from an occluder: uphill it comes nearer to the light.
const int SAMPLED_SIDE = 2;

// Kernels are alike whose borders are apart by no more than one in so many of their cells.
const int ALIKE = 2;

// Whether a kernel is so small, and no sample in it occludes.
bool nothing_occludes(Receiver receiver, Cells cells) {
    if (any(greaterThan(cells.last - cells.first, ivec2(SAMPLED_SIDE - 1)))) return false;
    uint occluding = 0u;
    for (int y = cells.first.y; y <= cells.last.y + 1; ++y)
        for (int x = cells.first.x; x <= cells.last.x + 1; ++x)
            occluding += uint(occludes(receiver, vec2(x, y), sample_of(view_index(), ivec2(x, y))));
    return occluding == 0u;
}

// What a query asks for: the kernel, and all that its budget's coarse texels stand for [Schwarz08 §6].
Cells queried(View view, Cells cells, float budget) {
    if (BUDGET == 0u || !QUERY_GROWTH) return cells;
    return grown_cells(view, cells, coarse_level(cells, budget));
}

// depth_max: no occluder of the pixel is nearer to the light.
Kernel kernel_of(View view, Fit fit, Receiver receiver, float budget, float depth_max) {
    Kernel kernel = Kernel(KERNEL_LIT, 0u, 0u, 0.0, 0.0);
    Cells cells;
    vec2 range = vec2(0.0);
    int finer = 0;
    for (int round = 1; round <= ROUNDS_MAX; ++round) {
        if (depth_max <= receiver.biased) return kernel;
        cells = kernel_cells(view, receiver, depth_max);
        if (any(greaterThan(cells.first, cells.last))) return kernel;
        Cells asked = queried(view, cells, budget);
        range = hierarchy_query(view, asked.first, asked.last, int(fit.level_count), finer);
        if (!shrinks(range.y, round, depth_max, finer)) break;
    }
    if (depth_max <= receiver.biased) return kernel;
    bool is_coarse = BUDGET > 0u && coarse_level(cells, budget) > 0;
    if (CONTOURS && LAYERS == 1u && !is_coarse && nothing_occludes(receiver, cells)) return kernel;
    bool umbra = cells.whole && !receiver.behind && range.x > highest_limit(receiver, cells.first, cells.last + 1);
    kernel.status = umbra ? KERNEL_UMBRA : KERNEL_PENUMBRA;
    kernel.first = packed(cells.first);
    kernel.last = packed(cells.last);
    kernel.depth_min = range.x;
    kernel.depth_max = range.y;
    return kernel;
}

// Writes the level of quality of a kernel that is integrated.
void choose_quality(uint index, Kernel kernel, float budget) {
    Cells cells = Cells(unpacked(kernel.first), unpacked(kernel.last), true);
    quality[index] = quality_of(cells, budget);
    if (COUNT) atomicAdd(counters.coarse_levels, uint(coarse_level(cells, budget)));
}

void count(uint status) {
    if (status == KERNEL_NONE) return;
    atomicAdd(counters.pixels, 1u);
    if (status == KERNEL_LIT) atomicAdd(counters.lit, 1u);
    if (status == KERNEL_UMBRA) atomicAdd(counters.umbra, 1u);
    if (status == KERNEL_PENUMBRA) atomicAdd(counters.penumbra, 1u);
}

// The kernel of a pixel of a tile.
Kernel kernel_at(View view, Tile tile, uvec2 pixel) {
    SurfacePoint point = surface_at(pixel);
    vec3 to_point = point.position - view.center;
    Kernel kernel = Kernel(KERNEL_NONE, 0u, 0u, 0.0, 0.0);
    if (!point.exists || !in_view(view, point.position, point.normal)) return kernel;
    kernel.status = tile.status;
    if (tile.status != KERNEL_PENUMBRA) return kernel;
    Fit fit = fits[view_index()];
    float budget = budget_of(index_of(pixel));
    kernel = kernel_of(view, fit, project(view, fit, to_point, point.normal, point.error), budget, tile.depth_max);
    if (BUDGET > 0u && kernel.status == KERNEL_PENUMBRA) choose_quality(index_of(pixel), kernel, budget);
    return kernel;
}

// Lists pixels of a window, for a subgroup to work off.
void append_window(Window window) {
    uint at = atomicAdd(lists[view_index()].packet_count, 1u);
    windows[first_window() + at] = window;
    if (at % gl_NumSubgroups == 0u) reach_packets(0u, at / gl_NumSubgroups);
}

// Lists those of these pixels that are to be integrated, as many to an entry as a subgroup has lanes.
void list_window(uvec2 place_of_tile, bool is_penumbra) {
    if (gl_LocalInvocationIndex < 2u) penumbra[gl_LocalInvocationIndex] = 0u;
    barrier();
    uint place = place_in_window(gl_LocalInvocationID.xy);
    uint bit = is_penumbra ? 1u << (place & 31u) : 0u;
    uvec2 bits = subgroupOr(place < 32u ? uvec2(bit, 0u) : uvec2(0u, bit));
    if (subgroupElect()) atomicOr(penumbra[0], bits.x);
    if (subgroupElect()) atomicOr(penumbra[1], bits.y);
    barrier();
    if (gl_LocalInvocationIndex > 0u) return;
    uvec2 left = uvec2(penumbra[0], penumbra[1]);
    while ((left.x | left.y) != 0u) {
        uvec2 some = first_bits(left, max(gl_SubgroupSize, WINDOW_PIXELS_MIN));
        append_window(Window(place_of_tile, some));
        left &= ~some;
    }
}

// Whether a pixel's kernel holds much the same as a neighbour's, so that little else hides the light from the one than from the other.
bool is_alike(Kernel kernel, Kernel other) {
    ivec2 first = unpacked(kernel.first);
    ivec2 last = unpacked(kernel.last);
    ivec2 moved = max(abs(unpacked(other.first) - first), abs(unpacked(other.last) - last));
    return all(lessThanEqual(ALIKE * moved, last - first + 1));
}

// Whether all neighbours of this invocation's pixel on a grid are penumbra, over kernels like its own.
bool is_amid_penumbra(Kernel kernel, uint grid) {
    bool amid = true;
    for (uint i = 0u; i < 4u; ++i) {
        uvec2 place = grid_neighbour(grid, gl_LocalInvocationID.xy, i);
        Kernel other = kernels_of_tile[place.y * TILE_SIZE + place.x];
        amid = amid && other.status == KERNEL_PENUMBRA && is_alike(kernel, other);
    }
    return amid;
}

// Leaves a pixel that would be integrated to its neighbours, on the sparsest of some grids on which they allow it. What is lit or
// umbra stays so, and nothing is joined across it.
void leave_to_neighbours(inout Kernel kernel, uint grids_of_pixel) {
    kernels_of_tile[gl_LocalInvocationIndex] = kernel;
    barrier();
    if (kernel.status != KERNEL_PENUMBRA) return;
    for (uint grid = EVALUATE; grid > 0u && kernel.status == KERNEL_PENUMBRA; --grid) {
        bool known = (grids_of_pixel >> grid & 1u) != 0u;
        if (known && is_amid_penumbra(kernel, grid)) kernel = Kernel(KERNEL_JOINED, grid, 0u, 0.0, 0.0);
    }
}

void main() {
    uint at = gl_WorkGroupID.y * GROUPS_PER_ROW + gl_WorkGroupID.x;
    if (at >= lists[view_index()].tile_count) return;
    Tile tile = tiles[first_tile() + at];
    uvec2 pixel = tile.place * TILE_SIZE + gl_LocalInvocationID.xy;
    View view = views[view_index()];
    Kernel kernel = Kernel(KERNEL_NONE, 0u, 0u, 0.0, 0.0);
    bool exists = all(lessThan(pixel, frame.size));
    if (exists) kernel = kernel_at(view, tile, pixel);
    if (EVALUATE > 0u && tile.status == KERNEL_PENUMBRA) leave_to_neighbours(kernel, exists ? grids[index_of(pixel)] : 0u);
    if (exists) {
        uint index = index_of(pixel);
        kernels[first_pixel() + index] = kernel;
        if (kernel.status == KERNEL_UMBRA) add_occluded(index, view.weight);
        if (COUNT) count(kernel.status);
    }
    if (WINDOWS) list_window(tile.place, kernel.status == KERNEL_PENUMBRA);
}
