#version 460
#extension GL_GOOGLE_include_directive : require
// Which packets are coherent: they go to the packet list, the pixels of the others to the pixel list [Yang09 §4.3, eq. 4–6].
// Every penumbra pixel comes to one of the lists; which one decides on run time only.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "receiver.glsl"
#include "kernel.glsl"
#include "coarse_map.glsl"
#include "quality.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(frame);
readonly BUFFER(views);
readonly BUFFER(fits);
readonly BUFFER(kernels);
writeonly BUFFER(packets);
writeonly BUFFER(pixels);
readonly BUFFER(costs);
BUFFER(counters);
readonly BUFFER(quality);

#include "surface.glsl"
#include "part_of_view.glsl"
#include "packet_grid.glsl"
#include "rounds.glsl"
#include "list_append.glsl"

// T_d of [Yang09 §4.3].
const float DIVERGENCE_MAX = 0.8;

// What is found out about a packet, from its penumbra pixels.
struct PacketStats {
    Packet packet;
    ivec2 first;
    ivec2 last;
    uint count;
    vec2 kernel_depths;
    float pixel_cost;
    // A receiver has the sub-light's centre behind its plane; what bounds the others' limits does not hold for it.
    bool behind;
    // [level] Least and largest whole one of quality.
    vec2 levels;
};

float node_cost(float width) {
    precise float cost = log2(max(width, 2.0)) * width;
    return cost;
}

float width_of(ivec2 first, ivec2 last) {
    ivec2 side = last - first + 1;
    return float(max(side.x, side.y));
}

void include_level(inout PacketStats stats, uint pixel) {
    if (BUDGET == 0u) return;
    float level = floor(quality[pixel]);
    stats.levels = vec2(min(stats.levels.x, level), max(stats.levels.y, level));
}

void include(inout PacketStats stats, Kernel kernel, Receiver receiver) {
    ivec2 first = unpacked(kernel.first);
    ivec2 last = unpacked(kernel.last);
    stats.first = min(stats.first, first);
    stats.last = max(stats.last, last);
    stats.behind = stats.behind || receiver.behind;
    if (stats.count == 0u) stats.packet.origin = receiver.t;
    precise vec2 way = stats.packet.origin - receiver.t;
    precise float at_origin = receiver.biased + (receiver.plane.x * way.x + receiver.plane.y * way.y);
    stats.packet.plane_depths.x = min(stats.packet.plane_depths.x, at_origin);
    stats.packet.plane_depths.y = max(stats.packet.plane_depths.y, at_origin);
    stats.packet.planes.xy = min(stats.packet.planes.xy, receiver.plane);
    stats.packet.planes.zw = max(stats.packet.planes.zw, receiver.plane);
    stats.packet.depth_min = min(stats.packet.depth_min, receiver.biased);
    stats.packet.depth_max = max(stats.packet.depth_max, receiver.biased);
    stats.packet.depth_far = min(stats.packet.depth_far, receiver.d);
    stats.packet.centers.xy = min(stats.packet.centers.xy, receiver.t);
    stats.packet.centers.zw = max(stats.packet.centers.zw, receiver.t);
    stats.kernel_depths.x = min(stats.kernel_depths.x, kernel.depth_min);
    stats.kernel_depths.y = max(stats.kernel_depths.y, kernel.depth_max);
    float width = width_of(first, last);
    precise float cost = node_cost(width) + (costs.edge + costs.visibility) * width;
    stats.pixel_cost += cost;
    ++stats.count;
}

// The probability that the packet's pixels see different contours is small, and sharing the traversal
// costs less than it saves.
// DEVIATION [Yang09 eq. 4]: depths are projective, since an empty sample has no finite linear depth.
// DEVIATION [Yang09 eq. 4]: the spread of the receivers' planes counts as that of their depths does.
// DEVIATION [Yang09 eq. 6]: only penumbra pixels count, for the others are not integrated.
// Pixels whose visibility is blended between other levels of quality share no walk.
bool is_coherent(PacketStats stats) {
    if (stats.behind || stats.levels.x < stats.levels.y) return false;
    float width = width_of(stats.first, stats.last);
    float overlap = min(stats.packet.depth_max, stats.kernel_depths.y)
                  - max(stats.packet.depth_min, stats.kernel_depths.x);
    // How far apart the pixels' planes are at the kernel's farthest corner: the same question about what `limit_at` adds.
    vec2 origin = stats.packet.origin;
    precise vec2 reach = max(abs(vec2(stats.first) - origin), abs(vec2(stats.last) - origin));
    precise vec2 tilts = (stats.packet.planes.zw - stats.packet.planes.xy) * reach;
    precise float apart = (stats.packet.plane_depths.y - stats.packet.plane_depths.x) + (tilts.x + tilts.y);
    float null = clamp(max(overlap, apart) / max(stats.kernel_depths.y - stats.kernel_depths.x, 1e-30), 0.0, 1.0);
    float divergence = 1.0 - pow(1.0 - null, width * width);
    if (divergence > DIVERGENCE_MAX) return false;
    precise float packet_cost = node_cost(width) + (costs.edge + costs.visibility * float(stats.count)) * width;
    return packet_cost <= stats.pixel_cost;
}

void main() {
    uvec2 grid = packet_grid();
    uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, grid))) return;
    View view = views[view_index()];
    Fit fit = fits[view_index()];
    PacketStats stats;
    stats.packet = Packet(at.y * grid.x + at.x, 0u, 0u, 1e30, 0.0, 1e30, vec4(1e30, 1e30, -1e30, -1e30), vec2(0.0),
                          vec2(1e30, -1e30), vec4(1e30, 1e30, -1e30, -1e30));
    stats.first = ivec2(1 << 30);
    stats.last = ivec2(-1);
    stats.count = 0u;
    stats.kernel_depths = vec2(1e30, 0.0);
    stats.pixel_cost = 0.0;
    stats.behind = false;
    stats.levels = BUDGET > 0u ? vec2(1e30, -1e30) : vec2(0.0);
    uint index;
    [[dont_unroll]] for (uint i = 0u; i < PIXELS_PER_PACKET; ++i) {
        if (!is_penumbra(at, i, index)) continue;
        include_level(stats, index);
        SurfacePoint point = surface_at(pixel_at(index));
        include(stats, kernels[index], project(view, fit, point.position - view.center, point.normal, point.error));
    }
    if (stats.count == 0u) return;
    if (COUNT) atomicAdd(counters.packets, 1u);
    if (!PIXELWISE && is_coherent(stats)) {
        if (COUNT) atomicAdd(counters.coherent_packets, 1u);
        stats.packet.first = packed(stats.first);
        stats.packet.last = packed(stats.last);
        append_packet(stats.packet);
        return;
    }
    [[dont_unroll]] for (uint i = 0u; i < PIXELS_PER_PACKET; ++i)
        if (is_penumbra(at, i, index)) append_pixel(index);
}
