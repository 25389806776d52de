// Samples of the shadow map: reverse-Z depths d = near / z, 0 where it is empty (algorithm.md §1).

TEXTURE(shadow_map);
TEXTURE(layers);

// The depth that a layer of the map holds: 0 is nearest to the light.
float depth_at(uint layer, ivec2 texel) {
    return LAYERS > 1u ? texelFetch(layers, ivec3(texel, layer), 0).x : texelFetch(shadow_map, texel, 0).x;
}

// The samples at a dual cell's corners, counter-clockwise from (0, 0).
vec4 depths_of(uint layer, ivec2 cell) {
    return vec4(depth_at(layer, cell), depth_at(layer, cell + ivec2(1, 0)), depth_at(layer, cell + ivec2(1, 1)),
                depth_at(layer, cell + ivec2(0, 1)));
}
