// Levels of a quadtree over cells: a node of level l covers 2^l × 2^l of them.

// The lowest level whose nodes cover `side` cells.
int level_covering(int side) { return side <= 1 ? 0 : findMSB(side - 1) + 1; }

// The level of which a few nodes cover a box of cells: as large as fits into it, but for boxes that are longer than that
// 8 times, or `finer` levels below.
int query_level(ivec2 side, int level_count, int finer) {
    int level = max(findMSB(min(side.x, side.y)), level_covering(max(side.x, side.y)) - 3);
    return clamp(level - finer, 0, level_count - 1);
}
