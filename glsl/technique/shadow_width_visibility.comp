#version 460
#extension GL_GOOGLE_include_directive : require
// Shadows of a single light sample [Kirsch03]: a hidden pixel is the brighter the nearer its projection is to a texel that
// nothing hides, and the farther its occluder is. Pixels that the light's centre sees are lit: the inner penumbra alone.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "filtered.glsl"
#include "shadow_width.glsl"
#include "bottom_map.glsl"

layout(constant_id = 43) const float SCALE = 1.0;        // of c_scale, see below
layout(constant_id = 44) const float SHADOW_BIAS = 0.0;  // c_bias
layout(constant_id = 64) const bool BACK_FACES = false;  // occluders are as far away as their farthest back faces

readonly BUFFER(shadow_widths);
TEXTURE(bottom_map);

// The width at `t`, bilinear between texels.
float width_at(View view, vec2 t) {
    vec2 held = clamp(t, vec2(0.0), vec2(view.map_size - 1u));
    ivec2 first = min(ivec2(held), ivec2(view.map_size) - 2);
    vec2 share = held - vec2(first);
    uint row = place_of(first, SPREADS, view.map_size);
    uint next = row + view.map_size;
    return mix(mix(shadow_widths[row].x, shadow_widths[row + 1u].x, share.x),
               mix(shadow_widths[next].x, shadow_widths[next + 1u].x, share.x), share.y);
}

// How deep the occluder is that hides a pixel behind the texel nearest to `t`, whose nearest depth is `depth`.
float occluder_depth(vec2 t, float depth) {
    float bottom = BACK_FACES && depth > 0.0 ? farthest_of(texelFetch(bottom_map, ivec2(floor(t + 0.5)), 0).x) : 0.0;
    return bottom > 0.0 ? bottom : depth;
}

// 1 − I(sd, sw) of the paper's section 3.
// DEVIATION [Kirsch03 §3]: c_scale is no constant of the scene. With the occluder's distance from the light over the light's
// half size for it, the inner penumbra is as wide as that of an edge at the occluder's depth, and ends with the light's size.
float hidden_share(View view, Fit fit, uvec2 pixel, Receiver receiver) {
    float depth = nearest_depth(view, receiver.t);
    float difference = max(occluder_depth(receiver.t, depth) - receiver.d, 1e-30);
    float light = clamp(1.0 + SHADOW_BIAS - SCALE * width_at(view, receiver.t) / difference, 0.0, 1.0);
    return depth > receiver.biased ? 1.0 - light : 0.0;
}

uint samples_read_by_pixel() { return BACK_FACES ? 6u : 5u; }
