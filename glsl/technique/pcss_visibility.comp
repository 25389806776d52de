#version 460
#extension GL_GOOGLE_include_directive : require
// Percentage-closer soft shadows [Fernando05]: the mean depth of the blockers found around the pixel's projection
// tells how wide to filter. In [0, 1], and the same in every frame; the penumbra is a guess.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "filtered.glsl"
#include "cut.glsl"

layout(constant_id = 19) const uint BLOCKER_SAMPLES = 1u;  // of the blocker search
layout(constant_id = 20) const uint FILTER_SAMPLES = 1u;   // of the percentage-closer filter

const float TAU = 6.28318530718;

// [0, 1)² Point i of a sequence that fills the square evenly (Roberts' R2), shifted by `shift` round its borders.
vec2 sequence(uint i, vec2 shift) { return fract(vec2(0.7548776662, 0.5698402910) * float(i) + shift); }

// [half sizes] The direction with a perimeter parameter, as far as the unit square's border.
vec2 direction_of(float parameter) {
    float side = floor(0.5 * (parameter + 1.0));
    float along = parameter - 2.0 * side;
    vec2 towards = side == 0.0 || side == 4.0 ? vec2(1.0, along) : side == 1.0 ? vec2(-along, 1.0)
                 : side == 2.0 ? vec2(-1.0, -along) : vec2(along, -1.0);
    return towards;
}

// How many times a direction reaches from the centre to the border.
float border_of(View view, vec2 direction) {
    vec2 side = mix(view.extent.xy, view.extent.zw, greaterThan(direction, vec2(0.0)));
    vec2 box = side / mix(direction, sign(side) * 1e-12, lessThan(abs(direction), vec2(1e-12)));
    float reach = min(box.x, box.y);
    [[unroll]] for (uint i = 0u; i < EDGES; ++i) {
        vec3 line = edge_line(view, i);
        float towards = dot(line.xy, direction);
        if (towards > 0.0) reach = min(reach, line.z / towards);
    }
    return reach;
}

// As `point_of`, of a polygon or a part of it: the table says where as much is swept.
vec2 point_of_polygon(View view, vec2 at) {
    float wanted = at.y * view.area;
    uint entry = 0u;
    [[unroll]] for (uint step = SECTOR_STEPS / 2u; step > 0u; step /= 2u)
        entry += sectors[view.sector_first + entry + step] <= wanted ? step : 0u;
    vec2 swept = vec2(sectors[view.sector_first + entry], sectors[view.sector_first + entry + 1u]);
    float within = clamp((wanted - swept.x) / max(swept.y - swept.x, 1e-12), 0.0, 1.0);
    vec2 direction = direction_of((float(entry) + within) * (8.0 / float(SECTOR_STEPS)));
    return direction * border_of(view, direction) * sqrt(at.x);
}

// [half sizes] A point of the sub-light; equal areas for equal areas of the square.
vec2 point_of(View view, vec2 at) {
    if (EDGES > 0u) return point_of_polygon(view, at);
    if (!DISC_LIGHT) return mix(view.extent.xy, view.extent.zw, at);
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

float hidden_share(View view, Fit fit, uvec2 pixel, Receiver receiver) {
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

uint samples_read_by_pixel() { return BLOCKER_SAMPLES + FILTER_SAMPLES; }
