// Samples of the shadow map, of its layers, or of what a coarser level holds.

#include "shadow_map.glsl"
TEXTURE(layers);

#include "coarse_fetch.glsl"

// The depth that a layer of the map holds: 0 is nearest to the light. Or that a texel of the level of quality that is read holds.
float depth_at(uint layer, ivec2 texel) {
    float depth = 0.0;
    if (reads_coarse_map()) depth = coarse_texel(texel, level_of_quality).y;
    else depth = LAYERS > 1u ? texelFetch(layers, ivec3(texel, layer), 0).x : sample_of(view_index(), texel);
    return depth;
}

// The samples at a dual cell's corners, counter-clockwise from (0, 0).
vec4 depths_of(uint layer, ivec2 cell) {
    return vec4(depth_at(layer, cell), depth_at(layer, cell + ivec2(1, 0)), depth_at(layer, cell + ivec2(1, 1)),
                depth_at(layer, cell + ivec2(0, 1)));
}
