#version 460
#extension GL_GOOGLE_include_directive : require
// Hard shadows: the nearest sample decides, or the mean of the tests of its neighbourhood [Williams78; percentage
// closer filtering by Reeves, Salesin and Cook 1987].
#include "pass.glsl"
#include "depth.glsl"
#include "count.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

layout(binding = 0, scalar) readonly buffer FrameBlock { Frame frame; };
layout(binding = 1, scalar) readonly buffer Views { View views[]; };
layout(binding = 2, scalar) readonly buffer Fits { Fit fits[]; };
layout(binding = 3) uniform texture2D position_world;
layout(binding = 4) uniform texture2D normal_world;
layout(binding = 5) uniform texture2D shadow_map;
layout(binding = 6, scalar) buffer Occlusion { float occlusion[]; };
layout(binding = 7, scalar) buffer CountersBlock { Counters counters; };
#include "filtered.glsl"

float occluded_of(View view, Fit fit, uvec2 pixel, Receiver receiver) {
    float hidden = 0.0;
    for (int y = -FILTER_REACH; y <= FILTER_REACH; ++y)
        for (int x = -FILTER_REACH; x <= FILTER_REACH; ++x)
            hidden += float(nearest_depth(view, receiver.t + vec2(x, y)) > receiver.biased);
    float side = float(2 * FILTER_REACH + 1);
    return hidden / (side * side);
}

void main() { filter_pixel(uint((2 * FILTER_REACH + 1) * (2 * FILTER_REACH + 1))); }
