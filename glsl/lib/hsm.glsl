// The hierarchical shadow map [DU07]: a pyramid of least and largest depths over aligned squares of 2^l texels,
// levels 1 and up. Its levels stand below one another in one image.

#define RESOURCE_hsm(AS) AS(48, texture2DArray, image2DArray, hsm)

// Levels until a single node is left.
uint hsm_levels(uint map_size) { return uint(findMSB(map_size - 1u)) + 1u; }

// [node] Side of a level.
int hsm_side(int level, uint map_size) { return (int(map_size) + (1 << level) - 1) >> level; }

// [row] Where a level begins: as if the map's side were the next power of two.
int hsm_row(int level, uint map_size) { return (1 << int(hsm_levels(map_size))) - (2 << (int(hsm_levels(map_size)) - level)); }

// Depth bounds of the node of `level` that holds `texel`; empty beyond the map.
vec2 hsm_fetch(texture2DArray hsm, ivec2 texel, int level, uint map_size) {
    ivec2 node = texel >> level;
    ivec2 held = min(node, ivec2(hsm_side(level, map_size) - 1));
    vec2 bounds = texelFetch(hsm, ivec3(held.x, held.y + hsm_row(level, map_size), 0), 0).xy;
    return node == held ? bounds : vec2(0.0);
}
