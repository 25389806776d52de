#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
// Visibility of packets that a subgroup walks for together: its lanes look at different nodes of the hierarchy
// (cooperative_walk.glsl), then each extracts an edge of the contour, then each adds up all edges for its own pixel. Which
// pixels walk together is decided here (local_packets.glsl). The image is that of pixel_visibility.comp, to which packets
// go whose walk is longer than the driver allows.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "receiver.glsl"
#include "kernel.glsl"
#include "contour.glsl"
#include "map.glsl"
#include "budget.glsl"
#include "rounds.glsl"
#include "count.glsl"
#include "radial.glsl"
#include "blend.glsl"
#include "packet_bounds.glsl"
#include "cooperative_walk.glsl"
#include "local_packets.glsl"

layout(local_size_x = GROUP_SIZE) in;

readonly BUFFER(frame);
readonly BUFFER(views);
readonly BUFFER(fits);
readonly BUFFER(kernels);
BUFFER(packets);
BUFFER(pixels);

#include "surface.glsl"
#include "part_of_view.glsl"
#include "occlusion.glsl"
#include "packet_grid.glsl"
#include "list_append.glsl"
#include "window.glsl"

readonly BUFFER(windows);

// Lanes that have found an edge, and those that have found a cell that the pixels see differently: an entry each, or two
// where it has two edges.
shared uint edge_lanes[GROUP_SIZE];
shared uint cell_lanes[2u * GROUP_SIZE];

// This lane's pixel, at the level of quality that the pass reads for it.
int level_of_lane;
Receiver receiver;
Kernel kernel;
// [half sizes²] What it adds up.
float sum;

// Back-projection scale of a map that is parallel to the light, which all receivers share.
vec2 kappa;
bool packet_is_behind;

bool is_behind(Packet packet) { return packet_is_behind; }

bool is_pruned(View view, Packet packet, ivec2 node, int side, vec2 bounds) {
    return FOOTPRINT && !OBLIQUE && misses_light(view, packet, kappa, node, side, bounds.y);
}

// What a lane has found out about a cell.
struct Found {
    ivec2 cell;
    vec4 depths;
    uint mask;
    // All pixels of the packet see the same contour.
    bool agreed;
};

Found found_by(uint other, Found own) {
    uint node = subgroupShuffle(packed_node(own.cell, 0), other);
    uint mask = subgroupShuffle(own.mask | uint(own.agreed) << 4, other);
    return Found(cell_of(node), subgroupShuffle(own.depths, other), mask & 15u, mask > 15u);
}

// The corners of a cell that occlude this lane's pixel.
uint corners_of(Found found) {
    uint own = occluding(receiver, found.cell, found.depths);
    return found.agreed ? found.mask : own;
}

// Integrates the edges that lanes have extracted, one after the other, for the pixels of all lanes. Loops end below their
// bodies, for some drivers enter a body once more than it has turns.
void integrate_edges(View view, Found found, bool wanted) {
    uvec4 ballot = subgroupBallot(wanted);
    uint count = subgroupBallotBitCount(ballot);
    Edge edge = edge_of(found.cell, found.depths, found.mask, 0u);
    if (wanted) edge_lanes[share_first + subgroupBallotExclusiveBitCount(ballot)] = gl_SubgroupInvocationID;
    subgroupBarrier();
    if (count > 0u) {
        uint i = 0u;
        [[dont_unroll]] do {
            uint from = edge_lanes[share_first + i];
            sum -= edge_beyond(view, receiver, Edge(subgroupShuffle(edge.a, from), subgroupShuffle(edge.b, from)));
        } while (++i < count);
    }
    edges_extracted += lane == 0u ? count : 0u;
    spend_nested(count, 1u);
}

// Goes through cells whose contour the pixels see differently, and lists those that some pixel has an edge in. Returns how
// many entries there are.
uint list_cells(Found found, bool wanted, bool takes_part) {
    uvec4 ballot = subgroupBallot(wanted);
    uint count = subgroupBallotBitCount(ballot);
    if (wanted) edge_lanes[share_first + subgroupBallotExclusiveBitCount(ballot)] = gl_SubgroupInvocationID;
    subgroupBarrier();
    uint listed = 0u;
    if (count > 0u) {
        uint i = 0u;
        [[dont_unroll]] do {
            uint from = edge_lanes[share_first + i];
            // By all lanes: one that does not take part may have found the cell.
            uint mask = corners_of(found_by(from, found));
            uint segments = takes_part ? segment_count(mask) : 0u;
            bool one = subgroupAny(segments > 0u);
            bool two = subgroupAny(segments > 1u);
            if (one) cell_lanes[2u * share_first + listed] = from;
            if (two) cell_lanes[2u * share_first + listed + 1u] = from | 1u << 16;
            listed += uint(one) + uint(two);
        } while (++i < count);
    }
    spend_nested(count, 1u);
    subgroupBarrier();
    return listed;
}

// Integrates cells of which each pixel has edges of its own.
void integrate_cells(View view, Found found, uint listed) {
    if (listed > 0u) {
        uint i = 0u;
        [[dont_unroll]] do {
            uint entry = cell_lanes[2u * share_first + i];
            Found other = found_by(entry & 0xffffu, found);
            sum -= segment_beyond(view, receiver, other.cell, other.depths, corners_of(other), entry >> 16);
        } while (++i < listed);
    }
    edges_extracted += lane == 0u ? listed : 0u;
    spend_nested(listed, 1u);
}

