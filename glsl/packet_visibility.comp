#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
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
layout(binding = 2, scalar) buffer Fits { Fit fits[]; };
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

// The pixels that this invocation integrates; those that are no penumbra pixels are not held.
bool is_held[HELD];
uint pixel_index[HELD];
Receiver held[HELD];
float beyond[HELD];

// Back-projection scale of a map that is parallel to the light, which all receivers share.
vec2 kappa;

uint nodes_visited = 0u;
uint edges_extracted = 0u;

void hold(View view, Fit fit, uint slot, uint index) {
    ivec2 pixel = ivec2(index % frame.size.x, index / frame.size.x);
    vec3 to_point = texelFetch(position_world, pixel, 0).xyz - view.center;
    vec3 normal = texelFetch(normal_world, pixel, 0).xyz;
    is_held[slot] = true;
    pixel_index[slot] = index;
    held[slot] = project(view, fit, to_point, normal);
    beyond[slot] = 0.0;
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
        vec2 reach = (depth_max - packet.depth_far) / kappa;
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

// A walk through the quadtree below one root after the other, depth first. The stack is one integer: two
// bits for each level between the root and the current node, which say which child it is
// [Yang09 alg. 3].
struct Walk {
    ivec2 root;
    ivec2 node;
    int top;
    int level;
    uint stack;
    bool ended;
};

// Starts at the lowest level whose node at the kernel's corner covers the kernel, as far as that level is
// built; beyond it there are several roots.
Walk start_of(Packet packet, int level_count) {
    ivec2 first = unpacked(packet.first);
    ivec2 side = unpacked(packet.last) - first + 1;
    int top = min(level_covering(max(side.x, side.y)), level_count - 1);
    return Walk(first, first, top, top, 0u, false);
}

// Goes on to the next node that is not below this one.
void pass_by(inout Walk walk, ivec2 first, ivec2 last) {
    // Up to the nearest ancestor that is not its parent's last child.
    int pops = min(findLSB(~walk.stack) >> 1, walk.top - walk.level);
    walk.node -= ivec2(((1 << pops) - 1) << walk.level);
    walk.level += pops;
    walk.stack = (walk.stack >> (2 * pops)) + 1u;
    // Children 0 … 3 stand at (0, 0), (1, 0), (0, 1), (1, 1).
    int side = 1 << walk.level;
    walk.node += (walk.stack & 1u) != 0u ? ivec2(side, 0) : ivec2(-side, side);
    if (walk.level < walk.top) return;
    walk.root.x += side;
    if (walk.root.x > last.x) walk.root = ivec2(first.x, walk.root.y + side);
    walk.node = walk.root;
    walk.stack = 0u;
    walk.ended = walk.root.y > last.y;
}

// Walks to the next cell with a contour and past it. False: there is none left.
bool next_cell(View view, Packet packet, inout Walk walk, inout ivec2 cell) {
    ivec2 first = unpacked(packet.first);
    ivec2 last = unpacked(packet.last);
    int size = int(view.map_size);
    bool found = false;
    uint turns = 0u;
    while (!found && !walk.ended && turns < STEPS_MAX) {
        ++turns;
        vec2 bounds = mssm_fetch(mssm, walk.node, walk.level, size);
        bool inside = all(lessThanEqual(walk.node, last));
        bool descend = inside && bounds.y > packet.depth_min && bounds.x <= packet.depth_max
                    && !(FOOTPRINT && misses_light(view, packet, walk.node, 1 << walk.level, bounds.y));
        nodes_visited += uint(inside);
        found = descend && walk.level == 0;
        if (found) cell = walk.node;
        if (descend && !found) {
            --walk.level;
            walk.stack <<= 2;
        } else {
            pass_by(walk, first, last);
        }
    }
    steps += subgroupMax(turns);
    return found;
}

// Integrates one segment of a cell's contour for each pixel. More: some pixel's contour has another one.
// False: the pixels disagree about the contour and the leaf rule is to reprocess.
bool integrate(View view, Packet packet, ivec2 cell, uint segment, out bool more) {
    vec4 depths = samples_of(shadow_map, cell);
    uint mask = mask_of(depths, packet.depth_max);
    bool agreed = PIXELWISE || mask == mask_of(depths, packet.depth_min);
    if (agreed) edges_extracted += uint(segment < segment_count(mask));
    more = false;
    for (uint i = 0u; i < HELD; ++i) {
        uint own = mask_of(depths, REPROCESS ? packet.depth_max : held[i].biased);
        own = is_held[i] ? own : 0u;
        beyond[i] += segment_beyond(view, held[i], cell, depths, own, segment);
        edges_extracted += uint(!agreed && segment < segment_count(own));
        more = more || segment + 1u < segment_count(own);
    }
    steps += HELD;
    return agreed || !REPROCESS;
}

// The loops are nested so that invocations side by side integrate together and walk together; the rare
// second segment of a cell is a turn of its own. False: to be reprocessed, since the pixels disagree or
// the walk is longer than the driver lets it be.
bool traverse(View view, Fit fit, Packet packet) {
    Walk walk = start_of(packet, int(fit.level_count));
    ivec2 cell = ivec2(0);
    uint segment = 0u;
    bool more = false;
    bool agreed = true;
    while (agreed && (more || !walk.ended) && steps < STEPS_MAX) {
        ++steps;
        segment = more ? segment + 1u : 0u;
        bool found = more;
        if (!more) found = next_cell(view, packet, walk, cell);
        if (found) agreed = integrate(view, packet, cell, segment, more);
    }
    bool finished = !more && walk.ended;
    if (PIXELWISE && !finished) atomicAdd(fits[push.index].unfinished, 1u);
    return agreed && finished;
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
    kappa = fit.near / (fit.focal * view.half_size);
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
        hold(view, fit, 0u, pixels[entry]);
        packet = packet_of_pixel(pixels[entry]);
    } else {
        packet = packets[entry];
        if (LANES) {
            uint index;
            if (!penumbra_pixel(packet, lane, index)) return;
            hold(view, fit, 0u, index);
            for (uint i = 0u; i < lane; ++i) speaks = speaks && !penumbra_pixel(packet, i, index);
        } else {
            for (uint i = 0u; i < HELD; ++i) {
                uint index;
                is_held[i] = false;
                if (penumbra_pixel(packet, i, index)) hold(view, fit, i, index);
            }
        }
    }

    bool finished = traverse(view, fit, packet);
    for (uint i = 0u; i < HELD; ++i) {
        if (is_held[i] && finished) {
            float occluded = view.weight * occluded_share(view, held[i], shadow_map, beyond[i]);
            if (ACCUMULATE) occlusion[pixel_index[i]] += occluded;
            else occlusion[pixel_index[i]] = occluded;
        } else if (is_held[i]) {
            append_pixel(pixel_index[i]);
        }
    }
    if (COUNT && speaks) count(finished);
}
