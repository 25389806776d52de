#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
// Visibility of packets of w×h pixels: the MSSM is walked with a stack, contour edges are extracted once
// and integrated for each pixel [Yang09 §4.1, §4.2, alg. 2 and 3]. With packets of 1×1 it works off
// the pixel list.
#include "pass.glsl"
#include "depth.glsl"
#include "light.glsl"
#include "contour.glsl"
#include "mssm_levels.glsl"
#include "mssm.glsl"
#include "kernel.glsl"
#include "walk.glsl"
#include "count.glsl"

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
layout(binding = 14, scalar) buffer Partial { float partial[]; };
layout(binding = 15, scalar) buffer ProgressBlock { Progress progress[]; };
layout(binding = 16, scalar) buffer Rounds { Round rounds[]; };
#include "lists.glsl"
#include "radial.glsl"

const uint PIXELS_PER_PACKET = PACKET_WIDTH * PACKET_HEIGHT;

// [edge] Edges are integrated in batches, so that what is held of a pixel is fetched once for all of a batch.
const uint BATCH = 4u;

// The pixels that this invocation integrates; those that are no penumbra pixels are not held.
bool is_held[HELD];
// One more than the last that is. Not a constant, or drivers unroll the loops and compile for half a minute.
uint held_end = 0u;
uint pixel_index[HELD];
// What is held of a receiver, field by field: fields that a map parallel to the light does not need cost nothing.
vec2 held_t[HELD];
float held_d[HELD];
float held_biased[HELD];
vec2 held_plane[HELD];
// Of a single pixel; packets have none.
bool held_behind = false;
vec2 held_ku[HELD];
vec2 held_kv[HELD];
vec2 held_b[HELD];
float beyond[HELD];

// Back-projection scale of a map that is parallel to the light, which all receivers share.
vec2 kappa;

uint nodes_visited = 0u;
uint edges_extracted = 0u;
uint samples_read = 0u;

void hold(View view, Fit fit, uint slot, uint index) {
    ivec2 pixel = ivec2(index % frame.size.x, index / frame.size.x);
    vec3 to_point = texelFetch(position_world, pixel, 0).xyz - view.center;
    vec3 normal = texelFetch(normal_world, pixel, 0).xyz;
    held_end = slot + 1u;
    pixel_index[slot] = index;
    Receiver receiver = project(view, fit, to_point, normal);
    held_t[slot] = receiver.t;
    held_d[slot] = receiver.d;
    held_biased[slot] = receiver.biased;
    held_plane[slot] = receiver.plane;
    if (PIXELWISE) held_behind = receiver.behind;
    if (OBLIQUE) held_ku[slot] = receiver.ku;
    if (OBLIQUE) held_kv[slot] = receiver.kv;
    if (OBLIQUE) held_b[slot] = receiver.b;
    beyond[slot] = is_first_round() ? 0.0 : partial[index];
    is_held[slot] = true;
}

Receiver receiver_of(uint slot) {
    Receiver receiver = Receiver(held_t[slot], held_d[slot], held_biased[slot], held_plane[slot], PIXELWISE && held_behind,
                                 vec2(kappa.x, 0.0), vec2(0.0, kappa.y), vec2(0.0));
    if (OBLIQUE) receiver.ku = held_ku[slot];
    if (OBLIQUE) receiver.kv = held_kv[slot];
    if (OBLIQUE) receiver.b = held_b[slot];
    return receiver;
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
    Receiver receiver = receiver_of(0u);
    // Seen from behind its plane, no sample is so near to the light that it must occlude.
    float depth_max = receiver.behind ? 1e30 : receiver.biased;
    vec2 plane = receiver.behind ? vec2(0.0) : receiver.plane;
    return Packet(index, kernel.first, kernel.last, receiver.biased, depth_max, receiver.d, receiver.t.xyxy, receiver.t,
                  vec2(receiver.biased), plane.xyxy);
}

// Bounds of the packet's pixels' limits (`limit_at`) at the samples of a box: a lower one and an upper one.
vec2 limits_in(Packet packet, vec2 lower, vec2 upper) {
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
    return max(vec2(packet.plane_depths.x + fall.x + fall.y - rounding, packet.plane_depths.y + rise.x + rise.y + rounding),
               vec2(packet.depth_min, packet.depth_max));
}

