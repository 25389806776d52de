#version 460
#extension GL_GOOGLE_include_directive : require
// Visibility of the pixel list's pixels from the back-projected texels of their kernels, found by a walk through the
// min-max pyramid that prunes what holds no occluder [DU07]. It finds the patches that micropatch_visibility.comp finds.
#include "pass.glsl"
#include "pixel_list.glsl"
#include "radial.glsl"
#include "micropatch.glsl"
#include "walk.glsl"
#include "quadtree.glsl"
#include "hsm.glsl"

TEXTURE(hsm);

// Where the pyramid's node of level `top` that holds a texel begins.
ivec2 corner_of(ivec2 texel, int top) { return (texel >> top) << top; }

// Walks to the next occluding texel and stays there; returns its depth, or 0 when there is none left.
float find_leaf(ivec2 first, ivec2 last, inout Walk walk) {
    float depth = 0.0;
    SEARCH_WHILE(depth == 0.0 && !walk.ended) {
        // Nodes stand where the pyramid has them, not where the kernel begins: some hang over.
        bool inside = all(lessThanEqual(walk.node, last))
                   && all(greaterThanEqual(walk.node + (1 << walk.level) - 1, first));
        float nearest = walk.level > 0 ? hsm_fetch(hsm, walk.node, walk.level, pixel.view.map_size).y
                                       : depth_at(0u, walk.node);
        bool open = inside && nearest > pixel.receiver.biased;
        nodes_visited += uint(inside);
        samples_read += uint(inside);
        depth = open && walk.level == 0 ? nearest : 0.0;
        if (open && walk.level > 0) descend(walk);
        else if (depth == 0.0) pass_by(walk, corner_of(first, walk.top), last);
    }
    return depth;
}

Progress sum_kernel(Progress from) {
    // The texels at the corners of the kernel's dual cells.
    ivec2 first = pixel.first;
    ivec2 last = pixel.last + 1;
    ivec2 side = last - first + 1;
    int top = min(level_covering(max(side.x, side.y)), int(hsm_levels(pixel.view.map_size)));
    Walk walk = walk_from(corner_of(first, top), top);
    if (!is_first_round()) walk = resumed_walk(from, top);
    REPEAT_WHILE(!walk.ended) {
        float depth = find_leaf(first, last, walk);
        sum[0] += patch_area_at(0u, walk.node, depth);
        if (depth > 0.0) pass_by(walk, corner_of(first, top), last);
    }
    return progress_of(walk);
}

float hidden_share() { return sum[0] / pixel.view.area; }
