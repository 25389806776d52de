#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
// Visibility of the pixel list's pixels from the back-projected texels of their kernels, found by a walk through the
// min-max pyramid that prunes what holds no occluder [DU07].
#include "pass.glsl"
#include "depth.glsl"
#include "light.glsl"
#include "contour.glsl"
#include "kernel.glsl"
#include "walk.glsl"
#include "hsm.glsl"
#include "mssm_levels.glsl"
#include "count.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(binding = 0, scalar) readonly buffer FrameBlock { Frame frame; };
layout(binding = 1, scalar) readonly buffer Views { View views[]; };
layout(binding = 2, scalar) buffer Fits { Fit fits[]; };
layout(binding = 3) uniform texture2D position_world;
layout(binding = 4) uniform texture2D normal_world;
layout(binding = 5) uniform texture2D shadow_map;
layout(binding = 6) uniform texture2DArray layers;
layout(binding = 7, scalar) readonly buffer Kernels { Kernel kernels[]; };
layout(binding = 8, scalar) buffer Occlusion { float occlusion[]; };
layout(binding = 9, scalar) readonly buffer Sectors { float sectors[]; };
layout(binding = 10, scalar) buffer CountersBlock { Counters counters; };
layout(binding = 11, scalar) buffer ListsBlock { Lists lists[]; };
layout(binding = 12, scalar) readonly buffer Pixels { uint pixels[]; };
layout(binding = 13, scalar) buffer Partial { float partial[]; };
layout(binding = 14, scalar) buffer ProgressBlock { Progress progress[]; };
layout(binding = 15) uniform texture2DArray hsm;
layout(binding = 16, scalar) buffer Rounds { Round rounds[]; };
#include "radial.glsl"
#include "listed.glsl"
#include "micropatch.glsl"

// Where the pyramid's node of level `top` that holds a texel begins.
ivec2 corner_of(ivec2 texel, int top) { return (texel >> top) << top; }

// Walks to the next occluding texel and stays there; returns its depth, or 0 when there is none left.
float find_leaf(Listed listed, ivec2 first, ivec2 last, inout Walk walk) {
    float depth = 0.0;
    uint turns = 0u;
    while (depth == 0.0 && !walk.ended && !out_of_turns(turns)) {
        ++turns;
        // Nodes stand where the pyramid has them, not where the kernel begins: some hang over.
        bool inside = all(lessThanEqual(walk.node, last))
                   && all(greaterThanEqual(walk.node + (1 << walk.level) - 1, first));
        float nearest = walk.level > 0 ? hsm_fetch(hsm, walk.node, walk.level, listed.view.map_size).y
                                       : texelFetch(shadow_map, walk.node, 0).x;
        bool open = inside && nearest > listed.receiver.biased;
        nodes_visited += uint(inside);
        samples_read += uint(inside);
        depth = open && walk.level == 0 ? nearest : 0.0;
        if (open && walk.level > 0) descend(walk);
        else if (depth == 0.0) pass_by(walk, corner_of(first, walk.top), last);
    }
    steps += subgroupMax(turns) + 1u;
    return depth;
}

void main() {
    Listed listed;
    if (!find_listed(listed)) return;
    // The texels at the corners of the kernel's dual cells.
    ivec2 first = listed.first;
    ivec2 last = listed.last + 1;
    ivec2 side = last - first + 1;
    int top = min(level_covering(max(side.x, side.y)), int(hsm_levels(listed.view.map_size)));
    Walk walk = walk_from(corner_of(first, top), top);
    if (!is_first_round()) walk = walk_on(progress[listed.entry], top);
    float hidden = is_first_round() ? 0.0 : partial[listed.index];
    while (!walk.ended && !out_of_turns(0u)) {
        ++steps;
        float depth = find_leaf(listed, first, last, walk);
        hidden += patch_area_at(listed, 0u, walk.node, depth);
        if (depth > 0.0) pass_by(walk, corner_of(first, top), last);
    }
    if (close_round(listed, !walk.ended, progress_of(walk))) conclude(listed, hidden / listed.view.area);
    else partial[listed.index] = hidden;
    count_work();
}
