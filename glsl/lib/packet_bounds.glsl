// What can be said of all pixels of a packet at once: bounds of what their samples are compared with (`limit_at`, `ceiling_at`),
// and of where their occluders stand. Needs receiver.glsl, kernel.glsl and contour.glsl.
//
// DEVIATION [Yang09 eq. 3]: instead of with a range of depths, samples are compared with bounds of the packet's limits there,
// which follow the receivers' planes; see `limit_at`.

layout(constant_id = 4) const bool FOOTPRINT = true;  // prune nodes that miss the light

// The pass knows whether the packet's pixels are seen from behind their planes: all are, or none.
bool is_behind(Packet packet);

// Bounds of the depths of the pixels' planes at the samples of a box: a lower one and an upper one.
vec2 planes_in(Packet packet, vec2 lower, vec2 upper) {
    vec2 from = lower - packet.origin;
    vec2 to = upper - packet.origin;
    vec4 low = vec4(packet.planes.xy * from, packet.planes.xy * to);
    vec4 high = vec4(packet.planes.zw * from, packet.planes.zw * to);
    vec4 least = min(low, high);
    vec4 most = max(low, high);
    vec2 fall = min(least.xy, least.zw);
    vec2 rise = max(most.xy, most.zw);
    // For the rounding of these sums and of those in `limit_at`.
    vec2 size = max(abs(fall), abs(rise));
    vec2 depths = abs(packet.plane_depths);
    float rounding = 1e-6 * (max(depths.x, depths.y) + size.x + size.y);
    return vec2(packet.plane_depths.x + fall.x + fall.y - rounding, packet.plane_depths.y + rise.x + rise.y + rounding);
}

// Bounds of the depths beyond which a sample of the box occludes (x, y), and up to which it does (z, w).
vec4 limits_in(Packet packet, vec2 lower, vec2 upper) {
    vec2 planes = planes_in(packet, lower, upper);
    vec2 limits = vec2(packet.depth_min, packet.depth_max);
    return is_behind(packet) ? vec4(limits, planes) : vec4(max(planes, limits), vec2(1e30));
}

// Whether samples with these bounds of depth may occlude one of the pixels and not another, or one of them and another not.
bool may_differ(vec2 bounds, vec4 limits) {
    bool none = bounds.y <= limits.x || bounds.x > limits.w;
    bool all_of_them = bounds.x > limits.y && bounds.y <= limits.z;
    return !none && !all_of_them;
}

// The corners of a cell that occlude all of the pixels; agreed: the others occlude none.
uint mask_in(Packet packet, ivec2 cell, vec4 depths, out bool agreed) {
    uint certain = 0u;
    uint possible = 0u;
    for (uint corner = 0u; corner < 4u; ++corner) {
        vec2 at = vec2(cell) + vec2(corner == 1u || corner == 2u, corner >= 2u);
        vec4 limits = limits_in(packet, at, at);
        float depth = depths[corner];
        certain |= uint(depth > limits.y && depth <= limits.z) << corner;
        possible |= uint(depth > limits.x && depth <= limits.w) << corner;
    }
    agreed = certain == possible;
    return certain;
}

// Whether nothing in the node can project onto the light, for any of the packet's pixels, seen in a map that is parallel to
// the light (algorithm.md §7): exact, since occluders as near as `depth_max` reach no farther than this. kappa: the scale
// of back-projection, which such a map's receivers share.
bool misses_light(View view, Packet packet, vec2 kappa, ivec2 node, int side, float depth_max) {
    vec2 reach = (depth_max - packet.depth_far) / kappa;
    return any(greaterThan(vec2(node), packet.centers.zw + reach * view.extent.zw))
        || any(lessThan(vec2(node + side), packet.centers.xy + reach * view.extent.xy));
}
