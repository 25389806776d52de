// A technique over the list of coherent packets [Yang09 §4.1]: an invocation for each packet, or for each pixel of each where
// LANES is set. The technique defines `sum_kernel`; the rest is here.
//
// Of a receiver, each field is kept by itself: those that a map parallel to the light does not need cost nothing. Packets have
// no receivers with the sub-light's centre behind their plane.

#include "receiver.glsl"
#include "kernel.glsl"
#include "contour.glsl"
#include "map.glsl"
#include "resume.glsl"
#include "count.glsl"
#include "radial.glsl"
#include "blend.glsl"

layout(local_size_x = GROUP_SIZE) in;
layout(constant_id = 10) const uint SLOTS = 1u;  // [pixel] integrated by one invocation

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

// [invocation] That share a packet.
const uint PACKET_LANES = LANES ? PIXELS_PER_PACKET : 1u;

// The packet's penumbra pixels that this invocation integrates.
bool is_kept[SLOTS];
// One more than the last that is. Not a constant, or drivers unroll the loops and compile for half a minute.
uint slot_end = 0u;
uint pixel_index[SLOTS];
vec2 receiver_t[SLOTS];
float receiver_d[SLOTS];
float receiver_biased[SLOTS];
vec2 receiver_plane[SLOTS];
vec2 receiver_ku[SLOTS];
vec2 receiver_kv[SLOTS];
vec2 receiver_b[SLOTS];
// [half sizes²] What each pixel adds up.
float sum[SLOTS];

// Back-projection scale of a map that is parallel to the light, which all receivers share.
vec2 kappa;

void keep_pixel(View view, Fit fit, uint slot, uint index) {
    SurfacePoint point = surface_at(pixel_at(index));
    Receiver receiver = project(view, fit, point.position - view.center, point.normal, point.error);
    receiver = at_level(view, receiver);
    is_kept[slot] = true;
    slot_end = slot + 1u;
    pixel_index[slot] = index;
    receiver_t[slot] = receiver.t;
    receiver_d[slot] = receiver.d;
    receiver_biased[slot] = receiver.biased;
    receiver_plane[slot] = receiver.plane;
    if (OBLIQUE) receiver_ku[slot] = receiver.ku;
    if (OBLIQUE) receiver_kv[slot] = receiver.kv;
    if (OBLIQUE) receiver_b[slot] = receiver.b;
    sum[slot] = is_first_round() ? 0.0 : partial[index];
}

// Makes this invocation read the level that the pass reads for a packet, whose pixels have the same two.
void choose_level(View view, uvec2 place) {
    uint index;
    if (QUALITY == QUALITY_FINEST) return;
    [[dont_unroll]] for (uint i = 0u; i < PIXELS_PER_PACKET; ++i)
        if (is_penumbra(place, i, index)) choose_level(view, index);
}

// Whether pixel `i` of a packet is integrated in the level that the pass reads.
bool is_in_level(uvec2 place, uint i, out uint index) {
    return is_penumbra(place, i, index) && share_of_level(index) > 0.0;
}

// Keeps what `lane` has to integrate of the packet at a place of the grid. False: that is nothing.
bool keep_pixels(View view, Fit fit, uvec2 place, uint lane) {
    kappa = fit.near / (fit.focal * view.half_size) * float(1 << level_of_quality);
    uint index;
    if (LANES) {
        bool wanted = is_in_level(place, lane, index);
        if (wanted) keep_pixel(view, fit, 0u, index);
        return wanted;
    }
    // Unrolled, it would be most of what drivers compile.
    [[dont_unroll]] for (uint i = 0u; i < SLOTS; ++i) {
        is_kept[i] = false;
        if (is_in_level(place, i, index)) keep_pixel(view, fit, i, index);
    }
    return QUALITY == QUALITY_FINEST || slot_end > 0u;
}

Receiver receiver_of(uint slot) {
    Receiver receiver = Receiver(receiver_t[slot], receiver_d[slot], receiver_biased[slot], receiver_plane[slot], false,
                                 vec2(kappa.x, 0.0), vec2(0.0, kappa.y), vec2(0.0));
    if (OBLIQUE) receiver.ku = receiver_ku[slot];
    if (OBLIQUE) receiver.kv = receiver_kv[slot];
    if (OBLIQUE) receiver.b = receiver_b[slot];
    return receiver;
}

// Adds up for each pixel over the packet's kernel from `from` on (a `Progress` of the function's own making, or all 0 at the
// beginning), to the end or as far as the budget lasts, and returns where to go on: ENDED if there is nothing left. agreed:
// no, if the packet's pixels have to be integrated one by one instead.
Progress sum_kernel(View view, Packet packet, Progress from, out bool agreed);

// What a pixel's sum over all edges says.
void conclude(View view, uint slot) {
    float hidden = sum[slot] + centre_area(view, receiver_of(slot), 0u);
    add_occluded(pixel_index[slot], share_of_level(pixel_index[slot]) * view.weight * share_of(hidden, view.area));
}

// Whether `lane` is the first of a packet's that has a pixel to integrate, and counts for all.
bool is_leader(uvec2 place, uint lane) {
    bool first = true;
    uint index;
    for (uint i = 0u; i < lane; ++i) first = first && !is_in_level(place, i, index);
    return first;
}

void main() {
    uint group = gl_WorkGroupID.y * GROUPS_PER_ROW + gl_WorkGroupID.x;
    uint lane = gl_LocalInvocationID.x % PACKET_LANES;
    uint in_group = gl_LocalInvocationID.x / PACKET_LANES;
    uint entry = group * packets_per_group() + in_group;
    // Each lane has a progress of its own: they may be out of budget at different nodes.
    uint at = entry * PACKET_LANES + lane;
    if (in_group >= packets_per_group() || entry >= lists[view_index()].packet_count) return;
    if (is_finished(at)) return;
    View view = views[view_index()];
    Packet packet = packets[entry];
    uvec2 place = uvec2(packet.index % packet_grid().x, packet.index / packet_grid().x);
    choose_level(view, place);
    if (!keep_pixels(view, fits[view_index()], place, lane)) return;
    packet = at_level(view, packet);

    bool agreed;
    Progress next = sum_kernel(view, packet, resumed(at), agreed);

    bool complete = agreed && next.next == FINISHED;
    bool suspended = agreed && !complete && !is_last_round();
    for (uint i = 0u; i < slot_end; ++i) {
        if (!is_kept[i]) continue;
        if (suspended) partial[pixel_index[i]] = sum[i];
        else if (complete) conclude(view, i);
        else append_pixel(pixel_index[i] | left_to_list());
    }
    if (suspended) reach_packets(push.level + 1u, group);
    if (!suspended) next = ENDED;
    keep_progress(at, next);
    if (COUNT && (!LANES || is_leader(place, lane))) {
        count_work();
        if (!suspended && !complete) atomicAdd(counters.reprocessed_packets, 1u);
    }
}
