// Levels of a quadtree over cells: a node of level l covers 2^l × 2^l of them.

// The lowest level whose nodes cover `side` cells.
int level_covering(int side) { return side <= 1 ? 0 : findMSB(side - 1) + 1; }
