#version 460
#extension GL_GOOGLE_include_directive : require
// The visible surface from a host's images: positions, or depths with the host's projection, and normals. Normals come out
// with length 1; what has no position or no normal is no surface.
#include "pass.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(constant_id = 24) const bool GIVEN_POSITIONS = false;  // a host's surface is positions rather than depths

readonly BUFFER(frame);
readonly BUFFER(host);
TEXTURE(host_surface);
TEXTURE(host_normal);
writeonly IMAGE(position_world, rgba32f);
writeonly IMAGE(normal_world, rgba32f);

// By how much a number may be off that the image holds.
float rounding_of(float number) { return host.surface_share * abs(number) + host.surface_step; }

// [scene units] What stands for a surface that is where it says; w > 0 tells that there is one.
const float EXACT = 1e-30;

// [scene units] By how much the position may be off: as the host says, or else as its image's format says.
float error_or(float found) { return max(host.position_error > 0.0 ? host.position_error : found, EXACT); }

// [scene units] The surface's position, and by how much it may be off; w = 0 where there is none.
vec4 position_at(ivec2 pixel) {
    vec4 texel = texelFetch(host_surface, pixel, 0);
    if (GIVEN_POSITIONS) {
        float error = length(vec3(rounding_of(texel.x), rounding_of(texel.y), rounding_of(texel.z)));
        return vec4(texel.xyz, texel.w > 0.0 ? error_or(error) : 0.0);
    }
    vec2 window = 2.0 * (vec2(pixel) + 0.5) / vec2(frame.size) - 1.0;
    vec4 clip = vec4(window, texel.x, 1.0);
    vec4 world = host.world_from_clip[0] * clip.x + host.world_from_clip[1] * clip.y
               + host.world_from_clip[2] * clip.z + host.world_from_clip[3] * clip.w;
    vec3 position = world.xyz / world.w;
    // How the position moves with the depth.
    vec3 way = (host.world_from_clip[2].xyz - position * host.world_from_clip[2].w) / world.w;
    float error = length(way) * rounding_of(texel.x);
    return vec4(position, texel.x == host.depth_empty ? 0.0 : error_or(error));
}

vec3 octahedral(vec2 e) {
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    vec2 folded = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
    return n.z < 0.0 ? vec3(folded, n.z) : n;
}

vec3 normal_at(ivec2 pixel) {
    vec3 texel = texelFetch(host_normal, pixel, 0).xyz;
    if (host.normal_encoding != NORMAL_SIGNED) texel = 2.0 * texel - 1.0;
    if (host.normal_encoding == NORMAL_OCTAHEDRAL) texel = octahedral(texel.xy);
    return host.normal_to_world[0] * texel.x + host.normal_to_world[1] * texel.y + host.normal_to_world[2] * texel.z;
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    vec4 position = position_at(ivec2(pixel));
    vec3 normal = normal_at(ivec2(pixel));
    // What has no direction is no surface.
    float length_squared = dot(normal, normal);
    bool surface = position.w > 0.0 && length_squared > 0.0;
    // A normal of length 1 keeps its bits.
    if (abs(length_squared - 1.0) > 1e-6) normal *= inversesqrt(length_squared);
    imageStore(position_world, ivec2(pixel), surface ? position : vec4(0.0));
    imageStore(normal_world, ivec2(pixel), surface ? vec4(normal, 0.0) : vec4(0.0));
}
