#version 460
#extension GL_GOOGLE_include_directive : require
// Bounds of casters that the host draws itself and that nothing is known of but how near they may be: the whole region of
// the lines from the sub-light to the visible receivers, which no visible shadow's caster is outside of (algorithm.md §10).
// One invocation.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "bounds.glsl"
#include "receiver.glsl"
#include "caster_region.glsl"

layout(local_size_x = 1) in;

readonly BUFFER(views);
BUFFER(fits);
readonly BUFFER(givens);

void main() {
    Fit fit = fits[view_index()];
    if (fit.receiver_count == 0u) return;
    View view = views[view_index()];
    Box light = box_of_light(view);
    vec4 slopes = slopes_of(fit);
    float far = max(value_of(fit.receiver_bounds[2], 0.0), light.upper.z);
    float near = min(givens[view_index()].near, far);
    // Along a plane the tangent changes one way: its largest value is at one of the ends.
    vec4 edge = vec4(light.upper.xy, -light.lower.xy);
    vec4 at_near = (edge + slopes * (near - light.lower.z)) / near;
    vec4 at_far = (edge + slopes * (far - light.lower.z)) / far;
    vec4 tangents = clamp(max(at_near, at_far), -TANGENT_MAX, TANGENT_MAX);
    for (int i = 0; i < 4; ++i) fits[view_index()].caster_bounds[i] = bound_of(tangents[i]);
    fits[view_index()].caster_bounds[4] = bound_of(-near);
}
