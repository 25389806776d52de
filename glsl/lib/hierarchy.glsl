// The hierarchy over a view's shadow map: a node of level l bounds the depths in the cells [x, x + 2^l) × [y, y + 2^l), cells
// of the dual grid, with samples at their corners [SS07, Yang09 §4.2; algorithm.md §4]. Structures differ in how densely a
// level's nodes stand alone: at every cell in an MSSM, side by side in an HSM [DU07], and so on (`Density`). A node's children
// are nodes as well, so one walk serves all. What lies beyond the map is empty: depth 0. Needs quadtree.glsl.

#include "hierarchy_layout.glsl"

TEXTURE(hierarchy);

// Depth bounds of the node of a level that holds a cell and begins at it or before it.
vec2 hierarchy_fetch(View view, ivec2 cell, int level) {
    return texelFetch(hierarchy, node_at(view, slot_of(view_index()), cell, level), 0).xy;
}

// Depth bounds over the cells first … last (inclusive, inside the map), from nodes of one level that cover them and may
// overlap. They reach beyond the box by less than the level's spacing on each side, and farther only where its sides differ
// by more than a factor of 8 or the level is not built.
vec2 hierarchy_query(View view, ivec2 first, ivec2 last, int level_count, int finer) {
    int level = query_level(last - first + 1, level_count, finer);
    int step = 1 << level;
    int spacing = 1 << spacing_log2(level);
    ivec2 from = aligned(first, level);
    // The last node ends at the last cell or less than a spacing beyond it.
    ivec2 to = max(aligned(last - step + spacing, level), from);
    vec2 bounds = vec2(1e30, 0.0);
    for (int y = from.y;; y = min(y + step, to.y)) {
        for (int x = from.x;; x = min(x + step, to.x)) {
            vec2 node = hierarchy_fetch(view, ivec2(x, y), level);
            bounds = vec2(min(bounds.x, node.x), max(bounds.y, node.y));
            if (x == to.x) break;
        }
        if (y == to.y) break;
    }
    return bounds;
}
