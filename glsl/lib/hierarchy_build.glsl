// Levels of the hierarchy over the shadow map (hierarchy.glsl), two at once: levels 0 and 1 from the samples at the corners of their
// cells, every other pair from 4 and from 16 nodes of the level below. Who includes it says in which format bounds are stored,
// BOUNDS_FORMAT, and how they get there, `vec2 stored(vec2 bounds)`.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "quadtree.glsl"
#include "hierarchy_layout.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(views);
readonly BUFFER(fits);
#include "shadow_map.glsl"
IMAGE(hierarchy, BOUNDS_FORMAT);

vec2 joined(vec2 a, vec2 b) { return vec2(min(a.x, b.x), max(a.y, b.y)); }

vec2 sample_at(ivec2 texel, int size) {
    return any(greaterThanEqual(texel, ivec2(size))) ? vec2(0.0) : vec2(sample_of(view_index(), texel));
}

vec2 node_below(View view, ivec2 cell, int level) {
    if (any(greaterThanEqual(cell, ivec2(covered_side(view))))) return vec2(0.0);
    return imageLoad(hierarchy, node_at(view, slot_of(view_index()), cell, level - 1)).xy;
}

void store(View view, ivec2 cell, int level, vec2 bounds) {
    imageStore(hierarchy, node_at(view, slot_of(view_index()), cell, level), vec4(stored(bounds), 0.0, 0.0));
}

// Level 0 from samples, whose corners cells share: a node has one more along a side than cells.
void build_lowest(View view, ivec2 cell, bool next) {
    vec2 bounds = vec2(1e30, 0.0);
    [[unroll]] for (int i = 0; i < 4; ++i) bounds = joined(bounds, sample_at(cell + ivec2(i & 1, i >> 1), int(view.map_size)));
    store(view, cell, 0, bounds);
    if (!next) return;
    [[unroll]] for (int i = 0; i < 3; ++i) bounds = joined(bounds, sample_at(cell + ivec2(2, i), int(view.map_size)));
    [[unroll]] for (int i = 0; i < 2; ++i) bounds = joined(bounds, sample_at(cell + ivec2(i, 2), int(view.map_size)));
    store(view, cell, 1, bounds);
}

void build(View view, ivec2 cell, int level, bool next) {
    int side = 1 << (level - 1);
    vec2 bounds = vec2(1e30, 0.0);
    [[unroll]] for (int i = 0; i < 4; ++i)
        bounds = joined(bounds, node_below(view, cell + ivec2(i & 1, i >> 1) * side, level));
    store(view, cell, level, bounds);
    if (!next) return;
    [[unroll]] for (int i = 0; i < 16; ++i) {
        ivec2 at = ivec2(i & 3, i >> 2);
        if (max(at.x, at.y) > 1) bounds = joined(bounds, node_below(view, cell + at * side, level));
    }
    store(view, cell, level + 1, bounds);
}

void main() {
    View view = views[view_index()];
    int level = int(push.level);
    uint level_count = fits[view_index()].level_count;
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy) << spacing_log2(level);
    if (push.level >= level_count || any(greaterThanEqual(cell, ivec2(covered_side(view))))) return;
    // A node of the next level that begins at the cell is built beside.
    bool next = push.level + 1u < level_count && aligned(cell, level + 1) == cell;
    if (level == 0) build_lowest(view, cell, next);
    else build(view, cell, level, next);
}
