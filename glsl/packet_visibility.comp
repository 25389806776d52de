#version 460
#extension GL_GOOGLE_include_directive : require
// Visibility of packets of w×h pixels: the MSSM is walked with a stack, contour cells are extracted once
// and integrated for each pixel [Yang09 §4.1, §4.2, alg. 2 and 3]. With packets of 1×1 it works off
// the pixel list.
#include "pass.glsl"
#include "depth.glsl"
#include "light.glsl"
#include "contour.glsl"
#include "mssm_levels.glsl"
#include "mssm.glsl"
#include "kernel.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(binding = 0, scalar) readonly buffer FrameBlock { Frame frame; };
layout(binding = 1, scalar) readonly buffer Views { View views[]; };
layout(binding = 2, scalar) readonly buffer Fits { Fit fits[]; };
layout(binding = 3) uniform texture2D position_world;
layout(binding = 4) uniform texture2D normal_world;
layout(binding = 5) uniform texture2D shadow_map;
layout(binding = 6) uniform texture2DArray mssm;
layout(binding = 7, scalar) readonly buffer Kernels { Kernel kernels[]; };
layout(binding = 8, scalar) buffer Packets { Packet packets[]; };
layout(binding = 9, scalar) buffer Pixels { uint pixels[]; };
layout(binding = 10, scalar) buffer Occlusion { float occlusion[]; };
layout(binding = 11, scalar) readonly buffer Sectors { float sectors[]; };
layout(binding = 12, scalar) buffer CountersBlock { Counters counters; };
layout(binding = 13, scalar) buffer ListsBlock { Lists lists[]; };
#include "lists.glsl"
#include "radial.glsl"

const uint PIXELS_PER_PACKET = PACKET_WIDTH * PACKET_HEIGHT;
uint held_count = 0u;
uint held_pixel[HELD];
Receiver held[HELD];
float beyond[HELD];

uint nodes_visited = 0u;
uint edges_extracted = 0u;

void hold(View view, Fit fit, uint index) {
    ivec2 pixel = ivec2(index % frame.size.x, index / frame.size.x);
    vec3 to_point = texelFetch(position_world, pixel, 0).xyz - view.center;
    vec3 normal = texelFetch(normal_world, pixel, 0).xyz;
    held_pixel[held_count] = index;
    held[held_count] = project(view, fit, to_point, normal);
    beyond[held_count] = 0.0;
    ++held_count;
}

// Whether pixel `i` of the packet is to be integrated, and its index.
bool penumbra_pixel(Packet packet, uint i, out uint index) {
    uint columns = (frame.size.x + PACKET_WIDTH - 1u) / PACKET_WIDTH;
    uvec2 pixel = uvec2(packet.index % columns, packet.index / columns) * uvec2(PACKET_WIDTH, PACKET_HEIGHT)
                + uvec2(i % PACKET_WIDTH, i / PACKET_WIDTH);
    index = pixel.y * frame.size.x + pixel.x;
    return all(lessThan(pixel, frame.size)) && kernels[index].status == KERNEL_PENUMBRA;
}

// A single pixel as a packet; its receiver is held.
Packet packet_of_pixel(uint index) {
    Kernel kernel = kernels[index];
    Receiver receiver = held[0];
    return Packet(index, kernel.first, kernel.last, receiver.biased, receiver.biased, receiver.d, receiver.t.xyxy);
}

// Whether nothing in the node can project onto the light, for any of the packet's pixels
// (algorithm.md §7): exact, since occluders as near as `depth_max` reach no farther than this.
bool misses_light(View view, Packet packet, ivec2 node, int side, float depth_max) {
    vec2 lower = vec2(node);
    vec2 upper = vec2(node + side);
    if (!OBLIQUE) {
        vec2 reach = (depth_max - packet.depth_far) / vec2(held[0].ku.x, held[0].kv.y);
        return any(greaterThan(lower, packet.centers.zw + reach * view.extent.zw))
            || any(lessThan(upper, packet.centers.xy + reach * view.extent.xy));
    }
    if (!PIXELWISE) return false;
    // The box's middle and reach, through the receiver's own back-projection.
    Receiver receiver = held[0];
    vec2 middle = 0.5 * (lower + upper) - receiver.t;
    vec2 reach = vec2(0.5 * float(side));
    float w = depth_max - receiver.d + dot(receiver.b, middle) + dot(abs(receiver.b), reach);
    vec2 x = dot(receiver.ku, middle) + vec2(-1.0, 1.0) * dot(abs(receiver.ku), reach);
    vec2 y = dot(receiver.kv, middle) + vec2(-1.0, 1.0) * dot(abs(receiver.kv), reach);
    return x.x > w * view.extent.z || x.y < w * view.extent.x || y.x > w * view.extent.w || y.y < w * view.extent.y;
}

