#version 460
#extension GL_GOOGLE_include_directive : require
// Coherent packets go to the packet list, the pixels of the others to the pixel list
// [Yang09 §4.3, eq. 4–6].
#include "pass.glsl"
#include "receiver.glsl"
#include "kernel.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(frame);
readonly BUFFER(views);
readonly BUFFER(fits);
TEXTURE(position_world);
TEXTURE(normal_world);
readonly BUFFER(kernels);
writeonly BUFFER(packets);
writeonly BUFFER(pixels);
readonly BUFFER(costs);
BUFFER(counters);
#include "rounds.glsl"
#include "list_append.glsl"

// T_d of [Yang09 §4.3].
const float DIVERGENCE_MAX = 0.8;

struct Survey {
    Packet packet;
    ivec2 first;
    ivec2 last;
    uint count;
    vec2 kernel_depths;
    float pixel_cost;
    // A receiver has the sub-light's centre behind its plane; what bounds the others' limits does not hold for it.
    bool behind;
};

float node_cost(float width) {
    precise float cost = log2(max(width, 2.0)) * width;
    return cost;
}

float width_of(ivec2 first, ivec2 last) {
    ivec2 side = last - first + 1;
    return float(max(side.x, side.y));
}

void include(inout Survey survey, Kernel kernel, Receiver receiver) {
    ivec2 first = unpacked(kernel.first);
    ivec2 last = unpacked(kernel.last);
    survey.first = min(survey.first, first);
    survey.last = max(survey.last, last);
    survey.behind = survey.behind || receiver.behind;
    if (survey.count == 0u) survey.packet.origin = receiver.t;
    precise vec2 way = survey.packet.origin - receiver.t;
    precise float at_origin = receiver.biased + (receiver.plane.x * way.x + receiver.plane.y * way.y);
    survey.packet.plane_depths.x = min(survey.packet.plane_depths.x, at_origin);
    survey.packet.plane_depths.y = max(survey.packet.plane_depths.y, at_origin);
    survey.packet.planes.xy = min(survey.packet.planes.xy, receiver.plane);
    survey.packet.planes.zw = max(survey.packet.planes.zw, receiver.plane);
    survey.packet.depth_min = min(survey.packet.depth_min, receiver.biased);
    survey.packet.depth_max = max(survey.packet.depth_max, receiver.biased);
    survey.packet.depth_far = min(survey.packet.depth_far, receiver.d);
    survey.packet.centers.xy = min(survey.packet.centers.xy, receiver.t);
    survey.packet.centers.zw = max(survey.packet.centers.zw, receiver.t);
    survey.kernel_depths.x = min(survey.kernel_depths.x, kernel.depth_min);
    survey.kernel_depths.y = max(survey.kernel_depths.y, kernel.depth_max);
    float width = width_of(first, last);
    precise float cost = node_cost(width) + (costs.edge + costs.visibility) * width;
    survey.pixel_cost += cost;
    ++survey.count;
}

// The probability that the packet's pixels see different contours is small, and sharing the traversal
// costs less than it saves.
// DEVIATION [Yang09 eq. 4]: depths are projective, since an empty sample has no finite linear depth.
// DEVIATION [Yang09 eq. 4]: the spread of the receivers' planes counts as that of their depths does.
// DEVIATION [Yang09 eq. 6]: only penumbra pixels count, for the others are not integrated.
bool is_coherent(Survey survey) {
    if (survey.behind) return false;
    float width = width_of(survey.first, survey.last);
    float overlap = min(survey.packet.depth_max, survey.kernel_depths.y)
                  - max(survey.packet.depth_min, survey.kernel_depths.x);
    // How far apart the pixels' planes are at the kernel's farthest corner: the same question about what `limit_at` adds.
    vec2 origin = survey.packet.origin;
    precise vec2 reach = max(abs(vec2(survey.first) - origin), abs(vec2(survey.last) - origin));
    precise vec2 tilts = (survey.packet.planes.zw - survey.packet.planes.xy) * reach;
    precise float apart = (survey.packet.plane_depths.y - survey.packet.plane_depths.x) + (tilts.x + tilts.y);
    float null = clamp(max(overlap, apart) / max(survey.kernel_depths.y - survey.kernel_depths.x, 1e-30), 0.0, 1.0);
    float divergence = 1.0 - pow(1.0 - null, width * width);
    if (divergence > DIVERGENCE_MAX) return false;
    precise float packet_cost = node_cost(width) + (costs.edge + costs.visibility * float(survey.count)) * width;
    return packet_cost <= survey.pixel_cost;
}

void main() {
    uvec2 size = uvec2(PACKET_WIDTH, PACKET_HEIGHT);
    uvec2 grid = (frame.size + size - 1u) / size;
    uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, grid))) return;
    View view = views[push.index];
    Fit fit = fits[push.index];
    Survey survey;
    survey.packet = Packet(at.y * grid.x + at.x, 0u, 0u, 1e30, 0.0, 1e30, vec4(1e30, 1e30, -1e30, -1e30), vec2(0.0),
                           vec2(1e30, -1e30), vec4(1e30, 1e30, -1e30, -1e30));
    survey.first = ivec2(1 << 30);
    survey.last = ivec2(-1);
    survey.count = 0u;
    survey.kernel_depths = vec2(1e30, 0.0);
    survey.pixel_cost = 0.0;
    survey.behind = false;
    [[dont_unroll]] for (uint i = 0u; i < size.x * size.y; ++i) {
        uvec2 pixel = at * size + uvec2(i % size.x, i / size.x);
        if (any(greaterThanEqual(pixel, frame.size))) continue;
        Kernel kernel = kernels[pixel.y * frame.size.x + pixel.x];
        if (kernel.status != KERNEL_PENUMBRA) continue;
        vec3 to_point = texelFetch(position_world, ivec2(pixel), 0).xyz - view.center;
        vec3 normal = texelFetch(normal_world, ivec2(pixel), 0).xyz;
        include(survey, kernel, project(view, fit, to_point, normal));
    }
    if (survey.count == 0u) return;
    if (COUNT) atomicAdd(counters.packets, 1u);
    if (!PIXELWISE && is_coherent(survey)) {
        if (COUNT) atomicAdd(counters.coherent_packets, 1u);
        survey.packet.first = packed(survey.first);
        survey.packet.last = packed(survey.last);
        append_packet(survey.packet);
        return;
    }
    [[dont_unroll]] for (uint i = 0u; i < size.x * size.y; ++i) {
        uvec2 pixel = at * size + uvec2(i % size.x, i / size.x);
        if (any(greaterThanEqual(pixel, frame.size))) continue;
        uint index = pixel.y * frame.size.x + pixel.x;
        if (kernels[index].status == KERNEL_PENUMBRA) append_pixel(index);
    }
}
