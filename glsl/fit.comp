#version 460
#extension GL_GOOGLE_include_directive : require
// Fits a view's projection to the bounds of its casters and writes the work that is left for its passes: levels, groups,
// draws (algorithm.md §10). No contour touches the map's border. One invocation.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "bounds.glsl"
#include "quadtree.glsl"
#include "hierarchy_layout.glsl"

layout(local_size_x = 1) in;
layout(constant_id = 23) const bool GIVEN_MAPS = false;  // a host has the shadow maps already

readonly BUFFER(frame);
readonly BUFFER(views);
BUFFER(fits);
readonly BUFFER(givens);
BUFFER(hierarchy_groups);

#include "caster_list.glsl"

// Extent of one axis at most this many times the other's: kernels stay near to square.
const float ASPECT_MAX = 8.0;
// [texel] Frame that no caster touches, so that contours close inside the map: a column of empty
// samples and half a texel for the rounding of edges, on each side.
const float MARGIN = 1.5;

// [texel] Sides of the largest kernel that a receiver of this view can have.
vec2 largest_kernel(View view, Fit fit) {
    float depth_min = fit.near / value_of(fit.receiver_bounds[2], 1.0);
    vec2 kappa = fit.near / (fit.focal * view.half_size);
    return (view.extent.zw - view.extent.xy) * (max(1.0 - depth_min, 0.0) / kappa);
}

// A level that a view needs is built for all that are side by side; those that do not need it leave it out.
void reach_level(uint level, uint groups) {
    atomicMax(hierarchy_groups[push.index].of_level[level].x, groups);
    atomicMax(hierarchy_groups[push.index].of_level[level].y, groups);
    atomicMax(hierarchy_groups[push.index].of_level[level].z, gl_NumWorkGroups.z);
}

void main() {
    Fit fit = fits[view_index()];
    View view = views[view_index()];
    uvec2 tiles = (frame.size + TILE_SIZE - 1u) / TILE_SIZE;
    bool empty = GIVEN_MAPS ? fit.receiver_count == 0u : fit.caster_bounds[4] == 0u;
    if (GIVEN_MAPS) {
        fit.near = givens[view_index()].near;
        fit.focal = givens[view_index()].focal;
        fit.center = givens[view_index()].center;
    } else if (!empty) {
        vec2 upper = vec2(value_of(fit.caster_bounds[0], 0.0), value_of(fit.caster_bounds[1], 0.0));
        vec2 lower = -vec2(value_of(fit.caster_bounds[2], 0.0), value_of(fit.caster_bounds[3], 0.0));
        vec2 extent = max(upper - lower, vec2(1e-5));
        extent = max(extent, extent.yx / ASPECT_MAX);
        vec2 middle = 0.5 * (lower + upper);
        float inner = float(view.map_size) - 1.0 - 2.0 * MARGIN;
        fit.near = -value_of(fit.caster_bounds[4], 0.0) * 0.999;
        fit.focal = inner / extent;
        fit.center = 0.5 * (float(view.map_size) - 1.0) - fit.focal * middle;
    }
    if (!empty) {
        float side = float(view.map_size);
        if (view.face == 0u && !GIVEN_MAPS) {
            vec2 largest = min(largest_kernel(view, fit), vec2(side));
            side = max(largest.x, largest.y) + 2.0;
        }
        int levels = max(level_covering(int(min(side, float(view.map_size)))) + 1 - int(ROOT_LEVELS), 1);
        fit.level_count = min(uint(levels), view.levels_max);
    }
    for (uint level = 0u; level < LEVELS_MAX; ++level) {
        uint nodes = uint(covered_side(view) >> spacing_log2(int(level)));
        if (level < fit.level_count) reach_level(level, (nodes + TILE_SIZE - 1u) / TILE_SIZE);
    }
    // A view that nothing is accumulated into writes every pixel, casters or not.
    fit.image_groups = empty && ACCUMULATE ? uvec3(0u) : uvec3(tiles, 1u);
    uvec2 packets = (frame.size + uvec2(PACKET_WIDTH, PACKET_HEIGHT) - 1u) / uvec2(PACKET_WIDTH, PACKET_HEIGHT);
    fit.classify_groups = empty ? uvec3(0u) : uvec3((packets + TILE_SIZE - 1u) / TILE_SIZE, 1u);
    fit.opaque_draw[1] = 1u;
    fit.opaque_draw[2] = first_opaque_index(view_index());
    fit.masked_draw[1] = 1u;
    fit.masked_draw[2] = first_masked_index(view_index());
    fits[view_index()] = fit;
}
