#version 460
#extension GL_GOOGLE_include_directive : require
// The picture: each light's unshadowed irradiance times its visibility, on a diffuse surface, tone-mapped [Reinhard 2002,
// eq. 4] and sRGB-encoded.
#include "pass.glsl"
#include "irradiance.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(frame);
readonly BUFFER(lights);
readonly BUFFER(exposure);
TEXTURE(albedo);
readonly BUFFER(visibility);
writeonly BUFFER(picture);

#include "surface.glsl"

vec3 encoded(vec3 color) {
    // Extended Reinhard on the brightest channel, white at 4: hues are kept.
    float peak = max(max(color.r, color.g), max(color.b, 1e-6));
    color *= (1.0 + peak / 16.0) / (1.0 + peak);
    color = clamp(color, 0.0, 1.0);
    return mix(12.92 * color, 1.055 * pow(color, vec3(1.0 / 2.4)) - 0.055, greaterThan(color, vec3(0.0031308)));
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    uint index = index_of(pixel);
    SurfacePoint point = surface_at(pixel);
    vec3 color = vec3(0.0);
    if (point.exists) {
        vec3 light_sum = vec3(exposure.ambient);
        for (uint i = 0u; i < exposure.light_count; ++i) {
            float seen = visibility[i * frame.size.x * frame.size.y + index];
            if (!(seen > 0.0)) continue;
            light_sum += seen * irradiance(lights[i], point.position, point.normal) / PI * lights[i].intensity;
        }
        color = texelFetch(albedo, ivec2(pixel), 0).rgb * light_sum * exposure.scale;
    }
    picture[index] = packUnorm4x8(vec4(encoded(color), 1.0));
}
