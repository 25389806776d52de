#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
// Visibility pixel by pixel from every dual cell of the kernel [GBP07, as re-implemented in Yang09 §6].
#include "pass.glsl"
#include "depth.glsl"
#include "light.glsl"
#include "contour.glsl"
#include "kernel.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

layout(binding = 0, scalar) readonly buffer FrameBlock { Frame frame; };
layout(binding = 1, scalar) readonly buffer Views { View views[]; };
layout(binding = 2, scalar) buffer Fits { Fit fits[]; };
layout(binding = 3) uniform texture2D position_world;
layout(binding = 4) uniform texture2D normal_world;
layout(binding = 5) uniform texture2D shadow_map;
layout(binding = 6, scalar) readonly buffer Kernels { Kernel kernels[]; };
layout(binding = 7, scalar) buffer Occlusion { float occlusion[]; };
layout(binding = 8, scalar) readonly buffer Sectors { float sectors[]; };
layout(binding = 9, scalar) buffer CountersBlock { Counters counters; };
#include "radial.glsl"

uint cells_visited = 0u;
uint edges_extracted = 0u;

// Goes on to the next cell with a contour, from `cell` on; `found` is that cell and its samples.
void next_contour(Receiver receiver, ivec2 first, ivec2 last, inout ivec2 cell, out ivec2 found, out vec4 depths,
                  out uint mask) {
    found = cell;
    depths = vec4(0.0);
    mask = 0u;
    uint turns = 0u;
    while (segment_count(mask) == 0u && cell.y <= last.y && turns < STEPS_MAX) {
        ++turns;
        found = cell;
        depths = samples_of(shadow_map, cell);
        mask = mask_of(depths, receiver.biased);
        cell = cell.x < last.x ? cell + ivec2(1, 0) : ivec2(first.x, cell.y + 1);
    }
    cells_visited += turns;
    steps += subgroupMax(turns) + 1u;
}

// The loops are nested so that invocations side by side integrate together and look for contours together;
// the rare second segment of a cell is a turn of its own.
float sum_beyond(View view, Receiver receiver, Kernel kernel) {
    ivec2 first = unpacked(kernel.first);
    ivec2 last = unpacked(kernel.last);
    ivec2 cell = first;
    ivec2 found = first;
    vec4 depths = vec4(0.0);
    uint mask = 0u;
    uint segment = 0u;
    bool more = false;
    float beyond = 0.0;
    while ((more || cell.y <= last.y) && steps < STEPS_MAX) {
        ++steps;
        segment = more ? segment + 1u : 0u;
        if (!more) next_contour(receiver, first, last, cell, found, depths, mask);
        beyond += segment_beyond(view, receiver, found, depths, mask, segment);
        edges_extracted += uint(segment < segment_count(mask));
        more = segment + 1u < segment_count(mask);
    }
    if (more || cell.y <= last.y) atomicAdd(fits[push.index].unfinished, 1u);
    return beyond;
}

void count() {
    uint before = atomicAdd(counters.nodes_visited.x, cells_visited);
    if (before + cells_visited < before) atomicAdd(counters.nodes_visited.y, 1u);
    before = atomicAdd(counters.edges_extracted.x, edges_extracted);
    if (before + edges_extracted < before) atomicAdd(counters.edges_extracted.y, 1u);
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    uint index = pixel.y * frame.size.x + pixel.x;
    Kernel kernel = kernels[index];
    if (kernel.status != KERNEL_PENUMBRA) return;
    View view = views[push.index];
    vec3 to_point = texelFetch(position_world, ivec2(pixel), 0).xyz - view.center;
    vec3 normal = texelFetch(normal_world, ivec2(pixel), 0).xyz;
    Receiver receiver = project(view, fits[push.index], to_point, normal);
    float beyond = sum_beyond(view, receiver, kernel);
    float occluded = view.weight * occluded_share(view, receiver, shadow_map, beyond);
    if (ACCUMULATE) occlusion[index] += occluded;
    else occlusion[index] = occluded;
    if (COUNT) count();
}
