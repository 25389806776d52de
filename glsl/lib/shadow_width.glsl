// The shadow-width map [Kirsch03 §3]: of each texel of the map, how far the nearest texel is that nothing hides. Widths are
// distances on the light's plane per unit of depth: a texel's way times kappa = near / (focal · half size), so that a width over
// the difference in depth of occluder and receiver is a distance in half sizes of the sub-light (algorithm.md §1).
//
// It is built in passes that read one half of the buffer and write the other.

#define RESOURCE_shadow_widths ARRAY(49, vec2, shadow_widths)

layout(constant_id = 40) const uint NEIGHBOURS = 0u;  // 0 = three, 1 = six, 2 = by jump flooding
layout(constant_id = 41) const uint START = 64u;      // [texel] The paper's starting difference is 1 / START
layout(constant_id = 42) const uint SPREADS = 1u;     // [pass] that spread widths

const bool FLOOD = NEIGHBOURS == 2u;

// Place of a texel in the half that `written` passes have led to.
uint place_of(ivec2 texel, uint written, uint map_size) {
    return ((written & 1u) * map_size + uint(texel.y)) * map_size + uint(texel.x);
}

bool in_map(ivec2 texel, uint map_size) {
    return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(map_size)));
}

// The length of a way over the map [texel].
float width_of(View view, Fit fit, vec2 way) {
    precise vec2 scaled = way * (fit.near / (fit.focal * view.half_size));
    precise float square = scaled.x * scaled.x + scaled.y * scaled.y;
    return sqrt(square);
}
