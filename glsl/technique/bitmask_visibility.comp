#version 460
#extension GL_GOOGLE_include_directive : require
// Visibility of the pixel list's pixels from microquads: four neighbouring occluder samples span a quadrangle, whose
// back-projection sets the bits of the light samples that it hides [SS07]. A sample is hidden once, however many quads
// hide it; visibility has as many steps as there are samples. Micropatches or microrects may take the quads' place [Schwarz08 §5].
#include "pass.glsl"
#include "side_by_side.glsl"

layout(constant_id = 17) const uint LIGHT_SAMPLES = 8u;   // a side of the bitmask
layout(constant_id = 18) const bool JITTERED = false;     // light samples stand anywhere in their strata

layout(constant_id = 63) const bool MICROQUADS = true;    // occluders are microquads, not micropatches or microrects

const uint SAMPLE_COUNT = LIGHT_SAMPLES * LIGHT_SAMPLES;

// The sum is a bit for each light sample.
#define SUM uint
#define SUM_WORDS ((SAMPLE_COUNT + 31u) / 32u)
#include "pixel_list.glsl"
#include "scan.glsl"
#include "microrect.glsl"
#include "occluder_box.glsl"
#include "cut.glsl"

// [0, 1)² Where a stratum's sample stands in it; the same for all pixels, so that there is no noise.
vec2 jitter(uint stratum) {
    if (!JITTERED) return vec2(0.5);
    uint hash = stratum * 747796405u + 2891336453u;
    hash = ((hash >> ((hash >> 28) + 4u)) ^ hash) * 277803737u;
    hash = (hash >> 22) ^ hash;
    return (vec2(hash & 0xffffu, hash >> 16) + 0.5) / 65536.0;
}

// [half sizes] A light sample: stratum (x, y) of the sub-light's box.
vec2 light_sample(View view, uvec2 stratum) {
    vec2 share = (vec2(stratum) + jitter(stratum.y * LIGHT_SAMPLES + stratum.x)) / float(LIGHT_SAMPLES);
    return mix(view.extent.xy, view.extent.zw, share);
}

// Whether q lies in the triangle a, b, c of either orientation.
bool in_triangle(vec2 q, vec2 a, vec2 b, vec2 c) {
    vec3 sides = vec3((b.x - a.x) * (q.y - a.y) - (b.y - a.y) * (q.x - a.x),
                      (c.x - b.x) * (q.y - b.y) - (c.y - b.y) * (q.x - b.x),
                      (a.x - c.x) * (q.y - c.y) - (a.y - c.y) * (q.x - c.x));
    return all(greaterThanEqual(sides, vec3(0.0))) || all(lessThanEqual(sides, vec3(0.0)));
}

// Sets the bits of the samples in an occluder, if there is one. depths: of its corners, counter-clockwise.
void cover(Box box, vec4 depths, bool exists) {
    vec2 corner[4];
    bool ahead = exists;
    [[unroll]] for (int i = 0; i < 4; ++i) {
        vec2 at = vec2(i == 1 || i == 2 ? box.upper.x : box.lower.x, i >= 2 ? box.upper.y : box.lower.y);
        vec3 q = back_project(pixel.receiver, at - pixel.receiver.t, depths[i]);
        ahead = ahead && q.z > 0.0;
        corner[i] = q.xy / q.z;
    }
    vec2 size = pixel.view.extent.zw - pixel.view.extent.xy;
    vec2 lower = (min(min(corner[0], corner[1]), min(corner[2], corner[3])) - pixel.view.extent.xy) / size;
    vec2 upper = (max(max(corner[0], corner[1]), max(corner[2], corner[3])) - pixel.view.extent.xy) / size;
    float side = float(LIGHT_SAMPLES);
    ivec2 first = ivec2(floor(clamp(lower, 0.0, 1.0) * side));
    ivec2 last = min(ivec2(floor(clamp(upper, 0.0, 1.0) * side)), ivec2(LIGHT_SAMPLES - 1u));
    if (any(greaterThan(lower, vec2(1.0))) || any(lessThan(upper, vec2(0.0))) || !ahead) last = first - 1;
    ivec2 stratum = first;
    FINISH_WHILE(stratum.y <= last.y && stratum.x <= last.x) {
        vec2 q = light_sample(pixel.view, uvec2(stratum));
        bool hit = in_triangle(q, corner[0], corner[1], corner[2]) || in_triangle(q, corner[0], corner[2], corner[3]);
        uint bit = uint(stratum.y) * LIGHT_SAMPLES + uint(stratum.x);
        sum[bit >> 5] |= hit ? 1u << (bit & 31u) : 0u;
        stratum = stratum.x < last.x ? stratum + ivec2(1, 0) : ivec2(first.x, stratum.y + 1);
    }
}

// The corners of the occluder at a cell or texel, and their depths.
Box corners_at(uint layer, ivec2 at, out vec4 depths) {
    if (MICROQUADS) depths = depths_of(layer, at);
    else depths = vec4(box_depth(layer, at));
    return MICROQUADS ? Box(vec2(at), vec2(at) + 1.0) : box_at(at);
}

// Goes on to the next occluder and stays there; false: there is none left.
bool find_occluder(uint layer, inout Scan scan) {
    bool found = false;
    SEARCH_WHILE(!found && !at_end(scan)) {
        vec4 depths;
        corners_at(layer, scan.at, depths);
        found = mask_of(depths, vec4(pixel.receiver.biased)) == 15u;
        if (!found) advance(scan);
        ++nodes_visited;
        samples_read += MICROQUADS ? 4u : 1u;
    }
    edges_extracted += uint(found);
    return found;
}

// The loops are nested so that invocations side by side look for occluders together and set bits together.
void sum_layer(uint layer, inout Scan scan) {
    REPEAT_WHILE(!at_end(scan)) {
        bool found = find_occluder(layer, scan);
        vec4 depths;
        Box box = corners_at(layer, scan.at, depths);
        cover(box, depths, found);
        if (found) advance(scan);
    }
}

Progress sum_kernel(Progress from) { return sum_layers(pixel.first, pixel.last + (MICROQUADS ? 0 : 1 + BOX_REACH), from); }

// Share of the light's samples that are covered.
float hidden_share() {
    uint on = 0u;
    uint covered = 0u;
    for (uint i = 0u; i < SAMPLE_COUNT; ++i) {
        bool counts = on_light(pixel.view, light_sample(pixel.view, uvec2(i % LIGHT_SAMPLES, i / LIGHT_SAMPLES)));
        on += uint(counts);
        covered += counts ? sum[i >> 5] >> (i & 31u) & 1u : 0u;
    }
    return float(covered) / float(max(on, 1u));
}
