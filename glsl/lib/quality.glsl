// Levels of quality [Schwarz08 §4.2]: the finer of two whole levels of the shadow map, and how much of the coarser one is blended
// in. A pixel's level is chosen so that its kernel has no more texels of the coarser one along a side than its budget. Needs
// kernel.glsl and coarse_map.glsl.

layout(constant_id = 50) const uint BUDGET = 0u;            // [micro-occluder] along a side of a kernel; 0 = no limit
layout(constant_id = 51) const bool BUDGETS_VARY = false;   // pixels have budgets of their own
layout(constant_id = 52) const bool QUERY_GROWTH = true;    // queries hold all of what coarse texels stand for

readonly BUFFER(budgets);

// [micro-occluder] Along a side of the pixel's kernel.
float budget_of(uint pixel) { return BUDGETS_VARY ? budgets[pixel] : float(BUDGET); }

// [texel] The longer side of a kernel, the corners of its outermost cells included.
float texels_along(Cells cells) {
    ivec2 side = cells.last - cells.first + 2;
    return float(max(side.x, side.y));
}

// [level] A fractional one: 0 = the map itself.
float quality_of(Cells cells, float budget) {
    return clamp(log2(texels_along(cells) / budget), 0.0, float(COARSE_LEVELS));
}

// [level] The first whole one that keeps to the budget.
int coarse_level(Cells cells, float budget) {
    int level = 0;
    while (level < int(COARSE_LEVELS) && texels_along(cells) > budget * float(1 << level)) ++level;
    return level;
}

// The cells of a level between whose corners a kernel's cells lie, in places of the map's larger one (coarse_map.glsl).
Cells coarse_cells(Cells cells, int level) {
    // First and last corner of the kernel, in halves of a texel from the middle of a coarse one on.
    ivec2 first = 2 * (cells.first + (1 << COARSE_LEVELS)) + 1 - (1 << level);
    ivec2 last = 2 * (cells.last + 1 + (1 << COARSE_LEVELS)) + 1 - (1 << level);
    return Cells(first >> (level + 1), last >> (level + 1), cells.whole);
}

// A kernel and what the coarse texels at the corners of its coarse cells stand for, as far as that is in the map [Schwarz08 §6].
Cells grown_cells(View view, Cells cells, int level) {
    if (level == 0) return cells;
    Cells coarse = coarse_cells(cells, level);
    ivec2 first = (coarse.first << level) - (1 << COARSE_LEVELS);
    ivec2 end = ((coarse.last + 2) << level) - (1 << COARSE_LEVELS);
    return Cells(max(first, ivec2(0)), min(end - 2, ivec2(view.map_size) - 2), cells.whole);
}
