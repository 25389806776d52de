// Reading coarser levels of the shadow map (coarse_map.glsl) at the level that an invocation works with.

#include "coarse_map.glsl"

readonly BUFFER(coarse_map);

// [level] At which the map is read: 0 = its own texels. And the map's side.
int level_of_quality = 0;
uint coarse_map_size = 0u;

bool reads_coarse_map() { return QUALITY != QUALITY_FINEST && level_of_quality > 0; }

// Depth bounds of a texel of a level; empty beyond the map.
vec2 coarse_texel(ivec2 place, int level) {
    ivec2 texel = place - coarse_margin(level);
    bool inside = all(lessThan(uvec2(texel), uvec2(coarse_side(level, coarse_map_size))));
    vec2 bounds = coarse_map[inside ? coarse_index(texel, level, coarse_map_size) : 0u];
    return inside ? bounds : vec2(0.0);
}

// Depth bounds of the samples at the corners of 2^level × 2^level cells of the level that is read, from a multiple of 2^level on.
vec2 coarse_bounds(ivec2 cell, int level) {
    vec2 bounds = vec2(1e30, 0.0);
    [[unroll]] for (int i = 0; i < 4; ++i) {
        vec2 texel = coarse_texel((cell >> level) + ivec2(i & 1, i >> 1), level_of_quality + level);
        bounds = vec2(min(bounds.x, texel.x), max(bounds.y, texel.y));
    }
    return bounds;
}