// Adds up over the packet's kernel for each lane. False: it gave up.
bool sum_kernel(View view, Packet packet, int level_count, bool takes_part) {
    sum = 0.0;
    SharedWalk walk = shared_walk_over(packet, level_count);
    do {
        Found found;
        bool mine = next_cells(view, packet, walk, found.cell);
        found.depths = depths_of(0u, found.cell);
        found.mask = mask_in(packet, found.cell, found.depths, found.agreed);
        samples_read += mine ? 4u : 0u;
        bool single = found.agreed && segment_count(found.mask) == 1u;
        bool differs = !found.agreed || segment_count(found.mask) > 1u;
        integrate_edges(view, found, mine && single);
        subgroupBarrier();
        uint listed = list_cells(found, mine && differs, takes_part);
        integrate_cells(view, found, listed);
        subgroupBarrier();
        settle();
    } while (!at_end(walk) && budget_lasts());
    return at_end(walk);
}

// Hides the lane's pixel as far as the sum says, or leaves it to the pixel list.
void conclude(View view, uint index, bool complete) {
    if (!complete) {
        append_pixel(index | left_to_list());
        return;
    }
    float hidden = sum + centre_area(view, receiver, 0u);
    add_occluded(index, share_of_level(index) * view.weight * share_of(hidden, view.area));
}

void count_packet(bool takes_part, bool complete) {
    uint size = subgroupBallotBitCount(subgroupBallot(takes_part));
    if (lane > 0u) return;
    atomicAdd(counters.packets, 1u);
    if (size > 1u) atomicAdd(counters.coherent_packets, 1u);
    if (!complete) atomicAdd(counters.reprocessed_packets, 1u);
}

// Holds this lane's pixel.
void hold_pixel(View view, Fit fit, uvec2 pixel) {
    uint index = index_of(pixel);
    choose_level(view, index);
    level_of_lane = level_of_quality;
    SurfacePoint point = surface_at(pixel);
    receiver = at_level(view, project(view, fit, point.position - view.center, point.normal, point.error));
    kernel = kernels[first_pixel() + index];
    Cells cells = at_level(Cells(unpacked(kernel.first), unpacked(kernel.last), true));
    kernel.first = packed(cells.first);
    kernel.last = packed(cells.last);
}

// Whether this lane's pixel had better walk with that of the first active lane, at one level.
bool joins_first(uvec2 cell) {
    bool same_level = subgroupBroadcastFirst(level_of_lane) == level_of_lane;
    bool like = is_like_first(receiver, kernel, cell);
    return same_level && like;
}

// Makes all lanes read the level of those that take part.
void read_level(View view, Fit fit, bool takes_part) {
    if (QUALITY != QUALITY_FINEST) {
        level_of_quality = subgroupMax(takes_part ? level_of_lane : 0);
        coarse_map_size = view.map_size;
    }
    kappa = fit.near / (fit.focal * view.half_size) * float(1 << level_of_quality);
}

// Integrates the pixels that the lanes hold. remains: this lane has one.
void integrate_pixels(View view, Fit fit, uvec2 pixel, bool remains) {
    uint index = index_of(pixel);
    uvec2 cell = pixel / uvec2(PACKET_WIDTH, PACKET_HEIGHT);
    receiver = Receiver(vec2(0.0), 0.0, 0.0, vec2(0.0), false, vec2(1.0), vec2(1.0), vec2(0.0));
    kernel = Kernel(KERNEL_NONE, 0u, 0u, 0.0, 0.0);
    level_of_lane = 0;
    if (remains) hold_pixel(view, fit, pixel);
    if (!subgroupAny(remains)) return;
    do {
        bool takes_part = false;
        if (remains) takes_part = joins_first(cell);
        remains = remains && !takes_part;
        read_level(view, fit, takes_part);
        packet_is_behind = subgroupAny(takes_part && receiver.behind);
        Packet packet = packet_of(index, receiver, kernel, takes_part);
        bool complete = sum_kernel(view, packet, int(fit.level_count), takes_part);
        if (takes_part) conclude(view, index, complete);
        if (COUNT) count_packet(takes_part, complete);
    } while (subgroupAny(remains));
}

void main() {
    find_lanes();
    View view = views[view_index()];
    Fit fit = fits[view_index()];
    uint held = subgroupBallotBitCount(subgroupBallot(true));
    uint group = gl_WorkGroupID.y * GROUPS_PER_ROW + gl_WorkGroupID.x;
    uint groups = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    uint listed = lists[view_index()].packet_count;
    uint entry = group * gl_NumSubgroups + gl_SubgroupID;
    if (entry >= listed) return;
    do {
        Window window = windows[first_window() + entry];
        uint count = bitCount(window.penumbra.x) + bitCount(window.penumbra.y);
        uint first = 0u;
        do {
            uint rank = min(first + lane, count - 1u);
            uvec2 pixel = window.place * TILE_SIZE + pixel_in_window(place_of_bit(window.penumbra, rank));
            bool remains = first + lane < count;
            if (QUALITY != QUALITY_FINEST && remains) remains = share_of_level(index_of(pixel)) > 0.0;
            integrate_pixels(view, fit, pixel, remains);
            first += held;
        } while (first < count);
        entry += groups * gl_NumSubgroups;
    } while (entry < listed);
    if (COUNT) count_work();
}
