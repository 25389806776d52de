#version 460
#extension GL_GOOGLE_include_directive : require
// The picture: each light's unshadowed irradiance times its visibility, on a diffuse surface, tone-mapped [Reinhard 2002,
// eq. 4] and sRGB-encoded.
#include "pass.glsl"
readonly BUFFER(lights);
readonly BUFFER(corners);
#include "irradiance.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(frame);
readonly BUFFER(exposure);
TEXTURE(albedo);
readonly BUFFER(visibility);
writeonly BUFFER(picture);

#include "surface.glsl"
#include "shading.glsl"

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    uint index = index_of(pixel);
    SurfacePoint point = surface_at(pixel);
    vec3 color = vec3(0.0);
    if (point.exists) color = shaded(point.position, point.normal, texelFetch(albedo, ivec2(pixel), 0).rgb, index);
    picture[index] = packUnorm4x8(vec4(encoded(toned(color)), 1.0));
}
