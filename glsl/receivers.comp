#version 460
#extension GL_GOOGLE_include_directive : require
// Bounds of the visible receivers that a view has to look at (algorithm.md §10): their box in the
// face's frame, and the slopes of the four planes that enclose every line from them to the sub-light.
#include "pass.glsl"
#include "bounds.glsl"
#include "depth.glsl"
#include "caster_region.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

layout(binding = 0, scalar) readonly buffer FrameBlock { Frame frame; };
layout(binding = 1, scalar) readonly buffer Views { View views[]; };
layout(binding = 2, scalar) buffer Fits { Fit fits[]; };
layout(binding = 3) uniform texture2D position_world;
layout(binding = 4) uniform texture2D normal_world;

shared uint count;
shared uint bounds[6];
shared uint slopes[4];

void include(View view, vec3 to_point) {
    vec3 p = to_face(view, to_point);
    for (int i = 0; i < 3; ++i) {
        atomicMax(bounds[i], bound_of(p[i]));
        atomicMax(bounds[i + 3], bound_of(-p[i]));
    }
    vec4 slope = slopes_to(box_of_light(view), p);
    for (int i = 0; i < 4; ++i) atomicMax(slopes[i], bound_of(slope[i]));
    atomicAdd(count, 1u);
}

void main() {
    uint lane = gl_LocalInvocationIndex;
    if (lane == 0u) count = 0u;
    if (lane < 6u) bounds[lane] = 0u;
    if (lane < 4u) slopes[lane] = 0u;
    barrier();
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, ivec2(frame.size)))) {
        View view = views[push.index];
        vec4 position = texelFetch(position_world, pixel, 0);
        vec3 normal = texelFetch(normal_world, pixel, 0).xyz;
        vec3 to_point = position.xyz - view.center;
        if (position.w > 0.0 && in_view(view, to_point, normal)) include(view, to_point);
    }
    barrier();
    if (count == 0u) return;
    if (lane == 0u) atomicAdd(fits[push.index].receiver_count, count);
    if (lane < 6u) atomicMax(fits[push.index].receiver_bounds[lane], bounds[lane]);
    if (lane < 4u) atomicMax(fits[push.index].receiver_slopes[lane], slopes[lane]);
}
