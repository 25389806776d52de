#version 460
#extension GL_GOOGLE_include_directive : require
// Hard shadows: the nearest sample decides [Williams78].
#include "pass.glsl"
#include "depth.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

layout(binding = 0, scalar) readonly buffer FrameBlock { Frame frame; };
layout(binding = 1, scalar) readonly buffer Views { View views[]; };
layout(binding = 2, scalar) readonly buffer Fits { Fit fits[]; };
layout(binding = 3) uniform texture2D position_world;
layout(binding = 4) uniform texture2D normal_world;
layout(binding = 5) uniform texture2D shadow_map;
layout(binding = 6, scalar) buffer Occlusion { float occlusion[]; };

bool is_hidden(View view, Fit fit, vec3 to_point, vec3 normal) {
    if (fit.level_count == 0u) return false;
    Receiver receiver = project(view, fit, to_point, normal);
    ivec2 texel = ivec2(floor(clamp(receiver.t, vec2(-2.0), vec2(view.map_size + 1u)) + 0.5));
    if (any(greaterThanEqual(uvec2(texel), uvec2(view.map_size)))) return false;
    return texelFetch(shadow_map, texel, 0).x > receiver.biased;
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    uint index = pixel.y * frame.size.x + pixel.x;
    View view = views[push.index];
    vec4 position = texelFetch(position_world, ivec2(pixel), 0);
    vec3 normal = texelFetch(normal_world, ivec2(pixel), 0).xyz;
    vec3 to_point = position.xyz - view.center;
    bool hidden = position.w > 0.0 && in_view(view, to_point, normal)
               && is_hidden(view, fits[push.index], to_point, normal);
    float occluded = hidden ? view.weight : 0.0;
    if (!ACCUMULATE) occlusion[index] = occluded;
    else if (hidden) occlusion[index] += occluded;
}