// Extracts and integrates the contour of one cell. False: the pixels disagree about it and the leaf
// rule is to reprocess.
bool extract(View view, Packet packet, ivec2 cell) {
    vec4 depths = samples_of(shadow_map, cell);
    uint mask = mask_of(depths, packet.depth_max);
    bool shared_mask = PIXELWISE || mask == mask_of(depths, packet.depth_min);
    if (REPROCESS && !shared_mask) return false;
    if (shared_mask) edges_extracted += segment_count(mask);
    for (uint i = 0u; i < held_count; ++i) {
        if (!shared_mask) {
            mask = mask_of(depths, held[i].biased);
            edges_extracted += segment_count(mask);
        }
        beyond[i] += cell_beyond(view, held[i], cell, depths, mask);
    }
    return true;
}

// Walks the quadtree below one node, depth first. The stack is one integer: two bits for each level
// between the root and the current node, which say which child it is [Yang09 alg. 3].
bool walk(View view, Packet packet, ivec2 root, int top) {
    ivec2 last = unpacked(packet.last);
    int size = int(view.map_size);
    ivec2 node = root;
    int level = top;
    uint stack = 0u;
    for (;;) {
        bool descend = all(lessThanEqual(node, last));
        if (descend) {
            vec2 bounds = mssm_fetch(mssm, node, level, size);
            ++nodes_visited;
            descend = bounds.y > packet.depth_min && bounds.x <= packet.depth_max
                   && !(FOOTPRINT && misses_light(view, packet, node, 1 << level, bounds.y));
        }
        if (descend && level > 0) {
            --level;
            stack <<= 2;
            continue;
        }
        if (descend && !extract(view, packet, node)) return false;
        while ((stack & 3u) == 3u && level < top) {
            node -= ivec2(1 << level);
            stack >>= 2;
            ++level;
        }
        if (level == top) return true;
        ++stack;
        // Children 0 … 3 stand at (0, 0), (1, 0), (0, 1), (1, 1).
        node += (stack & 1u) != 0u ? ivec2(1 << level, 0) : ivec2(-(1 << level), 1 << level);
    }
}

// Starts at the lowest level whose node at the kernel's corner covers the kernel, as far as that
// level is built; beyond it from several nodes.
bool traverse(View view, Fit fit, Packet packet) {
    ivec2 first = unpacked(packet.first);
    ivec2 last = unpacked(packet.last);
    ivec2 side = last - first + 1;
    int top = min(level_covering(max(side.x, side.y)), int(fit.level_count) - 1);
    for (int y = first.y; y <= last.y; y += 1 << top)
        for (int x = first.x; x <= last.x; x += 1 << top)
            if (!walk(view, packet, ivec2(x, y), top)) return false;
    return true;
}

void count(bool finished) {
    uint before = atomicAdd(counters.nodes_visited.x, nodes_visited);
    if (before + nodes_visited < before) atomicAdd(counters.nodes_visited.y, 1u);
    before = atomicAdd(counters.edges_extracted.x, edges_extracted);
    if (before + edges_extracted < before) atomicAdd(counters.edges_extracted.y, 1u);
    if (!finished) atomicAdd(counters.reprocessed_packets, 1u);
}

void main() {
    View view = views[push.index];
    Fit fit = fits[push.index];
    uint group = gl_WorkGroupID.y * GROUPS_PER_ROW + gl_WorkGroupID.x;
    uint slot = gl_LocalInvocationID.x;
    uint lane = 0u;
    if (LANES && !PIXELWISE) {
        lane = slot % PIXELS_PER_PACKET;
        slot /= PIXELS_PER_PACKET;
        if (slot >= packets_per_group()) return;
    }
    uint entry = group * packets_per_group() + slot;
    if (entry >= (PIXELWISE ? lists[push.index].pixel_count : lists[push.index].packet_count)) return;

    Packet packet;
    bool speaks = true;  // for the packet, in `counters`
    if (PIXELWISE) {
        hold(view, fit, pixels[entry]);
        packet = packet_of_pixel(pixels[entry]);
    } else {
        packet = packets[entry];
        for (uint i = 0u; i < PIXELS_PER_PACKET; ++i) {
            uint index;
            if (!penumbra_pixel(packet, i, index)) continue;
            if (!LANES || i == lane) hold(view, fit, index);
            if (LANES && i < lane) speaks = false;
        }
        if (held_count == 0u) return;
    }

    bool finished = traverse(view, fit, packet);
    for (uint i = 0u; i < held_count; ++i) {
        if (!finished) {
            append_pixel(held_pixel[i]);
            continue;
        }
        float occluded = view.weight * occluded_share(view, held[i], shadow_map, beyond[i]);
        if (ACCUMULATE) occlusion[held_pixel[i]] += occluded;
        else occlusion[held_pixel[i]] = occluded;
    }
    if (COUNT && speaks) count(finished);
}
