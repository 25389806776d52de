#version 460
#extension GL_GOOGLE_include_directive : require
// Each pixel's budget of micro-occluders [Schwarz08 §4.2]: a number for all, times shares that leave less of it where quality
// matters less: of an image, towards the image's border (fig. 1-d), and where the surface's texture hides shadows (fig. 11).
#include "pass.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(constant_id = 50) const uint BUDGET = 0u;             // [micro-occluder] along a side of a kernel
layout(constant_id = 55) const float BUDGET_FALLOFF = 1.0;   // [0, 1] what is left of it at the image's border
layout(constant_id = 56) const float BUDGET_MASKING = 1.0;   // [0, 1] what is left of it where texture hides all
layout(constant_id = 57) const bool BUDGET_MAPPED = false;   // there is an image of shares

layout(binding = 56, scalar) readonly buffer budget_shares_block { float budget_shares[]; };
readonly BUFFER(frame);
writeonly BUFFER(budgets);
TEXTURE(albedo);

#include "surface.glsl"

// [pixel] Round a pixel, to both sides, in which its texture is looked at.
const int REACH = 2;
// Relative contrast from which on a texture hides as much as any.
const float FULL_CONTRAST = 0.3;

float luminance(ivec2 pixel) {
    ivec2 inside = clamp(pixel, ivec2(0), ivec2(frame.size) - 1);
    return dot(texelFetch(albedo, inside, 0).rgb, vec3(0.2126, 0.7152, 0.0722));
}

// [0, 1] How much the texture round a pixel hides: the standard deviation of its luminance over its mean.
float masking(ivec2 pixel) {
    vec2 sums = vec2(0.0);
    for (int y = -REACH; y <= REACH; ++y) {
        for (int x = -REACH; x <= REACH; ++x) {
            float value = luminance(pixel + ivec2(x, y));
            sums += vec2(value, value * value);
        }
    }
    vec2 means = sums / float((2 * REACH + 1) * (2 * REACH + 1));
    float deviation = sqrt(max(means.y - means.x * means.x, 0.0));
    return clamp(deviation / max(means.x * FULL_CONTRAST, 1e-6), 0.0, 1.0);
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    vec2 from_middle = abs(2.0 * (vec2(pixel) + 0.5) / vec2(frame.size) - 1.0);
    float budget = float(BUDGET) * mix(1.0, BUDGET_FALLOFF, max(from_middle.x, from_middle.y));
    if (BUDGET_MASKING < 1.0) budget *= mix(1.0, BUDGET_MASKING, masking(ivec2(pixel)));
    if (BUDGET_MAPPED) budget *= budget_shares[index_of(pixel)];
    budgets[index_of(pixel)] = max(budget, float(LEAST_BUDGET));
}