// The corners of a cell that occlude, if the packet's pixels agree about them.
uint mask_in(Packet packet, ivec2 cell, vec4 depths, out bool agreed) {
    vec2 at = vec2(cell);
    vec2 a = limits_in(packet, at, at);
    vec2 b = limits_in(packet, at + vec2(1.0, 0.0), at + vec2(1.0, 0.0));
    vec2 c = limits_in(packet, at + vec2(1.0, 1.0), at + vec2(1.0, 1.0));
    vec2 d = limits_in(packet, at + vec2(0.0, 1.0), at + vec2(0.0, 1.0));
    uint mask = mask_of(depths, vec4(a.y, b.y, c.y, d.y));
    agreed = PIXELWISE || mask == mask_of(depths, vec4(a.x, b.x, c.x, d.x));
    if (PIXELWISE) mask = occluding(receiver_of(0u), cell, depths);
    return mask;
}

// As `misses_light`, for one receiver and a map that is not parallel to the light: through the middle and
// the reach of the node's box.
bool misses_obliquely(View view, Receiver receiver, vec2 lower, vec2 upper, float depth_max) {
    vec2 middle = 0.5 * (lower + upper) - receiver.t;
    vec2 reach = 0.5 * (upper - lower);
    float w = depth_max - receiver.d + dot(receiver.b, middle) + dot(abs(receiver.b), reach);
    vec2 x = dot(receiver.ku, middle) + vec2(-1.0, 1.0) * dot(abs(receiver.ku), reach);
    vec2 y = dot(receiver.kv, middle) + vec2(-1.0, 1.0) * dot(abs(receiver.kv), reach);
    return x.x > w * view.extent.z || x.y < w * view.extent.x || y.x > w * view.extent.w || y.y < w * view.extent.y;
}

// Whether nothing in the node can project onto the light, for any of the packet's pixels
// (algorithm.md §7): exact, since occluders as near as `depth_max` reach no farther than this.
bool misses_light(View view, Packet packet, ivec2 node, int side, float depth_max) {
    vec2 lower = vec2(node);
    vec2 upper = vec2(node + side);
    vec2 reach = (depth_max - packet.depth_far) / kappa;
    bool misses = any(greaterThan(lower, packet.centers.zw + reach * view.extent.zw))
               || any(lessThan(upper, packet.centers.xy + reach * view.extent.xy));
    if (OBLIQUE) misses = PIXELWISE && misses_obliquely(view, receiver_of(0u), lower, upper, depth_max);
    return misses;
}

// Starts at the lowest level whose node at the kernel's corner covers the kernel, as far as that level is
// built; beyond it there are several roots (`ROOT_LEVELS`). Later rounds go on where the one before stood.
Walk start_of(Packet packet, int level_count, uint entry) {
    ivec2 first = unpacked(packet.first);
    ivec2 side = unpacked(packet.last) - first + 1;
    int top = min(level_covering(max(side.x, side.y)), level_count - 1);
    if (is_first_round()) return walk_from(first, top);
    return walk_on(progress[entry], top);
}

// Walks to the next cell with a contour and past it. False: there is none left.
bool next_cell(View view, Packet packet, inout Walk walk, inout ivec2 cell) {
    ivec2 first = unpacked(packet.first);
    ivec2 last = unpacked(packet.last);
    int size = int(view.map_size);
    bool found = false;
    uint turns = 0u;
    while (!found && !walk.ended && !out_of_turns(turns)) {
        ++turns;
        vec2 bounds = mssm_fetch(mssm, walk.node, walk.level, size);
        bool inside = all(lessThanEqual(walk.node, last));
        vec2 limits = limits_in(packet, vec2(walk.node), vec2(walk.node + (1 << walk.level)));
        bool open = inside && bounds.y > limits.x && bounds.x <= limits.y
                 && !(FOOTPRINT && misses_light(view, packet, walk.node, 1 << walk.level, bounds.y));
        bool settled = PIXELWISE && held_behind && one_side_of_ceiling(receiver_of(0u), walk.node, 1 << walk.level, bounds);
        open = open && !settled;
        nodes_visited += uint(inside);
        found = open && walk.level == 0;
        if (found) cell = walk.node;
        if (open && !found) descend(walk);
        else pass_by(walk, first, last);
    }
    steps += subgroupMax(turns) + 1u;
    return found;
}

