// Rectangles that stand for the texels of a map as occluders: micropatches, which are the texels, or in coarser levels microrects
// [Schwarz08 §5.2], which are where the occluders in and round a texel are. A microrect of level l belongs to the map's texel
// (x, y) · 2^l, its reference point, and ends before those of its neighbours. Needs map.glsl for reading, coarse_map.glsl for both.

layout(constant_id = 62) const bool MICRORECTS = false;  // coarser levels have microrects

struct Microrect {
    // Nearest to the light; 0 = there is none.
    float depth;
    // [texel] First and last, x | y << 16, from the reference point on; signed.
    uint first;
    uint last;
};

layout(binding = 60, scalar) buffer microrects_block { Microrect microrects[]; };

ivec2 offset_of(uint packed) { return ivec2(bitfieldExtract(int(packed), 0, 16), bitfieldExtract(int(packed), 16, 16)); }

uint packed_offset(ivec2 offset) { return uint(offset.x) & 0xffffu | uint(offset.y) << 16; }
