#version 460
#extension GL_GOOGLE_include_directive : require
// Visibility of the pixel list's pixels: the hierarchy is walked for each, and the edges of its contour are integrated as they are
// found [Yang09 alg. 1, step 8; alg. 3; integration of GBP07]. A pixel is walked for as a packet of its own. The image is
// that of contour_visibility.comp, which looks into every cell of the kernel.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "pixel_list.glsl"
#include "radial.glsl"
#include "hierarchical_contour.glsl"

Packet packet_of_pixel() {
    Receiver receiver = pixel.receiver;
    float plane_depth = plane_depth_of(receiver);
    return Packet(pixel.index, packed(pixel.first), packed(pixel.last), receiver.biased, receiver.biased, receiver.d,
                  receiver.t.xyxy, receiver.t, vec2(plane_depth), receiver.plane.xyxy);
}

bool is_behind(Packet packet) { return pixel.receiver.behind; }

// As `misses_light`, for a map that is not parallel to the light: through the middle and the reach of the node's box.
bool misses_light_obliquely(View view, Receiver receiver, ivec2 node, int side, float depth_max) {
    vec2 lower = vec2(node);
    vec2 upper = vec2(node + side);
    vec2 middle = 0.5 * (lower + upper) - receiver.t;
    vec2 reach = 0.5 * (upper - lower);
    float w = depth_max - receiver.d + dot(receiver.b, middle) + dot(abs(receiver.b), reach);
    vec2 x = dot(receiver.ku, middle) + vec2(-1.0, 1.0) * dot(abs(receiver.ku), reach);
    vec2 y = dot(receiver.kv, middle) + vec2(-1.0, 1.0) * dot(abs(receiver.kv), reach);
    return x.x > w * view.extent.z || x.y < w * view.extent.x || y.x > w * view.extent.w || y.y < w * view.extent.y;
}

bool is_pruned(View view, Packet packet, ivec2 node, int side, vec2 bounds) {
    Receiver receiver = pixel.receiver;
    bool pruned = false;
    vec2 kappa = vec2(receiver.ku.x, receiver.kv.y);
    if (FOOTPRINT && OBLIQUE) pruned = misses_light_obliquely(view, receiver, node, side, bounds.y);
    if (FOOTPRINT && !OBLIQUE) pruned = misses_light(view, packet, kappa, node, side, bounds.y);
    return pruned;
}

uint corners_in(Packet packet, ivec2 cell, vec4 depths, out bool agreed) {
    agreed = true;
    return occluding(pixel.receiver, cell, depths);
}

Progress sum_kernel(Progress from) {
    Packet packet = packet_of_pixel();
    Cursor cursor = cursor_at(walk_over(packet, fits[view_index()].level_count, from));
    REPEAT_WHILE_PENDING(cursor.more, !at_end(cursor)) {
        bool found = next_edge(pixel.view, packet, cursor);
        float area = edge_beyond(pixel.view, pixel.receiver, edge_at(cursor));
        sum[0] -= found ? area : 0.0;
        edges_extracted += uint(found);
    }
    return progress_of(cursor.walk);
}

float hidden_share() { return share_of(sum[0] + centre_area(pixel.view, pixel.receiver, 0u), pixel.view.area); }
