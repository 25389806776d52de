#version 460
#extension GL_GOOGLE_include_directive : require
// A view's projection as a matrix, for hosts that draw its casters with pipelines of their own: what shadow_map.vert
// computes (algorithm.md §1). One invocation.
#include "pass.glsl"
#include "side_by_side.glsl"

layout(local_size_x = 1) in;

readonly BUFFER(views);
readonly BUFFER(fits);
writeonly BUFFER(projections);

void main() {
    View view = views[view_index()];
    Fit fit = fits[view_index()];
    float scale = 2.0 / float(view.map_size);
    // Rows, each times (x − center).
    vec3 x = scale * (fit.focal.x * view.right + (fit.center.x + 0.5) * view.forward) - view.forward;
    vec3 y = scale * (fit.focal.y * view.up + (fit.center.y + 0.5) * view.forward) - view.forward;
    vec3 w = view.forward;
    vec4 moved = vec4(-dot(x, view.center), -dot(y, view.center), fit.near, -dot(w, view.center));
    projections[view_index()].clip_from_world[0] = vec4(x.x, y.x, 0.0, w.x);
    projections[view_index()].clip_from_world[1] = vec4(x.y, y.y, 0.0, w.y);
    projections[view_index()].clip_from_world[2] = vec4(x.z, y.z, 0.0, w.z);
    projections[view_index()].clip_from_world[3] = moved;
}
