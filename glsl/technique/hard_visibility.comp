#version 460
#extension GL_GOOGLE_include_directive : require
// Hard shadows: the nearest sample decides [Williams78], or the mean of the tests of its neighbourhood (percentage-closer
// filtering by Reeves, Salesin and Cook 1987). Right for a light without extent.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "filtered.glsl"

layout(constant_id = 21) const int FILTER_REACH = 0;  // [texel] of the percentage-closer filter

float hidden_share(View view, Fit fit, uvec2 pixel, Receiver receiver) {
    float hidden = 0.0;
    for (int y = -FILTER_REACH; y <= FILTER_REACH; ++y)
        for (int x = -FILTER_REACH; x <= FILTER_REACH; ++x)
            hidden += float(nearest_depth(view, receiver.t + vec2(x, y)) > receiver.biased);
    float side = float(2 * FILTER_REACH + 1);
    return hidden / (side * side);
}

uint samples_read_by_pixel() { return uint((2 * FILTER_REACH + 1) * (2 * FILTER_REACH + 1)); }
