#version 460
#extension GL_GOOGLE_include_directive : require
// Bounds of the visible receivers that a view has to look at (algorithm.md §10): their boxes in the face's frame and in the scene's,
// and the slopes of the four planes that enclose every line from them to the sub-light. The order of reduction does not matter.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "bounds.glsl"
#include "receiver.glsl"
#include "caster_region.glsl"

layout(local_size_x = GROUP_SIZE) in;

readonly BUFFER(frame);
readonly BUFFER(views);
BUFFER(fits);

#include "surface.glsl"

// Upper bounds of one invocation's receivers; see `Fit`.
struct Reach {
    vec3 upper;
    vec3 negated_lower;
    vec3 box_upper;
    vec3 box_negated_lower;
    vec4 slopes;
    uint count;
};

const float NONE = -1e38;

void include(inout Reach reach, View view, Box light, vec3 position) {
    vec3 p = to_face(view, mapped(view, position - view.center));
    reach.upper = max(reach.upper, p);
    reach.negated_lower = max(reach.negated_lower, -p);
    reach.box_upper = max(reach.box_upper, position);
    reach.box_negated_lower = max(reach.box_negated_lower, -position);
    reach.slopes = max(reach.slopes, slopes_to(light, p));
    ++reach.count;
}

void main() {
    View view = views[view_index()];
    Box light = box_of_light(view);
    Reach reach = Reach(vec3(NONE), vec3(NONE), vec3(NONE), vec3(NONE), vec4(NONE), 0u);
    uint stride = gl_NumWorkGroups.x * GROUP_SIZE;
    uint pixels = frame.size.x * frame.size.y;
    for (uint index = gl_GlobalInvocationID.x; index < pixels; index += stride) {
        SurfacePoint point = surface_at(pixel_at(index));
        if (point.exists && in_view(view, point.position, point.normal)) include(reach, view, light, point.position);
    }
    uint count = subgroupAdd(reach.count);
    vec3 upper = subgroupMax(reach.upper);
    vec3 negated_lower = subgroupMax(reach.negated_lower);
    vec3 box_upper = subgroupMax(reach.box_upper);
    vec3 box_negated_lower = subgroupMax(reach.box_negated_lower);
    vec4 slopes = subgroupMax(reach.slopes);
    if (count == 0u || !subgroupElect()) return;
    atomicAdd(fits[view_index()].receiver_count, count);
    for (int i = 0; i < 3; ++i) {
        atomicMax(fits[view_index()].receiver_bounds[i], bound_of(upper[i]));
        atomicMax(fits[view_index()].receiver_bounds[i + 3], bound_of(negated_lower[i]));
        atomicMax(fits[view_index()].receiver_box[i], bound_of(box_upper[i]));
        atomicMax(fits[view_index()].receiver_box[i + 3], bound_of(box_negated_lower[i]));
    }
    for (int i = 0; i < 4; ++i) atomicMax(fits[view_index()].receiver_slopes[i], bound_of(slopes[i]));
}
