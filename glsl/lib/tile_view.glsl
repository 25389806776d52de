// Whether a view has to look at a tile of the image: what `in_view` says of its receivers. Where it cannot tell, it has to. Needs
// tile_sight.glsl.

// Whether all of the tile is on the side of the plane through `at` that `direction` points away from, beyond rounding.
bool is_behind(TileBounds tile, vec3 at, vec3 direction) {
    vec3 lower = tile.lower - at;
    vec3 upper = tile.upper - at;
    float rounding = TILE_ROUNDING * dot(abs(direction), vec3(magnitude_of(tile, at)));
    return dot_range(lower, upper, direction).y < -rounding;
}

// Outside of the view's cone (cone.glsl), which four planes bound.
bool misses_cone(View view, TileBounds tile) {
    uint cell = view.cone - 1u;
    uvec2 place = uvec2(cell % CONE_SPLIT, cell / CONE_SPLIT % CONE_SPLIT);
    uint side = cell / (CONE_SPLIT * CONE_SPLIT);
    uint axis = side / 2u;
    vec3 along = vec3(0.0);
    along[axis] = (side & 1u) == 0u ? 1.0 : -1.0;
    bool misses = is_behind(tile, view.sphere.xyz, along);
    for (uint i = 0u; i < 2u; ++i) {
        vec3 across = vec3(0.0);
        across[(axis + 1u + i) % 3u] = 1.0;
        vec2 slopes = 2.0 * vec2(place[i], place[i] + 1u) / float(CONE_SPLIT) - 1.0;
        misses = misses || is_behind(tile, view.sphere.xyz, across - slopes.x * along)
              || is_behind(tile, view.sphere.xyz, slopes.y * along - across);
    }
    return misses;
}

// Outside of the view's face (`face_of`).
bool misses_face(View view, TileBounds tile) {
    vec3 u = view.light_u * view.half_size.x;
    vec3 v = view.light_v * view.half_size.y;
    vec3 border = view.reach * view.light_n;
    if (view.face == 0u)
        return is_behind(tile, view.center, border - u) || is_behind(tile, view.center, border + u)
            || is_behind(tile, view.center, border - v) || is_behind(tile, view.center, border + v);
    vec3 along = view.face <= 2u ? u : v;
    vec3 across = view.face <= 2u ? v : u;
    along *= (view.face & 1u) == 1u ? 1.0 : -1.0;
    return is_behind(tile, view.center, along - border) || is_behind(tile, view.center, along - across)
        || is_behind(tile, view.center, along + across);
}

// No part of the sub-light is in front of any of its planes.
bool faces_away(View view, TileBounds tile) {
    vec2 u = dot_range(tile.normal_lower, tile.normal_upper, view.light_u) * view.half_size.x * view.half_size.x;
    vec2 v = dot_range(tile.normal_lower, tile.normal_upper, view.light_v) * view.half_size.y * view.half_size.y;
    float reach = product_range(u, view.extent.xz).y + product_range(v, view.extent.yw).y;
    return height_range(view, tile).x > reach + TILE_ROUNDING * abs(reach);
}

bool misses_view(View view, TileBounds tile) {
    if (CONES && misses_cone(view, tile)) return true;
    if (!PARALLEL && is_behind(tile, view.center, view.light_n)) return true;
    if (view.reach < 1e30 && misses_face(view, tile)) return true;
    return faces_away(view, tile);
}
