#version 460
#extension GL_GOOGLE_include_directive : require
// Percentage-closer soft shadows [Fernando05]: the mean depth of the blockers found around the pixel's projection
// tells how wide to filter.
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

const float TAU = 6.28318530718;

// [0, 1)² Point i of a sequence that fills the square evenly (Roberts' R2), shifted by `shift` round its borders.
vec2 sequence(uint i, vec2 shift) { return fract(vec2(0.7548776662, 0.5698402910) * float(i) + shift); }

// [half sizes] A point of the sub-light; equal areas for equal areas of the square.
vec2 point_of(View view, vec2 at) {
    if (!ROUND) return mix(view.extent.xy, view.extent.zw, at);
    float angle = TAU * at.y;
    return view.rim.xy + view.rim.z * sqrt(at.x) * vec2(cos(angle), sin(angle));
}

// [0, 1)² Differs from pixel to pixel, so that too few samples show as noise rather than as bands (interleaved
// gradient noise, after Jimenez 2014).
vec2 shift_of(uvec2 pixel) {
    vec2 at = vec2(pixel);
    return fract(52.9829189 * fract(vec2(dot(at, vec2(0.06711056, 0.00583715)), dot(at.yx, vec2(0.06711056, 0.00583715)))));
}

// [texel] Where an occluder at `depth` hides the light's point `q`.
vec2 place_of(Receiver receiver, vec2 q, float depth) { return receiver.t + texel_offset(receiver, q, depth).xy; }

float occluded_of(View view, Fit fit, uvec2 pixel, Receiver receiver) {
    vec2 shift = shift_of(pixel);
    float distances = 0.0;
    float blockers = 0.0;
    for (uint i = 0u; i < BLOCKER_SAMPLES; ++i) {
        // The search covers what occluders at the near plane, depth 1, could hide.
        float depth = nearest_depth(view, place_of(receiver, point_of(view, sequence(i, shift)), 1.0));
        if (!(depth > receiver.biased)) continue;
        distances += 1.0 / depth;
        blockers += 1.0;
    }
    if (blockers == 0.0) return 0.0;
    float blocker = blockers / distances;
    float hidden = 0.0;
    for (uint i = 0u; i < FILTER_SAMPLES; ++i) {
        vec2 place = place_of(receiver, point_of(view, sequence(i, shift)), blocker);
        hidden += float(nearest_depth(view, place) > receiver.biased);
    }
    return hidden / float(FILTER_SAMPLES);
}

void main() { filter_pixel(BLOCKER_SAMPLES + FILTER_SAMPLES); }
