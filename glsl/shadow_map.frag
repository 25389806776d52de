#version 460
#extension GL_GOOGLE_include_directive : require
// The holes of alpha-masked casters, and what is peeled away in front of the next layer. Opaque casters of the first
// layer are drawn without a fragment shader.
#include "pass.glsl"

layout(binding = 5, scalar) readonly buffer Surfaces { Surface surfaces[]; };
layout(binding = 6, scalar) readonly buffer Texels { uint texels[]; };
layout(binding = 7) uniform texture2DArray layers;
#include "texture.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint surface_index;

void main() {
    if (MASKED && is_hole(surfaces[surface_index], uv)) discard;
    // `push.level` counts the layers that are drawn; the same triangle has the same depth each time.
    if (PEEL && gl_FragCoord.z >= texelFetch(layers, ivec3(gl_FragCoord.xy, push.level - 1u), 0).x) discard;
}
