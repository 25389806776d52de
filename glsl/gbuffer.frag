#version 460
#extension GL_GOOGLE_include_directive : require
// The g-buffer: position and geometric normal of the visible side, and the colour where the frame is
// shaded [Yang09 alg. 1, step 1].
#include "pass.glsl"

layout(binding = 0, scalar) readonly buffer FrameBlock { Frame frame; };
layout(binding = 5, scalar) readonly buffer Surfaces { Surface surfaces[]; };
layout(binding = 6, scalar) readonly buffer Texels { uint texels[]; };
#include "texture.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) flat in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) flat in uint surface_index;

layout(location = 0) out vec4 position_world;  // [scene units] relative to the scene's origin; w = 1
layout(location = 1) out vec4 normal_world;    // unit vector towards the camera's side; w = 0
layout(location = 2) out vec4 albedo;          // [0, 1] linear

vec3 linear_of(vec3 srgb) {
    return mix(srgb / 12.92, pow((srgb + 0.055) / 1.055, vec3(2.4)), greaterThan(srgb, vec3(0.04045)));
}

void main() {
    Surface surface = surfaces[surface_index];
    bool front = dot(normal, frame.eye - position) > 0.0;
    if (!front && surface.double_sided == 0u) discard;
    if (TEXTURED && is_hole(surface, uv)) discard;
    position_world = vec4(position, 1.0);
    normal_world = vec4(normalize(front ? normal : -normal), 0.0);
    vec3 color = TEXTURED ? linear_of(texture_at(surface, uv).rgb) : vec3(1.0);
    albedo = vec4(color * surface.base_color.rgb, 1.0);
}
