#version 460
#extension GL_GOOGLE_include_directive : require
// The holes of alpha-masked casters, what is peeled away in front of the next layer, and front faces where bottoms are drawn.
// Opaque casters of the first layer are drawn without a fragment shader.
#include "pass.glsl"
#include "texture.glsl"

layout(constant_id = 14) const bool PEEL = false;    // draw what lies behind the last layer
layout(constant_id = 48) const bool BOTTOMS = false;  // the farthest back faces are kept
layout(constant_id = 22) const bool MASKED = false;  // the casters drawn have holes

TEXTURE(layers);

layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint surface_index;

void main() {
    if (MASKED && is_hole(surfaces[surface_index], uv)) discard;
    if (BOTTOMS && gl_FrontFacing) discard;
    // `push.level` counts the layers that are drawn; the same triangle has the same depth each time.
    if (PEEL && gl_FragCoord.z >= texelFetch(layers, ivec3(gl_FragCoord.xy, push.level - 1u), 0).x) discard;
}
