// Coarser levels of the shadow map [Schwarz08 §3, §4]: a texel of level l ≥ 1 bounds the depths of 2^l × 2^l texels, those of
// the map from (x, y) · 2^l on; its occluder has the depth nearest to the light. The levels lie one after the other in a buffer,
// each in rows as long as if the map's side were the next power of two. The map itself is level 0.
//
// Places: so that contours close also where a coarse texel reaches the map's border, coarser levels are seen in a larger map,
// with 2^COARSE_LEVELS empty texels before the map's first. In texels of level l, a place t of the map is
// (t + 2^COARSE_LEVELS + ½) / 2^l − ½ there, so that each level halves the places of the one below as a quadtree does.

layout(constant_id = 53) const uint COARSE_LEVELS = 0u;  // [level] coarser than the map that there are

// [texel] Side of a level.
int coarse_side(int level, uint map_size) { return (int(map_size) + (1 << level) - 1) >> level; }

// Where a texel of a level stands in the buffer.
uint coarse_index(ivec2 texel, int level, uint map_size) {
    uint side = 2u << findMSB(map_size - 1u);
    uint above = side >> (level - 1);
    // The levels below take side² (¼ + 1/16 + …).
    return (side * side - above * above) / 3u + uint(texel.y) * (side >> level) + uint(texel.x);
}

// [texel of a level] Where the map begins in its larger map.
int coarse_margin(int level) { return 1 << (int(COARSE_LEVELS) - level); }

// [texel of a level] A place of the map.
vec2 coarse_place(vec2 t, int level) {
    precise vec2 place = (t + (float(1 << COARSE_LEVELS) + 0.5)) / float(1 << level) - 0.5;
    return place;
}
