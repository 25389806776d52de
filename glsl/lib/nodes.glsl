// The nodes that a walk over a packet's kernel looks at: those of the hierarchy over the map, or of the level of quality that is
// read [Yang09 §6], where a node bounds what 2×2 coarse texels do. Needs kernel.glsl and map.glsl.

#include "quadtree.glsl"
#include "hierarchy.glsl"

// [cell] Where the first root of a walk over a packet's kernel begins. Coarser levels of the map have nodes side by side.
ivec2 first_root(Packet packet, int top) {
    ivec2 first = unpacked(packet.first);
    return reads_coarse_map() ? first >> top << top : aligned(first, top);
}

// [level] Of roots that are as large as a kernel, as far as levels are built.
int root_level(Packet packet, int level_count) {
    ivec2 side = unpacked(packet.last) - unpacked(packet.first) + 1;
    int highest = reads_coarse_map() ? int(COARSE_LEVELS) - level_of_quality : level_count - 1;
    return min(level_covering(max(side.x, side.y)), highest);
}

// Depth bounds of a node that begins at a cell or before it.
vec2 bounds_of(View view, ivec2 cell, int level) {
    vec2 bounds = vec2(0.0);
    if (reads_coarse_map()) bounds = coarse_bounds(cell, level);
    else bounds = hierarchy_fetch(view, cell, level);
    return bounds;
}