// Where the extraction of edges stands: the walk, and the cell that it came to last.
struct Cursor {
    Walk walk;
    ivec2 cell;
    vec4 depths;
    uint mask;
    uint segment;
    // The cell has a second segment.
    bool more;
    // All pixels of the packet see the same contour in the cell.
    bool agreed;
};

bool at_end(Cursor cursor) { return cursor.walk.ended && !cursor.more; }

// Goes on to the next edge. False: there is none left, or the packet's pixels disagree about it.
bool next_edge(View view, Packet packet, inout Cursor cursor) {
    cursor.segment = cursor.more ? 1u : 0u;
    bool found = cursor.more;
    if (!cursor.more) found = next_cell(view, packet, cursor.walk, cursor.cell);
    cursor.depths = samples_of(shadow_map, cursor.cell);
    bool agreed;
    uint mask = mask_in(packet, cursor.cell, cursor.depths, agreed);
    cursor.mask = found ? mask : 0u;
    cursor.agreed = agreed || !found;
    uint segments = cursor.agreed ? segment_count(cursor.mask) : 0u;
    cursor.more = cursor.segment + 1u < segments;
    samples_read += found ? 4u : 0u;
    return cursor.segment < segments;
}

// Collects edges until the batch is full, the walk ends, or a cell is found whose contour the packet's pixels
// disagree about; that one is left to the caller. Returns the number of edges.
uint collect(View view, Packet packet, inout Cursor cursor, inout Edge batch[BATCH]) {
    uint count = 0u;
    cursor.agreed = true;
    while (count < BATCH && cursor.agreed && !at_end(cursor) && (cursor.more || !out_of_turns(0u))) {
        ++steps;
        bool found = next_edge(view, packet, cursor);
        Edge edge = edge_of(cursor.cell, cursor.depths, cursor.mask, cursor.segment);
        [[unroll]] for (uint i = 0u; i < BATCH; ++i) {
            bool here = i == count;
            batch[i].a = here ? edge.a : batch[i].a;
            batch[i].b = here ? edge.b : batch[i].b;
        }
        count += uint(found);
    }
    ++steps;
    edges_extracted += count;
    return count;
}

// Adds a batch of edges up for each pixel.
void integrate(View view, Edge batch[BATCH], uint count) {
    for (uint slot = 0u; slot < held_end && count > 0u; ++slot) {
        Receiver receiver = receiver_of(slot);
        // One by one, so that the sum does not depend on where batches and rounds end; not unrolled, for most of what
        // drivers compile is in here.
        float sum = beyond[slot];
        [[dont_unroll]] for (uint i = 0u; i < count; ++i) {
            Edge edge = batch[0];
            [[unroll]] for (uint j = 1u; j < BATCH; ++j) {
                edge.a = i == j ? batch[j].a : edge.a;
                edge.b = i == j ? batch[j].b : edge.b;
            }
            sum += edge_beyond(view, receiver, edge);
        }
        beyond[slot] = sum;
    }
    steps += subgroupMax(held_end) * (subgroupMax(count) + 1u) + 1u;
}

// Adds the next edge up for a single pixel: without the loops, which would cost more than they save.
void integrate_next(View view, Packet packet, inout Cursor cursor) {
    bool found = next_edge(view, packet, cursor);
    Edge edge = edge_of(cursor.cell, cursor.depths, cursor.mask, cursor.segment);
    float share = edge_beyond(view, receiver_of(0u), edge);
    beyond[0] += found ? share : 0.0;
    edges_extracted += uint(found);
}

