#version 460
#extension GL_GOOGLE_include_directive : require
// A host's shadow map as this engine's: reverse-Z without a far plane, d = near / z (algorithm.md §1), empty where the host
// says so. The host's perspective may be any from the sub-light's centre.
#include "pass.glsl"

readonly BUFFER(givens);
TEXTURE(host_map);

void main() {
    Given given = givens[push.index];
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(host_map, 0) - 1;
    if (given.mirrored != 0u) texel.x = last.x - texel.x;
    float depth = texelFetch(host_map, texel, 0).x;
    float inverse_z = (depth - given.depth_scale) / given.depth_offset;
    bool empty = depth == given.depth_empty || !(inverse_z > 0.0);
    gl_FragDepth = empty ? 0.0 : min(given.near * inverse_z, 1.0);
}
