#version 460
#extension GL_GOOGLE_include_directive : require
// The penumbra extent of each texel of the occluder map [Atty06 §3.3]: the texels of the soft shadow map whose receivers can lose
// light to its micropatch, were all as far away as the farthest of them. That one is looked up in the receiver pyramid: of all
// texels first, then of the extent that follows from it. `push.level`: 0 = the occluder map, 1 = the map of bottoms.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "bounds.glsl"
#include "count.glsl"
#include "casting.glsl"
#include "receiver_pyramid.glsl"
#include "soft_shadow_map.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(views);
readonly BUFFER(fits);
#include "shadow_map.glsl"
TEXTURE(bottom_map);
TEXTURE(receiver_pyramid);
writeonly BUFFER(penumbra_extents);

// [lookup] Each shrinks the extent, the later ones less.
const int LOOKUPS = 3;
// [texel] By which extents are larger for rounding: the texels themselves find out what they lose.
const float ROUNDING = 1e-3;

// The depth of the farthest receiver in texels first … last, from up to 2×2 nodes.
float farthest_in(ivec2 first, ivec2 last, uint map_size) {
    int way = max(last.x - first.x, last.y - first.y);
    int level = way > 1 ? findMSB(way - 1) + 1 : 1;
    vec2 a = pyramid_fetch(receiver_pyramid, first, level, map_size);
    vec2 b = pyramid_fetch(receiver_pyramid, ivec2(last.x, first.y), level, map_size);
    vec2 c = pyramid_fetch(receiver_pyramid, ivec2(first.x, last.y), level, map_size);
    vec2 d = pyramid_fetch(receiver_pyramid, last, level, map_size);
    return min(min(a.x, b.x), min(c.x, d.x));
}

// First and last texel, of receivers at depth `far`, that the patch of `texel` at `depth` can take light from.
ivec4 extent_at(View view, Fit fit, Grid grid, ivec2 texel, float depth, float far) {
    vec4 box = light_box(view);
    vec2 spread = view.half_size * ((depth - far) / fit.near);
    vec2 lower = (vec2(texel) - 0.5 - fit.center) / fit.focal - box.zw * spread;
    vec2 upper = (vec2(texel) + 0.5 - fit.center) / fit.focal - box.xy * spread;
    float side = float(view.map_size);
    vec2 first = clamp(ceil(grid.focal * lower + grid.center - ROUNDING), vec2(0.0), vec2(side));
    vec2 last = clamp(floor(grid.focal * upper + grid.center + ROUNDING), vec2(-1.0), vec2(side - 1.0));
    return ivec4(first, last);
}

uvec2 extent_of(View view, Fit fit, ivec2 texel, float depth) {
    Grid grid = grid_of(view, fit);
    ivec4 extent = ivec4(0, 0, ivec2(view.map_size) - 1);
    float far = 0.0;
    for (int i = 0; i < LOOKUPS; ++i) {
        far = farthest_in(extent.xy, extent.zw, view.map_size);
        if (far >= depth) return NO_EXTENT;
        extent = extent_at(view, fit, grid, texel, depth, far);
        if (any(greaterThan(extent.xy, extent.zw))) return NO_EXTENT;
    }
    return uvec2(extent.x | extent.y << 16, extent.z | extent.w << 16);
}

void main() {
    View view = views[view_index()];
    Fit fit = fits[view_index()];
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(view.map_size)))) return;
    float bottom = farthest_of(texelFetch(bottom_map, texel, 0).x);
    float depth = push.level == 0u ? sample_of(view_index(), texel) : bottom;
    uvec2 extent = fit.level_count > 0u && depth > 0.0 ? extent_of(view, fit, texel, depth) : NO_EXTENT;
    penumbra_extents[uint(texel.y) * view.map_size + uint(texel.x)] = extent;
    if (COUNT && extent != NO_EXTENT) {
        uvec2 size = uvec2((extent.y & 0xffffu) - (extent.x & 0xffffu), (extent.y >> 16) - (extent.x >> 16)) + 1u;
        edges_extracted = 1u;
        samples_read = size.x * size.y;
        count_work();
    }
}
