#version 460
#extension GL_GOOGLE_include_directive : require
// A light's visibility from what its views found occluded: 0 umbra … 1 lit; 0 where the surface faces
// away from the whole light, lies behind it or out of its beam; NaN where there is no surface.
#include "pass.glsl"
#include "receiver.glsl"
#include "share.glsl"
#include "facing.glsl"
#include "beam.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(frame);
readonly BUFFER(lights);
readonly BUFFER(corners);
readonly BUFFER(occlusion);
writeonly BUFFER(visibility);

#include "surface.glsl"
#include "outline.glsl"

// Whether any part of the light is in front of the surface, and the surface in front of the light, beyond rounding.
bool faces_light(Facing facing, vec3 normal) {
    Light light = facing.light;
    vec3 to_point = -facing.way;
    precise vec2 along = vec2(dot_exact(normal, light.u), dot_exact(normal, light.v)) * light.half_size;
    precise float square = along.x * along.x + along.y * along.y;
    precise float reach = light.round != 0u ? sqrt(square) : abs(along.x) + abs(along.y);
    if (is_polygon(light)) reach = polygon_reach(light, along);
    precise float rounding = HORIZON_ROUNDING * (facing.magnitude.x + facing.magnitude.y + facing.magnitude.z);
    precise float height = reach - dot_exact(normal, to_point);
    return (light.spread == SPREAD_POINT || dot_exact(to_point, light.n) > rounding) && height > rounding;
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    Light light = lights[push.index];
    SurfacePoint point = surface_at(pixel);
    uint index = index_of(pixel);
    float result = uintBitsToFloat(0x7fc00000u);
    if (point.exists) {
        result = 0.0;
        Facing facing = facing_of(light, point.position, point.normal);
        if (beam_share(light, point.position - light.center) == 0.0) result = 0.0;
        else if (facing.inside) result = 1.0;
        else if (faces_light(facing, point.normal))
            result = light.view_count == 0u ? 1.0 : 1.0 - share_of(occlusion[index], light.weight_sum);
    }
    visibility[push.index * frame.size.x * frame.size.y + index] = result;
}
