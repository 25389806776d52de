#version 460
#extension GL_GOOGLE_include_directive : require
// The picture of pixels of several samples, with one visibility each [Schwarz08 §7]: samples are shaded, tone-mapped and averaged. A
// sample whose depth is not that of its pixel takes the visibility of the pixel or neighbour whose depth is nearest to its own.
#include "pass.glsl"
readonly BUFFER(lights);
readonly BUFFER(corners);
#include "irradiance.glsl"
#include "samples.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(constant_id = 58) const bool NEIGHBOUR_VISIBILITY = true;  // otherwise a sample has its own pixel's

readonly BUFFER(frame);
readonly BUFFER(exposure);
readonly BUFFER(visibility);
writeonly BUFFER(picture);

#include "surface.glsl"
#include "shading.glsl"

// [share of the depth] Samples that differ by no more are of one surface (τ in the paper).
const float SAME_DEPTH = 0.01;

const ivec2 NEIGHBOURS[5] = ivec2[5](ivec2(0), ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1));

// [scene units] Along the camera's axis.
float camera_depth(vec3 position) { return dot(position, frame.forward); }

// The pixel whose visibility a sample at this depth takes.
uvec2 pixel_for(ivec2 pixel, float depth) {
    ivec2 nearest = pixel;
    float least = 1e30;
    for (int i = 0; i < (NEIGHBOUR_VISIBILITY ? 5 : 1); ++i) {
        ivec2 candidate = pixel + NEIGHBOURS[i];
        if (any(greaterThanEqual(uvec2(candidate), frame.size))) continue;
        SurfacePoint point = surface_at(uvec2(candidate));
        float off = point.exists ? abs(camera_depth(point.position) - depth) : 1e30;
        if (off < least) nearest = candidate;
        least = min(least, off);
        if (i == 0 && off <= SAME_DEPTH * depth) break;
    }
    return uvec2(nearest);
}

// The samples that begin a run of one position, a bit each. Two triangles have different ones, for they cover different samples.
uint runs_of(ivec2 pixel) {
    uint starts = 1u;
    vec4 before = texelFetch(position_samples, pixel, 0);
    for (int i = 1; i < SAMPLES; ++i) {
        vec4 position = texelFetch(position_samples, pixel, i);
        starts |= uint(position != before) << i;
        before = position;
    }
    return starts;
}

// Tone-mapped.
vec3 color_of(ivec2 pixel, int i) {
    vec4 position = texelFetch(position_samples, pixel, i);
    if (position.w == 0.0) return vec3(0.0);
    vec3 normal = texelFetch(normal_samples, pixel, i).xyz;
    vec3 albedo = texelFetch(albedo_samples, pixel, i).rgb;
    return toned(shaded(position.xyz, normal, albedo, index_of(pixel_for(pixel, camera_depth(position.xyz)))));
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    vec3 sum = vec3(0.0);
    // Most pixels see one triangle, and are shaded once.
    for (uint starts = runs_of(ivec2(pixel)); starts != 0u;) {
        int first = findLSB(starts);
        starts &= starts - 1u;
        int end = starts != 0u ? findLSB(starts) : SAMPLES;
        sum += float(end - first) * color_of(ivec2(pixel), first);
    }
    picture[index_of(pixel)] = packUnorm4x8(vec4(encoded(sum / float(SAMPLES)), 1.0));
}
