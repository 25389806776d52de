// Samples of the shadow map: reverse-Z depths d = near / z, 0 where it is empty (algorithm.md §1).

TEXTURE(shadow_map);

// The sample of a view's map at a texel inside it.
float sample_of(uint view, ivec2 texel) { return texelFetch(shadow_map, ivec3(texel, slot_of(view)), 0).x; }
