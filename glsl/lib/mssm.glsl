// The dual-grid multi-scale shadow map [SS07, Yang09 §4.2; algorithm.md §4]: level l, texel (i, j) holds the least and the
// largest depth over the cells [i, i + 2^l) × [j, j + 2^l). What lies beyond the map is empty: depth 0. Needs quadtree.glsl.

TEXTURE(mssm);

vec2 mssm_fetch(ivec2 cell, int level, int size) {
    ivec2 held = min(cell, ivec2(size - 1));
    vec2 bounds = texelFetch(mssm, ivec3(held, level), 0).xy;
    return cell == held ? bounds : vec2(0.0);
}

// Depth bounds over the cells first … last (inclusive, inside the map), from squares of one level that
// overlap: exact for a level up to the smaller side; wider than asked only where the sides differ by
// more than a factor of 8, or where the level is not built.
vec2 mssm_query(ivec2 first, ivec2 last, int level_count, int size) {
    ivec2 side = last - first + 1;
    int level = max(findMSB(min(side.x, side.y)), level_covering(max(side.x, side.y)) - 3);
    level = min(level, level_count - 1);
    int step = 1 << level;
    vec2 bounds = vec2(1e30, 0.0);
    for (int y = first.y;; y += step) {
        int row = clamp(y, first.y, max(last.y - step + 1, first.y));
        for (int x = first.x;; x += step) {
            int column = clamp(x, first.x, max(last.x - step + 1, first.x));
            vec2 node = mssm_fetch(ivec2(column, row), level, size);
            bounds = vec2(min(bounds.x, node.x), max(bounds.y, node.y));
            if (x + step > last.x) break;
        }
        if (y + step > last.y) break;
    }
    return bounds;
}
