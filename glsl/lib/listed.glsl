// The pixel of the pixel list that an invocation works on. Needs the bindings `frame`, `views`, `fits`,
// `position_world`, `normal_world`, `kernels`, `lists`, `rounds`, `pixels`, `shadow_map`, `layers`, `occlusion`, `progress`
// and `counters`.

#include "rounds.glsl"

struct Listed {
    uint entry;
    uint index;
    View view;
    Receiver receiver;
    // [cell] Its kernel.
    ivec2 first;
    ivec2 last;
};

uint nodes_visited = 0u;
uint edges_extracted = 0u;
uint samples_read = 0u;

// False: this invocation has nothing to do.
bool find_listed(out Listed listed) {
    listed.entry = (gl_WorkGroupID.y * GROUPS_PER_ROW + gl_WorkGroupID.x) * GROUP_SIZE + gl_LocalInvocationID.x;
    if (listed.entry >= lists[push.index].pixel_count) return false;
    listed.index = pixels[listed.entry];
    listed.view = views[push.index];
    ivec2 pixel = ivec2(listed.index % frame.size.x, listed.index / frame.size.x);
    vec3 to_point = texelFetch(position_world, pixel, 0).xyz - listed.view.center;
    vec3 normal = texelFetch(normal_world, pixel, 0).xyz;
    listed.receiver = project(listed.view, fits[push.index], to_point, normal);
    listed.first = unpacked(kernels[listed.index].first);
    listed.last = unpacked(kernels[listed.index].last);
    return is_first_round() || progress[listed.entry].next != FINISHED;
}

// The depth that a layer of the shadow map holds: 0 is nearest to the light.
float depth_at(uint layer, ivec2 texel) {
    return LAYERS > 1u ? texelFetch(layers, ivec3(texel, layer), 0).x : texelFetch(shadow_map, texel, 0).x;
}

// The samples at a cell's corners, counter-clockwise from (0, 0).
vec4 depths_of(uint layer, ivec2 cell) {
    return vec4(depth_at(layer, cell), depth_at(layer, cell + ivec2(1, 0)), depth_at(layer, cell + ivec2(1, 1)),
                depth_at(layer, cell + ivec2(0, 1)));
}

// A scan of a rectangle of cells or texels, row by row. A search stays at what it has found, and whoever has seen to
// that goes on: lavapipe loses what lanes put by in a loop that others have not left yet.
struct Scan {
    ivec2 first;
    ivec2 last;
    ivec2 at;
};

bool at_end(Scan scan) { return scan.at.y > scan.last.y; }

void advance(inout Scan scan) {
    scan.at = scan.at.x < scan.last.x ? scan.at + ivec2(1, 0) : ivec2(scan.first.x, scan.at.y + 1);
}

// Number of the place in the scans of all layers, one after the other.
uint number_of(Scan scan, uint layer) {
    uvec2 side = uvec2(scan.last - scan.first + 1);
    uvec2 at = uvec2(scan.at - scan.first);
    return (layer * side.y + at.y) * side.x + at.x;
}

// The scan of `first` … `last` at the place with a number, and the layer that the place is in.
Scan scan_at(ivec2 first, ivec2 last, uint number, out uint layer) {
    uvec2 side = uvec2(last - first + 1);
    layer = number / (side.x * side.y);
    uint rest = number % (side.x * side.y);
    return Scan(first, last, first + ivec2(rest % side.x, rest / side.x));
}

// The place at which this round begins.
uint next_number(Listed listed) { return is_first_round() ? 0u : progress[listed.entry].next; }

// Ends this round. more: something is left to do, at `next`; false, too, if there is no further round: then `render`
// fails. Returns whether the pixel is finished.
bool close_round(Listed listed, bool more, Progress next) {
    bool put_by = more && !is_last_round();
    if (put_by) REACH(rounds[at_round(push.level + 1u)].pixel_groups, listed.entry / GROUP_SIZE)
    if (more && !put_by) atomicAdd(fits[push.index].unfinished, 1u);
    if (!put_by) next.next = FINISHED;
    if (ROUNDS > 1u) progress[listed.entry] = next;
    return !more;
}

// share: of the sub-light that is occluded.
void conclude(Listed listed, float share) {
    float occluded = listed.view.weight * clamp(share, 0.0, 1.0);
    if (ACCUMULATE) occlusion[listed.index] += occluded;
    else occlusion[listed.index] = occluded;
}

void count_work() {
    if (!COUNT) return;
    COUNT_WIDE(counters.nodes_visited, nodes_visited)
    COUNT_WIDE(counters.edges_extracted, edges_extracted)
    COUNT_WIDE(counters.samples_read, samples_read)
}
