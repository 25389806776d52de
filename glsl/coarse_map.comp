#version 460
#extension GL_GOOGLE_include_directive : require
// A coarser level of the shadow map (coarse_map.glsl): bounds of depth of 2×2 texels of the one below [Schwarz08 §3; minimum
// aggregation of §5.1, since the nearest to the light has the largest depth here].
#include "pass.glsl"
#include "side_by_side.glsl"
#include "coarse_map.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(views);
readonly BUFFER(fits);
#include "shadow_map.glsl"
BUFFER(coarse_map);

vec2 texel_below(ivec2 texel, int level, uint map_size) {
    int side = level > 0 ? coarse_side(level, map_size) : int(map_size);
    if (any(greaterThanEqual(texel, ivec2(side)))) return vec2(0.0);
    if (level == 0) return vec2(sample_of(view_index(), texel));
    return coarse_map[coarse_index(texel, level, map_size)];
}

void main() {
    uint map_size = views[view_index()].map_size;
    int level = int(push.level);
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    // A view without casters is not read.
    if (fits[view_index()].level_count == 0u || any(greaterThanEqual(texel, ivec2(coarse_side(level, map_size))))) return;
    vec2 bounds = vec2(1e30, 0.0);
    [[unroll]] for (int i = 0; i < 4; ++i) {
        vec2 below = texel_below(2 * texel + ivec2(i & 1, i >> 1), level - 1, map_size);
        bounds = vec2(min(bounds.x, below.x), max(bounds.y, below.y));
    }
    coarse_map[coarse_index(texel, level, map_size)] = bounds;
}