// A cell whose contour the pixels disagree about: each has its own [algorithm.md §6, `per-pixel`].
void integrate_apart(View view, Cursor cursor) {
    bool more = !cursor.agreed;
    for (uint segment = 0u; more; ++segment) {
        more = false;
        for (uint slot = 0u; slot < held_end; ++slot) {
            Receiver receiver = receiver_of(slot);
            uint mask = occluding(receiver, cursor.cell, cursor.depths);
            beyond[slot] += segment_beyond(view, receiver, cursor.cell, cursor.depths, mask, segment);
            edges_extracted += uint(is_held[slot] && segment < segment_count(mask));
            more = more || segment + 1u < segment_count(mask);
        }
    }
    // Hardly ever two segments; counted as if always.
    steps += subgroupMax(cursor.agreed ? 0u : 2u * HELD) + 2u;
}

// The loops are nested so that invocations side by side walk together and integrate together. False: to be
// reprocessed, since the pixels disagree.
bool traverse(View view, Fit fit, Packet packet, inout Walk walk) {
    Cursor cursor = Cursor(walk, ivec2(0), vec4(0.0), 0u, 0u, false, true);
    Edge batch[BATCH];
    [[unroll]] for (uint i = 0u; i < BATCH; ++i) batch[i] = Edge(vec3(0.0), vec3(0.0));
    while (!at_end(cursor) && (cursor.agreed || !REPROCESS) && (cursor.more || !out_of_turns(0u))) {
        // Lanes share the driver's count, the turns included for which others went on and they waited.
        steps = subgroupMax(steps) + 1u;
        if (PIXELWISE) {
            integrate_next(view, packet, cursor);
        } else {
            uint count = collect(view, packet, cursor, batch);
            integrate(view, batch, count);
            if (!REPROCESS) integrate_apart(view, cursor);
        }
    }
    walk = cursor.walk;
    return cursor.agreed || !REPROCESS;
}

// What a walk to its end has found out about a pixel.
void conclude(View view, uint slot) {
    float occluded = view.weight * occluded_share(view, receiver_of(slot), shadow_map, beyond[slot]);
    if (ACCUMULATE) occlusion[pixel_index[slot]] += occluded;
    else occlusion[pixel_index[slot]] = occluded;
}

// The next round goes on with this entry.
void put_off(uint entry, uint group) {
    if (PIXELWISE) REACH(rounds[at_round(push.level + 1u)].pixel_groups, group)
    else REACH(rounds[at_round(push.level + 1u)].packet_groups, group)
}

void count(bool reprocessed) {
    COUNT_WIDE(counters.nodes_visited, nodes_visited)
    COUNT_WIDE(counters.edges_extracted, edges_extracted)
    COUNT_WIDE(counters.samples_read, nodes_visited + samples_read)
    if (reprocessed) atomicAdd(counters.reprocessed_packets, 1u);
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
    // Lanes may be out of turns at different places.
    uint place = LANES && !PIXELWISE ? entry * PIXELS_PER_PACKET + lane : entry;
    if (!is_first_round() && progress[place].next == FINISHED) return;

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
            // Unrolled, it would be most of what drivers compile.
            [[dont_unroll]] for (uint i = 0u; i < HELD; ++i) {
                uint index;
                is_held[i] = false;
                if (penumbra_pixel(packet, i, index)) hold(view, fit, i, index);
            }
        }
    }

    Walk walk = start_of(packet, int(fit.level_count), place);
    bool agreed = traverse(view, fit, packet, walk);
    bool put_by = agreed && !walk.ended && !is_last_round();
    bool reprocessed = !put_by && !(agreed && walk.ended);
    for (uint i = 0u; i < held_end; ++i) {
        if (!is_held[i]) continue;
        if (put_by) partial[pixel_index[i]] = beyond[i];
        else if (!reprocessed) conclude(view, i);
        else if (!PIXELWISE) append_pixel(pixel_index[i]);
    }
    if (put_by) put_off(entry, group);
    if (ROUNDS > 1u) {
        progress[place] = progress_of(walk);
        if (!put_by) progress[place].next = FINISHED;
    }
    if (PIXELWISE && reprocessed) atomicAdd(fits[push.index].unfinished, 1u);
    if (COUNT && speaks) count(reprocessed);
}
