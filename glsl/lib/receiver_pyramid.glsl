// The receiver pyramid [Atty06 §3.3]: the depths of the farthest and of the nearest receiver in aligned squares of 2^l texels of
// the receiver map, levels 1 and up, which stand below one another in one image.

#define RESOURCE_receiver_pyramid(AS) AS(48, texture2DArray, image2DArray, receiver_pyramid)

// Levels until a single node is left.
uint pyramid_levels(uint map_size) { return uint(findMSB(map_size - 1u)) + 1u; }

// [node] Side of a level.
int pyramid_side(int level, uint map_size) { return (int(map_size) + (1 << level) - 1) >> level; }

// [row] Where a level begins: as if the map's side were the next power of two.
int pyramid_row(int level, uint map_size) { return (1 << int(pyramid_levels(map_size))) - (2 << (int(pyramid_levels(map_size)) - level)); }

// Depth bounds of the node of `level` that holds `texel`; empty beyond the map.
vec2 pyramid_fetch(texture2DArray pyramid, ivec2 texel, int level, uint map_size) {
    ivec2 node = texel >> level;
    ivec2 held = min(node, ivec2(pyramid_side(level, map_size) - 1));
    vec2 bounds = texelFetch(pyramid, ivec3(held.x, held.y + pyramid_row(level, map_size), 0), 0).xy;
    return node == held ? bounds : vec2(0.0);
}
