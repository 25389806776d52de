#version 460
#extension GL_GOOGLE_include_directive : require
// The picture: each light's unshadowed irradiance (Lambert's polygon formula, clipped to the horizon)
// times its visibility, on a diffuse surface, tone-mapped and sRGB-encoded.
#include "pass.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

layout(binding = 0, scalar) readonly buffer FrameBlock { Frame frame; };
layout(binding = 1, scalar) readonly buffer Lights { Light lights[]; };
layout(binding = 2, scalar) readonly buffer ExposureBlock { Exposure exposure; };
layout(binding = 3) uniform texture2D position_world;
layout(binding = 4) uniform texture2D normal_world;
layout(binding = 5) uniform texture2D albedo;
layout(binding = 6, scalar) readonly buffer Visibility { float visibility[]; };
layout(binding = 7, scalar) writeonly buffer Picture { uint picture[]; };

// A disc is integrated as a polygon of as many corners and of the same area: off by less than 1e-3.
const uint DISC_CORNERS = 32u;
const float PI = 3.14159265;

vec3 corner_of(Light light, uint i) {
    if (light.round == 0u) {
        vec2 q = vec2(i == 0u || i == 3u ? -1.0 : 1.0, i < 2u ? -1.0 : 1.0) * light.half_size;
        return light.center + q.x * light.u + q.y * light.v;
    }
    float step = 2.0 * PI / float(DISC_CORNERS);
    vec2 q = light.half_size * sqrt(step / sin(step)) * vec2(cos(step * float(i)), sin(step * float(i)));
    return light.center + q.x * light.u + q.y * light.v;
}

// Angle of the arc from a to b times the component of its plane's normal along `normal`.
float edge_factor(vec3 a, vec3 b, vec3 normal) {
    a = normalize(a);
    b = normalize(b);
    vec3 across = cross(a, b);
    float sine = length(across);
    return sine < 1e-7 ? 0.0 : dot(across, normal) / sine * atan(sine, dot(a, b));
}

// Irradiance over radiance, [0, π].
float form_factor(Light light, vec3 position, vec3 normal) {
    uint corners = light.round == 0u ? 4u : DISC_CORNERS;
    float sum = 0.0;
    vec3 leaves = vec3(0.0);
    vec3 enters = vec3(0.0);
    vec3 a = corner_of(light, corners - 1u) - position;
    float above_a = dot(a, normal);
    for (uint i = 0u; i < corners; ++i) {
        vec3 b = corner_of(light, i) - position;
        float above_b = dot(b, normal);
        vec3 crossing = mix(a, b, above_a / (above_a - above_b));
        if (above_a > 0.0 && above_b > 0.0) sum += edge_factor(a, b, normal);
        else if (above_a > 0.0) { sum += edge_factor(a, crossing, normal); leaves = crossing; }
        else if (above_b > 0.0) { sum += edge_factor(crossing, b, normal); enters = crossing; }
        a = b;
        above_a = above_b;
    }
    if (leaves != enters) sum += edge_factor(leaves, enters, normal);
    return 0.5 * abs(sum);
}

// A point light: 1 / distance², as radiance then stands for intensity.
float point_factor(Light light, vec3 position, vec3 normal) {
    vec3 way = light.center - position;
    float square = max(dot(way, way), 1e-30);
    return max(dot(way, normal), 0.0) / (square * sqrt(square));
}

vec3 encoded(vec3 color) {
    // Extended Reinhard [Reinhard 2002, eq. 4] on the brightest channel, white at 4: hues are kept.
    float peak = max(max(color.r, color.g), max(color.b, 1e-6));
    color *= (1.0 + peak / 16.0) / (1.0 + peak);
    color = clamp(color, 0.0, 1.0);
    return mix(12.92 * color, 1.055 * pow(color, vec3(1.0 / 2.4)) - 0.055, greaterThan(color, vec3(0.0031308)));
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    uint index = pixel.y * frame.size.x + pixel.x;
    vec4 position = texelFetch(position_world, ivec2(pixel), 0);
    vec3 normal = texelFetch(normal_world, ivec2(pixel), 0).xyz;
    vec3 color = vec3(0.0);
    if (position.w > 0.0) {
        vec3 light_sum = vec3(exposure.ambient);
        for (uint i = 0u; i < exposure.light_count; ++i) {
            float seen = visibility[i * frame.size.x * frame.size.y + index];
            if (!(seen > 0.0)) continue;
            Light light = lights[i];
            bool point = light.half_size == vec2(0.0);
            float factor = point ? point_factor(light, position.xyz, normal) : form_factor(light, position.xyz, normal) / PI;
            light_sum += seen * factor * light.radiance;
        }
        color = texelFetch(albedo, ivec2(pixel), 0).rgb * light_sum * exposure.scale;
    }
    picture[index] = packUnorm4x8(vec4(encoded(color), 1.0));
}
