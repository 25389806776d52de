#version 460
#extension GL_GOOGLE_include_directive : require
// A level of the receiver pyramid (receiver_pyramid.glsl): level 1 from 2×2 texels of the receiver map, every other level from 2×2
// nodes of the one below. The farthest is beyond all depths and the nearest 0 where there is no receiver.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "receiver_pyramid.glsl"
#include "bounds.glsl"
#include "casting.glsl"
#include "soft_shadow_map.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(views);
readonly BUFFER(fits);
TEXTURE(receiver_map);
IMAGE(receiver_pyramid, rg32f);

const vec2 NOTHING = vec2(1e30, 0.0);

vec2 bounds_at(ivec2 texel) {
    float depth = receiver_of(texelFetch(receiver_map, texel, 0).x);
    return depth > 0.0 ? vec2(depth) : NOTHING;
}

vec2 below(ivec2 node, int level, uint map_size) {
    int side = level > 0 ? pyramid_side(level, map_size) : int(map_size);
    if (any(greaterThanEqual(node, ivec2(side)))) return NOTHING;
    if (level == 0) return bounds_at(node);
    return imageLoad(receiver_pyramid, ivec3(node.x, node.y + pyramid_row(level, map_size), 0)).xy;
}

void main() {
    uint map_size = views[view_index()].map_size;
    int level = int(push.level);
    ivec2 node = ivec2(gl_GlobalInvocationID.xy);
    // A view without casters is not read.
    if (fits[view_index()].level_count == 0u || any(greaterThanEqual(node, ivec2(pyramid_side(level, map_size))))) return;
    vec2 bounds = NOTHING;
    [[unroll]] for (int i = 0; i < 4; ++i) {
        vec2 child = below(2 * node + ivec2(i & 1, i >> 1), level - 1, map_size);
        bounds = vec2(min(bounds.x, child.x), max(bounds.y, child.y));
    }
    imageStore(receiver_pyramid, ivec3(node.x, node.y + pyramid_row(level, map_size), 0), vec4(bounds, 0.0, 0.0));
}
