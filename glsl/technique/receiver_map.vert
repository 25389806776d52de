#version 460
#extension GL_GOOGLE_include_directive : require
// The receiver map [Atty06 §3.1]: of what casts no shadow the depth nearest to the light, over the soft shadow map's grid. Where a
// shot tells no casters, everything receives, and of the front faces towards the light the farthest is kept: what lies nearer is
// taken for an occluder, which receives no shadow. It stores d, or 1 − d where the farthest is kept.
#include "pass.glsl"
#include "bounds.glsl"
#include "receiver.glsl"
#include "caster_position.glsl"
#include "casting.glsl"
#include "soft_shadow_map.glsl"

readonly BUFFER(views);
readonly BUFFER(fits);
readonly BUFFER(triangles);
readonly BUFFER(triangle_surfaces);
readonly BUFFER(texcoords);

layout(location = 0) out vec2 uv;
layout(location = 1) flat out uint surface_index;
layout(location = 2) flat out vec2 bias;  // depth's change over a texel to what it is moved towards the light by

void main() {
    View view = views[push.index];
    Fit fit = fits[push.index];
    uint triangle = uint(gl_VertexIndex) / 3u;
    uint vertex = triangles[triangle][uint(gl_VertexIndex) % 3u];
    vec3 p = caster_position(view, vertex);
    Grid grid = grid_of(view, fit);
    vec2 window = grid.focal * p.xy + (grid.center + 0.5) * p.z;
    vec4 position = vec4(window * (2.0 / float(view.map_size)) - p.z, TELLS_CASTERS ? fit.near : p.z - fit.near, p.z);
    // What casts is moved out of sight.
    gl_Position = TELLS_CASTERS && casts(triangle) ? vec4(0.0, 0.0, -1.0, 1.0) : position;
    if (PARALLEL) gl_Position /= gl_Position.w;
    uv = TEXTURED ? texcoords[vertex] : vec2(0.0);
    surface_index = TEXTURED ? triangle_surfaces[triangle] : 0u;
    bias = view.bias * grid.focal / fit.focal;
}
