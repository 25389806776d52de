// Levels of the hierarchy over the shadow map (hierarchy.glsl): levels 0 and 1 at once from the samples at the corners of their
// cells, every other one from four nodes of the one below. Who includes it says in which format bounds are stored,
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

// A cell, and the node of level 1 that begins at it, if one does.
void build_lowest(View view, ivec2 cell) {
    vec2 bounds = vec2(1e30, 0.0);
    [[unroll]] for (int i = 0; i < 4; ++i) bounds = joined(bounds, sample_at(cell + ivec2(i & 1, i >> 1), int(view.map_size)));
    store(view, cell, 0, bounds);
    if (view.levels_max == 1u || aligned(cell, 1) != cell) return;
    [[unroll]] for (int i = 0; i < 3; ++i) bounds = joined(bounds, sample_at(cell + ivec2(2, i), int(view.map_size)));
    [[unroll]] for (int i = 0; i < 2; ++i) bounds = joined(bounds, sample_at(cell + ivec2(i, 2), int(view.map_size)));
    store(view, cell, 1, bounds);
}

void build(View view, ivec2 cell, int level) {
    int half_side = 1 << (level - 1);
    vec2 bounds = vec2(1e30, 0.0);
    [[unroll]] for (int i = 0; i < 4; ++i)
        bounds = joined(bounds, node_below(view, cell + ivec2(i & 1, i >> 1) * half_side, level));
    store(view, cell, level, bounds);
}

void main() {
    View view = views[view_index()];
    int level = int(push.level);
    if (push.level >= fits[view_index()].level_count) return;
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy) << spacing_log2(level);
    if (any(greaterThanEqual(cell, ivec2(covered_side(view))))) return;
    if (level == 0) build_lowest(view, cell);
    else build(view, cell, level);
}
