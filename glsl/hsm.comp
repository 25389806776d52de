#version 460
#extension GL_GOOGLE_include_directive : require
// One level of the hierarchical shadow map [DU07]: level 1 from 2×2 texels of the shadow map, every other level
// from 2×2 nodes of the one below. What lies beyond the map is empty. Bounds are exact.
#include "pass.glsl"
#include "hsm.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(views);
readonly BUFFER(fits);
TEXTURE(shadow_map);
IMAGE(hsm, rg32f);

vec2 below(ivec2 node, int level, uint map_size) {
    if (any(greaterThanEqual(node, ivec2(level > 0 ? hsm_side(level, map_size) : int(map_size))))) return vec2(0.0);
    if (level == 0) return texelFetch(shadow_map, node, 0).xx;
    return imageLoad(hsm, ivec3(node.x, node.y + hsm_row(level, map_size), 0)).xy;
}

void main() {
    uint map_size = views[push.index].map_size;
    int level = int(push.level);
    ivec2 node = ivec2(gl_GlobalInvocationID.xy);
    // A view without casters is not read.
    if (fits[push.index].level_count == 0u || any(greaterThanEqual(node, ivec2(hsm_side(level, map_size))))) return;
    vec2 a = below(2 * node, level - 1, map_size);
    vec2 b = below(2 * node + ivec2(1, 0), level - 1, map_size);
    vec2 c = below(2 * node + ivec2(0, 1), level - 1, map_size);
    vec2 d = below(2 * node + ivec2(1, 1), level - 1, map_size);
    vec2 bounds = vec2(min(min(a.x, b.x), min(c.x, d.x)), max(max(a.y, b.y), max(c.y, d.y)));
    imageStore(hsm, ivec3(node.x, node.y + hsm_row(level, map_size), 0), vec4(bounds, 0.0, 0.0));
}
