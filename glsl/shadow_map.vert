#version 460
#extension GL_GOOGLE_include_directive : require
// A sub-light's shadow map, reverse-Z without a far plane: d = near / z; or 1 − d, of which the test keeps the farthest.
#include "pass.glsl"
#include "receiver.glsl"
#include "caster_position.glsl"

layout(constant_id = 48) const bool BOTTOMS = false;  // the farthest back faces are kept

readonly BUFFER(views);
readonly BUFFER(fits);
readonly BUFFER(texcoords);
readonly BUFFER(vertex_surfaces);

layout(location = 0) out vec2 uv;
layout(location = 1) flat out uint surface_index;

void main() {
    View view = views[push.index];
    vec3 p = caster_position(view, gl_VertexIndex);
    // Sample (i, j) is a texel's centre, at window position (i + ½, j + ½).
    vec2 window = fits[push.index].focal * p.xy + (fits[push.index].center + 0.5) * p.z;
    float depth = BOTTOMS ? p.z - fits[push.index].near : fits[push.index].near;
    gl_Position = vec4(window * (2.0 / float(view.map_size)) - p.z, depth, p.z);
    // Of parallel rays, what is interpolated goes with lengths in the scene.
    if (PARALLEL) gl_Position /= p.z;
    uv = TEXTURED ? texcoords[gl_VertexIndex] : vec2(0.0);
    surface_index = TEXTURED ? vertex_surfaces[gl_VertexIndex] : 0u;
}
