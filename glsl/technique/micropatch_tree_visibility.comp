#version 460
#extension GL_GOOGLE_include_directive : require
// Visibility of the pixel list's pixels from the back-projected texels of their kernels, found by a walk through the
// hierarchy that prunes what holds no occluder [DU07]. It finds the patches that micropatch_visibility.comp finds.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "pixel_list.glsl"
#include "radial.glsl"
#include "micropatch.glsl"
#include "walk.glsl"
#include "quadtree.glsl"
#include "hierarchy.glsl"

// Walks to the next occluding texel and stays there; returns its depth, or 0 when there is none left.
float find_leaf(ivec2 first, ivec2 last, inout Walk walk) {
    float depth = 0.0;
    SEARCH_WHILE(depth == 0.0 && !walk.ended) {
        // Nodes stand where the level has them, not where the kernel begins and ends: some hang over.
        bool inside = all(lessThanEqual(walk.node, last)) && all(greaterThan(walk.node + (1 << walk.level), first));
        ivec2 node = min(walk.node, last);
        float nearest = walk.level > 0 ? hierarchy_fetch(pixel.view, node, walk.level).y : depth_at(0u, node);
        bool open = inside && nearest > pixel.receiver.biased;
        nodes_visited += uint(inside);
        samples_read += uint(inside);
        depth = open && walk.level == 0 ? nearest : 0.0;
        if (open && walk.level > 0) descend(walk);
        else if (depth == 0.0) pass_by(walk, aligned(first, walk.top), last);
    }
    return depth;
}

Progress sum_kernel(Progress from) {
    // The texels at the corners of the kernel's dual cells.
    ivec2 first = pixel.first;
    ivec2 last = pixel.last + 1;
    ivec2 side = last - first + 1;
    int top = min(level_covering(max(side.x, side.y)), int(fits[view_index()].level_count) - 1);
    Walk walk = walk_from(aligned(first, top), top);
    if (!is_first_round()) walk = resumed_walk(from, top);
    REPEAT_WHILE(!walk.ended) {
        float depth = find_leaf(first, last, walk);
        sum[0] += patch_area_at(0u, walk.node, depth);
        if (depth > 0.0) pass_by(walk, aligned(first, top), last);
    }
    return progress_of(walk);
}

float hidden_share() { return share_of(sum[0], pixel.view.area); }
