#version 460
#extension GL_GOOGLE_include_directive : require
// A level of microrects (microrect.glsl) from the one below, greedily [Schwarz08 §5.2]. Of 2×2 below, the first keeps its reference
// point. It is joined with its right and its upper neighbour where these are no farther in depth than from the next that keeps its
// own, and with the one between them if it holds it by then; then with those before it that have been joined with none. The two
// passes of the paper are one: what the first has decided about others is found out again.
// No occluding texel is outside of all microrects.
// DEVIATION [Schwarz08 §5.2]: what is empty has no extent, so that holes of a texel are not filled.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "coarse_map.glsl"
#include "microrect.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(views);
readonly BUFFER(fits);
#include "shadow_map.glsl"

// [texel] Of the map, first and last; depth 0: nothing.
struct Rect {
    float depth;
    ivec2 first;
    ivec2 last;
};

Rect rect_at(ivec2 at, int level, uint map_size) {
    int side = level > 0 ? coarse_side(level, map_size) : int(map_size);
    Rect rect = Rect(0.0, at << level, at << level);
    if (any(greaterThanEqual(uvec2(at), uvec2(side)))) return rect;
    if (level == 0) {
        rect.depth = sample_of(view_index(), at);
        return rect;
    }
    Microrect found = microrects[coarse_index(at, level, map_size)];
    return Rect(found.depth, rect.first + offset_of(found.first), rect.last + offset_of(found.last));
}

Rect joined(Rect a, Rect b) {
    if (a.depth == 0.0) return b;
    if (b.depth == 0.0) return a;
    return Rect(max(a.depth, b.depth), min(a.first, b.first), max(a.last, b.last));
}

bool holds(Rect outer, Rect inner) {
    bool inside = all(lessThanEqual(outer.first, inner.first)) && all(greaterThanEqual(outer.last, inner.last));
    return inner.depth == 0.0 || (outer.depth > 0.0 && inside);
}

// What the first pass makes of a microrect, and whether it takes its right and upper neighbour and the one between them.
Rect first_pass(ivec2 at, int level, uint map_size, out bvec3 takes) {
    int below = level - 1;
    Rect own = rect_at(2 * at, below, map_size);
    Rect right = rect_at(2 * at + ivec2(1, 0), below, map_size);
    Rect upper = rect_at(2 * at + ivec2(0, 1), below, map_size);
    Rect between = rect_at(2 * at + 1, below, map_size);
    float next_right = rect_at(2 * at + ivec2(2, 0), below, map_size).depth;
    float next_upper = rect_at(2 * at + ivec2(0, 2), below, map_size).depth;
    // At the map's end there is no next one.
    bvec2 is_last = greaterThanEqual(at + 1, ivec2(coarse_side(level, map_size)));
    takes.x = is_last.x || abs(right.depth - own.depth) <= abs(right.depth - next_right);
    takes.y = is_last.y || abs(upper.depth - own.depth) <= abs(upper.depth - next_upper);
    Rect rect = own;
    if (takes.x) rect = joined(rect, right);
    if (takes.y) rect = joined(rect, upper);
    takes.z = any(is_last) || holds(rect, between);
    if (takes.z) rect = joined(rect, between);
    return rect;
}

void main() {
    uint map_size = views[view_index()].map_size;
    int level = int(push.level);
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    // A view without casters is not read.
    if (fits[view_index()].level_count == 0u || any(greaterThanEqual(at, ivec2(coarse_side(level, map_size))))) return;
    bvec3 takes;
    Rect rect = first_pass(at, level, map_size, takes);
    for (int i = 0; i < 3; ++i) {
        // The one before it in x, in y, in both.
        ivec2 before = ivec2(i != 1, i != 0);
        first_pass(at - before, level, map_size, takes);
        if (!takes[i]) rect = joined(rect, rect_at(2 * at - before, level - 1, map_size));
    }
    ivec2 reference = at << level;
    microrects[coarse_index(at, level, map_size)] =
        Microrect(rect.depth, packed_offset(rect.first - reference), packed_offset(rect.last - reference));
}
