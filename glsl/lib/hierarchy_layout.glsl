// Where nodes of the hierarchy stand, in the map and in its image (`Density` of the host): dense levels below one another, then,
// side by side, those of ever larger spacing. Where all are dense, each has a layer. Needs quadtree.glsl.

layout(constant_id = 26) const uint DENSE_LEVELS = 0u;  // [level] the last whose nodes stand at every cell
layout(constant_id = 27) const uint SPARSEST = 0u;      // [log2 cell] largest spacing of nodes

// [log2 cell] How far apart a level's nodes stand.
int spacing_log2(int level) { return clamp(level - int(DENSE_LEVELS), 0, int(SPARSEST)); }

// A cell, or the nearest one before it where a node of the level begins.
ivec2 aligned(ivec2 cell, int level) { return cell >> spacing_log2(level) << spacing_log2(level); }

// [cell] Side of what the hierarchy covers: the map, up to a whole number of the largest spacing.
int covered_side(View view) {
    int top = spacing_log2(int(view.levels_max) - 1);
    return (int(view.map_size) + (1 << top) - 1) >> top << top;
}

// [texel] Where a level's nodes begin in the image, and in which layer.
ivec3 level_origin(int level, int side) {
    int spacing = spacing_log2(level);
    if (SPARSEST == 0u) return ivec3(0, 0, level);
    if (spacing == 0) return ivec3(0, level * side, 0);
    ivec3 origin = ivec3(side - (2 * side >> spacing), (int(DENSE_LEVELS) + 1) * side, 0);
    // Levels that are as sparse as any: rows of them below the others.
    int further = level - int(DENSE_LEVELS + SPARSEST) - 1;
    ivec2 place = ivec2(further & ((1 << SPARSEST) - 1), further >> SPARSEST) * (side >> SPARSEST);
    return further < 0 ? origin : ivec3(place.x, origin.y + (side >> 1) + place.y, 0);
}

// [texel] The node of a level that begins at a cell, where there is one, in the image, and its layer. slot: of the view.
ivec3 node_at(View view, uint slot, ivec2 cell, int level) {
    uint layers = SPARSEST == 0u ? view.levels_max : 1u;
    return level_origin(level, covered_side(view)) + ivec3(cell >> spacing_log2(level), slot * layers);
}
