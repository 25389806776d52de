#version 460
#extension GL_GOOGLE_include_directive : require
// Bounds of the visible surface in each tile of the image, for all views: a box of positions, a box of normals, and how far the
// tangent planes are from the eye.
#include "pass.glsl"
#include "bounds.glsl"
#include "receiver.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(frame);
writeonly BUFFER(tile_bounds);

#include "surface.glsl"

// Upper bounds of position, −position, normal, −normal, height, −height, and error.
const uint BOUND_COUNT = 15u;

shared uint bounds[BOUND_COUNT];

void reduce(uint i, float value) {
    float most = subgroupMax(value);
    if (subgroupElect()) atomicMax(bounds[i], bound_of(most));
}

void reduce_range(uint i, vec3 value, bool exists) {
    const float NONE = -1e38;
    for (uint axis = 0u; axis < 3u; ++axis) {
        reduce(i + axis, exists ? value[axis] : NONE);
        reduce(i + axis + 3u, exists ? -value[axis] : NONE);
    }
}

vec3 upper_from(uint i) { return vec3(value_of(bounds[i], 0.0), value_of(bounds[i + 1u], 0.0), value_of(bounds[i + 2u], 0.0)); }

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (gl_LocalInvocationIndex < BOUND_COUNT) bounds[gl_LocalInvocationIndex] = 0u;
    barrier();
    SurfacePoint point = surface_at(min(pixel, frame.size - 1u));
    float height = dot_exact(point.normal, point.position);
    reduce_range(0u, point.position, point.exists);
    reduce_range(6u, point.normal, point.exists);
    reduce(12u, point.exists ? height : -1e38);
    reduce(13u, point.exists ? -height : -1e38);
    reduce(14u, point.exists ? point.error : 0.0);
    barrier();
    if (gl_LocalInvocationIndex > 0u) return;
    tile_bounds[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] =
        TileBounds(-upper_from(3u), upper_from(0u), -upper_from(9u), upper_from(6u), -value_of(bounds[13], 0.0),
                   value_of(bounds[12], 0.0), value_of(bounds[14], 0.0));
}
