// One level of the dual-grid MSSM [Yang09 §4.2; algorithm.md §4]: level 0 from the four samples of each dual cell, every
// other level from four texels of the one below, half its side apart. Who includes it says in which format bounds
// are stored, BOUNDS_FORMAT, and how they get there, `vec2 stored(vec2 bounds)`.
#include "pass.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

TEXTURE(shadow_map);
IMAGE(mssm, BOUNDS_FORMAT);

vec2 below(ivec2 cell, int size) {
    if (any(greaterThanEqual(cell, ivec2(size)))) return vec2(0.0);
    if (push.level == 0u) return texelFetch(shadow_map, cell, 0).xx;
    return imageLoad(mssm, ivec3(cell, push.level - 1u)).xy;
}

void main() {
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    int size = imageSize(mssm).x;
    if (any(greaterThanEqual(cell, ivec2(size)))) return;
    int offset = 1 << max(int(push.level) - 1, 0);
    vec2 a = below(cell, size);
    vec2 b = below(cell + ivec2(offset, 0), size);
    vec2 c = below(cell + ivec2(0, offset), size);
    vec2 d = below(cell + ivec2(offset), size);
    vec2 bounds = vec2(min(min(a.x, b.x), min(c.x, d.x)), max(max(a.y, b.y), max(c.y, d.y)));
    imageStore(mssm, ivec3(cell, push.level), vec4(stored(bounds), 0.0, 0.0));
}
