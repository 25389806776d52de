#version 460
#extension GL_GOOGLE_include_directive : require
// The surface that stands for a pixel of several samples: that of the first [Schwarz08 §7]. All passes but the shading see it alone.
#include "pass.glsl"
#include "samples.glsl"

layout(location = 0) out vec4 position_world;
layout(location = 1) out vec4 normal_world;
layout(location = 2) out vec4 albedo;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    position_world = texelFetch(position_samples, pixel, 0);
    normal_world = texelFetch(normal_samples, pixel, 0);
    albedo = texelFetch(albedo_samples, pixel, 0);
}
