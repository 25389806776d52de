// Packets that form where they are [Yang09 §6]: of the pixels that a subgroup's lanes hold, those that are like the first one left
// walk together with it, then the next ones. Needs receiver.glsl and kernel.glsl.

// [node] What an edge costs, extracted and integrated.
const float EDGE_COST = 4.0;

float width_of(ivec2 first, ivec2 last) {
    ivec2 side = last - first + 1;
    return float(max(side.x, side.y));
}

// [node] What a packet costs, whatever its kernel.
const float PACKET_COST = 64.0;

// [node] Of a packet with a kernel so wide [Yang09 eq. 6].
float walk_cost(float width) { return PACKET_COST + (log2(max(width, 2.0)) + EDGE_COST) * width; }

// Whether this lane's pixel had better walk with that of the first active lane than by itself. What pixels that are walked for
// together cost more is the wider kernel, and the cells about which they may differ: a share of it as large as that of the
// depths between their planes [Yang09 eq. 4]. Right or wrong, the image is the same. cell: of packets of a fixed size; those of
// another do not walk together.
bool is_like_first(Receiver receiver, Kernel kernel, uvec2 cell) {
    if (any(notEqual(subgroupBroadcastFirst(cell), cell))) return false;
    if (subgroupBroadcastFirst(uint(receiver.behind)) != uint(receiver.behind)) return false;
    ivec2 own_first = unpacked(kernel.first);
    ivec2 own_last = unpacked(kernel.last);
    ivec2 first = unpacked(subgroupBroadcastFirst(kernel.first));
    ivec2 last = unpacked(subgroupBroadcastFirst(kernel.last));
    float alone = walk_cost(width_of(first, last)) + walk_cost(width_of(own_first, own_last));
    first = min(first, own_first);
    last = max(last, own_last);
    float width = width_of(first, last);
    vec2 depths = vec2(min(subgroupBroadcastFirst(kernel.depth_min), kernel.depth_min),
                       max(subgroupBroadcastFirst(kernel.depth_max), kernel.depth_max));
    vec2 t = subgroupBroadcastFirst(receiver.t);
    vec2 reach = max(abs(vec2(first) - t), abs(vec2(last) - t));
    float at_first = plane_depth_of(receiver) + dot(receiver.plane, t - receiver.t);
    float apart = abs(at_first - subgroupBroadcastFirst(plane_depth_of(receiver)))
                + dot(abs(receiver.plane - subgroupBroadcastFirst(receiver.plane)), reach);
    float between = max(apart, abs(receiver.biased - subgroupBroadcastFirst(receiver.biased)));
    float differing = min(between / max(depths.y - depths.x, 1e-30), 1.0) * width * width;
    return walk_cost(width) + differing <= alone;
}

// The packet of the lanes whose pixels take part; there is at least one.
Packet packet_of(uint index, Receiver receiver, Kernel kernel, bool takes_part) {
    Packet packet;
    packet.index = index;
    packet.first = packed(subgroupMin(takes_part ? unpacked(kernel.first) : ivec2(1 << 30)));
    packet.last = packed(subgroupMax(takes_part ? unpacked(kernel.last) : ivec2(-1)));
    packet.depth_min = subgroupMin(takes_part ? receiver.biased : 1e30);
    packet.depth_max = subgroupMax(takes_part ? receiver.biased : -1e30);
    packet.depth_far = subgroupMin(takes_part ? receiver.d : 1e30);
    packet.centers.xy = subgroupMin(takes_part ? receiver.t : vec2(1e30));
    packet.centers.zw = subgroupMax(takes_part ? receiver.t : vec2(-1e30));
    packet.origin = packet.centers.xy;
    float at_origin = plane_depth_of(receiver) + dot(receiver.plane, packet.origin - receiver.t);
    packet.plane_depths = vec2(subgroupMin(takes_part ? at_origin : 1e30), subgroupMax(takes_part ? at_origin : -1e30));
    packet.planes.xy = subgroupMin(takes_part ? receiver.plane : vec2(1e30));
    packet.planes.zw = subgroupMax(takes_part ? receiver.plane : vec2(-1e30));
    return packet;
}
