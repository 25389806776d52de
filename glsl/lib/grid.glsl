// Grids of pixels that are evaluated, tile by tile (`GRID_ROWS`).

uvec2 rows_of(uint grid) { return uvec2(GRID_ROWS >> grid * TILE_SIZE & (1u << TILE_SIZE) - 1u); }

// Row and column of a grid that a pixel of a tile is on, or else the last ones before it and the first ones after it.
uvec2 grid_before(uint grid, uvec2 pixel) { return uvec2(findMSB(rows_of(grid) & (uvec2(2u) << pixel) - 1u)); }
uvec2 grid_after(uint grid, uvec2 pixel) { return pixel + uvec2(findLSB(rows_of(grid) >> pixel)); }

// A pixel's neighbours on a grid, two to a row: the pixels around it that are on the grid. i: 0 to 3. On a row of the grid the
// two rows are one, on a column the two columns.
uvec2 grid_neighbour(uint grid, uvec2 pixel, uint i) {
    return mix(grid_before(grid, pixel), grid_after(grid, pixel), bvec2((i & 1u) != 0u, (i & 2u) != 0u));
}
