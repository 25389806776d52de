#version 460
#extension GL_GOOGLE_include_directive : require
// The g-buffer: position and geometric normal of the visible side, and the colour where the frame is
// shaded [Yang09 alg. 1, step 1]. A position is where the pixel's ray meets the triangle's plane: interpolating corners would
// round to the grid of the farthest of them, and a ground of kilometres would tremble under a thing of centimetres.
#include "pass.glsl"
#include "texture.glsl"

layout(constant_id = 30) const bool ORTHOGRAPHIC = false;  // the camera's rays are parallel
layout(constant_id = 59) const bool MULTISAMPLED = false;  // pixels have four samples

readonly BUFFER(frame);

layout(location = 0) flat in vec4 plane;
layout(location = 1) flat in vec2 z_range;
layout(location = 2) in vec2 uv;
layout(location = 3) flat in uint surface_index;
layout(location = 4) in vec3 color;  // [0, 1] linear

layout(location = 0) out vec4 position_world;  // [scene units] relative to the eye; w = 1
layout(location = 1) out vec4 normal_world;    // unit vector towards the camera's side; w = 0
layout(location = 2) out vec4 albedo;          // [0, 1] linear

vec3 linear_of(vec3 srgb) {
    return mix(srgb / 12.92, pow((srgb + 0.055) / 1.055, vec3(2.4)), greaterThan(srgb, vec3(0.04045)));
}

// [pixel] Vulkan's standard places of four samples; their middle is the pixel's.
const vec2 SAMPLE_PLACES[4] = vec2[4](vec2(0.375, 0.125), vec2(0.875, 0.375), vec2(0.125, 0.625), vec2(0.625, 0.875));

// [pixel] Where the triangle is looked at: in the pixel's middle, or in that of those of its samples that the triangle covers.
// DEVIATION [Schwarz08 §7]: there all samples are taken in the pixel's middle. A plane that goes on beyond its triangle may lie
// below the surface that begins there, and be in its shadow.
vec2 place_in_window() {
    if (!MULTISAMPLED) return gl_FragCoord.xy;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i)
        if ((gl_SampleMaskIn[0] >> i & 1) != 0) sum += vec3(SAMPLE_PLACES[i], 1.0);
    return floor(gl_FragCoord.xy) + sum.xy / max(sum.z, 1.0);
}

// Where the ray through that place meets the plane. Seen edge-on the plane says nothing, so that the triangle's
// corners bound it.
vec3 position_on_ray() {
    vec2 window = 2.0 * place_in_window() / vec2(frame.size) - 1.0;
    vec3 aside = frame.right * (window.x / dot(frame.right, frame.right)) - frame.up * (window.y / dot(frame.up, frame.up));
    vec3 start = ORTHOGRAPHIC ? aside : vec3(0.0);
    vec3 direction = ORTHOGRAPHIC ? frame.forward : frame.forward + aside;
    float along = dot(plane.xyz, direction);
    float z = along == 0.0 ? z_range.x : (plane.w - dot(plane.xyz, start)) / along;
    return start + direction * clamp(z, max(z_range.x, frame.near), max(z_range.y, frame.near));
}

void main() {
    Surface surface = surfaces[surface_index];
    bool front = (ORTHOGRAPHIC ? dot(plane.xyz, frame.forward) : plane.w) < 0.0;
    if (!front && surface.double_sided == 0u) discard;
    if (TEXTURED && is_hole(surface, uv)) discard;
    position_world = vec4(position_on_ray(), 1.0);
    normal_world = vec4(front ? plane.xyz : -plane.xyz, 0.0);
    vec3 texel = TEXTURED ? linear_of(texture_at(surface, uv).rgb) : vec3(1.0);
    albedo = vec4(texel * color * surface.base_color.rgb, 1.0);
}
