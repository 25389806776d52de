#version 460
#extension GL_GOOGLE_include_directive : require
// The grids on which a pixel has neighbours of the same surface, from which its visibility may be joined: a bit each. Where a surface
// ends, bends or has an edge there are none.
#include "pass.glsl"
#include "receiver.glsl"
#include "grid.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(frame);
writeonly BUFFER(grids);

#include "surface.glsl"

// [share of the way] How far a point is off the plane of another one of its surface.
const float OFF_PLANE = 0.1;
// [cosine] Least between their normals.
const float ALONG_NORMAL = 0.95;

bool is_same_surface(SurfacePoint a, SurfacePoint b) {
    precise vec3 way = b.position - a.position;
    precise float off = max(abs(dot_exact(a.normal, way)), abs(dot_exact(b.normal, way)));
    precise float most = OFF_PLANE * OFF_PLANE * dot_exact(way, way);
    precise float square = off * off;
    return b.exists && square <= most && dot_exact(a.normal, b.normal) >= ALONG_NORMAL;
}

// Whether all neighbours of a pixel of a tile on a grid are of its surface, and it is none of them.
bool has_neighbours(SurfacePoint point, uvec2 tile, uvec2 in_tile, uint grid) {
    bool all_like = point.exists && grid_before(grid, in_tile) != in_tile;
    for (uint i = 0u; i < 4u; ++i) {
        uvec2 pixel = tile + grid_neighbour(grid, in_tile, i);
        bool inside = all(lessThan(pixel, frame.size));
        all_like = all_like && inside && is_same_surface(point, surface_at(min(pixel, frame.size - 1u)));
    }
    return all_like;
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    SurfacePoint point = surface_at(pixel);
    uint found = 0u;
    for (uint grid = 1u; grid <= GRID_MAX; ++grid)
        found |= uint(has_neighbours(point, gl_WorkGroupID.xy * TILE_SIZE, gl_LocalInvocationID.xy, grid)) << grid;
    grids[index_of(pixel)] = found;
}
