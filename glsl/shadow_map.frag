#version 460
#extension GL_GOOGLE_include_directive : require
// The holes of alpha-masked casters. Opaque casters are drawn without a fragment shader.
#include "pass.glsl"

layout(binding = 5, scalar) readonly buffer Surfaces { Surface surfaces[]; };
layout(binding = 6, scalar) readonly buffer Texels { uint texels[]; };
#include "texture.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint surface_index;

void main() {
    if (is_hole(surfaces[surface_index], uv)) discard;
}
