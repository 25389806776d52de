#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
// Visibility of the pixel list's pixels from microquads: four neighbouring occluder samples span a quadrangle, whose
// back-projection sets the bits of the light samples that it hides [SS07].
#include "pass.glsl"
#include "depth.glsl"
#include "light.glsl"
#include "contour.glsl"
#include "kernel.glsl"
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
layout(binding = 13, scalar) buffer Partial { uint partial[]; };
layout(binding = 14, scalar) buffer ProgressBlock { Progress progress[]; };
layout(binding = 15, scalar) buffer Rounds { Round rounds[]; };
#include "radial.glsl"
#include "listed.glsl"

const uint SAMPLE_COUNT = LIGHT_SAMPLES * LIGHT_SAMPLES;
const uint WORDS = (SAMPLE_COUNT + 31u) / 32u;

uint bits[WORDS];

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

bool on_light(View view, vec2 q) { return !ROUND || distance(q, view.rim.xy) <= view.rim.z; }

// Whether q lies in the triangle a, b, c of either orientation.
bool in_triangle(vec2 q, vec2 a, vec2 b, vec2 c) {
    vec3 sides = vec3((b.x - a.x) * (q.y - a.y) - (b.y - a.y) * (q.x - a.x),
                      (c.x - b.x) * (q.y - b.y) - (c.y - b.y) * (q.x - b.x),
                      (a.x - c.x) * (q.y - c.y) - (a.y - c.y) * (q.x - c.x));
    return all(greaterThanEqual(sides, vec3(0.0))) || all(lessThanEqual(sides, vec3(0.0)));
}

// Sets the bits of the samples in the microquad over a cell, if there is one.
void cover(Listed listed, ivec2 cell, vec4 depths, bool exists) {
    vec2 corner[4];
    bool ahead = exists;
    [[unroll]] for (int i = 0; i < 4; ++i) {
        vec2 at = vec2(cell) + vec2(i == 1 || i == 2 ? 1.0 : 0.0, i >= 2 ? 1.0 : 0.0);
        vec3 q = back_project(listed.receiver, at - listed.receiver.t, depths[i]);
        ahead = ahead && q.z > 0.0;
        corner[i] = q.xy / q.z;
    }
    vec2 size = listed.view.extent.zw - listed.view.extent.xy;
    vec2 lower = (min(min(corner[0], corner[1]), min(corner[2], corner[3])) - listed.view.extent.xy) / size;
    vec2 upper = (max(max(corner[0], corner[1]), max(corner[2], corner[3])) - listed.view.extent.xy) / size;
    float side = float(LIGHT_SAMPLES);
    ivec2 first = ivec2(floor(clamp(lower, 0.0, 1.0) * side));
    ivec2 last = min(ivec2(floor(clamp(upper, 0.0, 1.0) * side)), ivec2(LIGHT_SAMPLES - 1u));
    if (any(greaterThan(lower, vec2(1.0))) || any(lessThan(upper, vec2(0.0))) || !ahead) last = first - 1;
    ivec2 stratum = first;
    uint turns = 0u;
    while (stratum.y <= last.y && stratum.x <= last.x) {
        ++turns;
        vec2 q = light_sample(listed.view, uvec2(stratum));
        bool hit = in_triangle(q, corner[0], corner[1], corner[2]) || in_triangle(q, corner[0], corner[2], corner[3]);
        uint bit = uint(stratum.y) * LIGHT_SAMPLES + uint(stratum.x);
        bits[bit >> 5] |= hit ? 1u << (bit & 31u) : 0u;
        stratum = stratum.x < last.x ? stratum + ivec2(1, 0) : ivec2(first.x, stratum.y + 1);
    }
    steps += subgroupMax(turns) + 1u;
}

// Goes on to the next microquad and stays there; false: there is none left.
bool find_quad(Listed listed, uint layer, inout Scan scan) {
    bool found = false;
    uint turns = 0u;
    while (!found && !at_end(scan) && !out_of_turns(turns)) {
        ++turns;
        found = mask_of(depths_of(layer, scan.at), vec4(listed.receiver.biased)) == 15u;
        if (!found) advance(scan);
    }
    nodes_visited += turns;
    samples_read += 4u * turns;
    edges_extracted += uint(found);
    steps += subgroupMax(turns) + 1u;
    return found;
}

// The loops are nested so that invocations side by side look for microquads together and set bits together.
void cover_layer(Listed listed, uint layer, inout Scan scan) {
    while (!at_end(scan) && !out_of_turns(0u)) {
        ++steps;
        bool found = find_quad(listed, layer, scan);
        cover(listed, scan.at, depths_of(layer, scan.at), found);
        if (found) advance(scan);
    }
}

// Share of the light samples that are covered.
float covered_share(View view) {
    uint on = 0u;
    uint covered = 0u;
    for (uint i = 0u; i < SAMPLE_COUNT; ++i) {
        bool counts = on_light(view, light_sample(view, uvec2(i % LIGHT_SAMPLES, i / LIGHT_SAMPLES)));
        on += uint(counts);
        covered += counts ? bits[i >> 5] >> (i & 31u) & 1u : 0u;
    }
    return float(covered) / float(max(on, 1u));
}

void main() {
    Listed listed;
    if (!find_listed(listed)) return;
    for (uint i = 0u; i < WORDS; ++i) bits[i] = is_first_round() ? 0u : partial[listed.index * WORDS + i];
    uint layer;
    Scan scan = scan_at(listed.first, listed.last, next_number(listed), layer);
    while (layer < LAYERS && !out_of_turns(0u)) {
        ++steps;
        cover_layer(listed, layer, scan);
        bool through = at_end(scan);
        layer += uint(through);
        scan.at = through ? scan.first : scan.at;
    }
    if (close_round(listed, layer < LAYERS, Progress(number_of(scan, layer), 0u, 0u, 0u)))
        conclude(listed, covered_share(listed.view));
    else
        for (uint i = 0u; i < WORDS; ++i) partial[listed.index * WORDS + i] = bits[i];
    count_work();
}
