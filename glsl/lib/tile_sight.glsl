// What a view's receivers in a tile have in common: bounds of all that decides about them (`Receiver`), whatever their rounding.
// Of front faces; a map that is not parallel to the light has no bounds here. Needs receiver.glsl, kernel.glsl and interval.glsl.

struct TileSight {
    // All of the tile is in front of the light, and what follows bounds it.
    bool bounded;
    // [texel] The cells that occluders of depth d can project from lie within corners.xy + d · growth.xy and corners.zw + d ·
    // growth.zw.
    vec4 corners;
    vec4 growth;
    // [texel] Box of t_p.
    vec4 centers;
    // Range of depths, and the highest that is compared with samples at t_p.
    vec2 depths;
    float biased;
    // Ranges of the planes' changes of depth in x and in y.
    vec2 planes[2];
    // The centre of the light is in front of all planes, beyond rounding.
    bool before;
};

// [share] Of the coordinates that a place on the map or a height is found from: their rounding, twice.
const float TILE_ROUNDING = 2e-6;

float sum_of(vec3 a) { return a.x + a.y + a.z; }

// The size of the coordinates that a tile's ways from `center` are found from.
float magnitude_of(TileBounds tile, vec3 center) {
    return sum_of(max(abs(tile.lower), abs(tile.upper))) + 2.0 * sum_of(abs(center));
}

// [scene units] Range of normal · way from the light's centre, as the view sees both: < 0 where it is in front of the plane. Its
// rounding is added.
vec2 height_range(View view, TileBounds tile) {
    vec2 height = vec2(tile.height_lower, tile.height_upper)
                - dot_range(tile.normal_lower, tile.normal_upper, view.center).yx;
    float size = magnitude_of(tile, view.center);
    // By the map of parallel.glsl, n · way comes to this.
    if (PARALLEL) {
        height = view.parallel * dot_range(tile.normal_lower, tile.normal_upper, view.ray);
        size = view.parallel * sum_of(abs(view.ray));
    }
    return height + TILE_ROUNDING * size * vec2(-1.0, 1.0);
}

// Includes a corner of the tile's box. What is projective has its extremes at corners.
void include_corner(inout TileSight sight, View view, Fit fit, vec3 corner) {
    vec3 to_point = corner - view.center;
    vec3 p = to_face(view, mapped(view, to_point));
    float height = PARALLEL ? height_of(view, to_point) : p.z;
    sight.bounded = sight.bounded && height > 0.0 && p.z > 0.0;
    float d = fit.near / max(p.z, 1e-30);
    vec2 t = fit.focal * (p.xy / max(p.z, 1e-30)) + fit.center;
    float size = sum_of(abs(to_point)) + sum_of(abs(view.center));
    float share = TILE_ROUNDING * (1.0 + size / max(PARALLEL ? min(height, view.parallel) : height, 1e-30));
    vec2 scale = abs(t) + abs(fit.center) + fit.focal + d * max(abs(sight.growth.xy), abs(sight.growth.zw));
    vec4 within = vec4(t - share * scale, t + share * scale);
    sight.centers = vec4(min(sight.centers.xy, within.xy), max(sight.centers.zw, within.zw));
    within -= d * sight.growth;
    sight.corners = vec4(min(sight.corners.xy, within.xy), max(sight.corners.zw, within.zw));
    sight.depths = vec2(min(sight.depths.x, d), max(sight.depths.y, d));
    sight.biased = max(sight.biased, d * (1.0 + share));
}

// What the planes add to the depths that samples are compared with (`project`).
void include_planes(inout TileSight sight, View view, Fit fit, TileBounds tile) {
    vec2 height = height_range(view, tile);
    sight.before = height.y < 0.0;
    float least = max(-height.y, 1e-30);
    vec2 slopes;
    for (int axis = 0; axis < 2; ++axis) {
        vec2 along = dot_range(tile.normal_lower, tile.normal_upper, axis == 0 ? view.right : view.up);
        float scale = fit.near / fit.focal[axis];
        vec2 inverse = scale * vec2(-1.0 / least, 1.0 / min(height.x, -1e-30));
        sight.planes[axis] = clamp(product_range(along, inverse), -PLANE_MAX, PLANE_MAX);
        slopes[axis] = scale * size_of(along) / least;
    }
    float slope_bias = min((slopes.x + slopes.y) * view.bias, BIAS_SLOPE_MAX * sight.depths.y);
    sight.biased += slope_bias + sight.depths.y * min(tile.error / least, 1.0);
}

TileSight sight_of(View view, Fit fit, TileBounds tile) {
    vec2 kappa = fit.near / (fit.focal * view.half_size);
    TileSight sight;
    sight.bounded = true;
    sight.growth = view.extent / kappa.xyxy;
    sight.corners = vec4(vec2(1e30), vec2(-1e30));
    sight.centers = sight.corners;
    sight.depths = vec2(1e30, 0.0);
    sight.biased = 0.0;
    for (int i = 0; i < 8; ++i)
        include_corner(sight, view, fit, mix(tile.lower, tile.upper, bvec3((i & 1) != 0, (i & 2) != 0, (i & 4) != 0)));
    include_planes(sight, view, fit, tile);
    return sight;
}

// The cells that occluders no nearer to the light than `depth_max` can project from, of any of its receivers (`kernel_cells`).
Cells tile_cells(View view, TileSight sight, float depth_max) {
    int edge = int(view.map_size) - 2;
    vec4 within = clamp(sight.corners + depth_max * sight.growth, vec4(-2.0), vec4(edge + 2));
    ivec2 first = ivec2(floor(within.xy));
    ivec2 last = ivec2(floor(within.zw));
    Cells cells = Cells(max(first, ivec2(0)), min(last, ivec2(edge)), true);
    cells.whole = cells.first == first && cells.last == last;
    return cells;
}

// No limit of its receivers at samples first … last is higher (`limit_at`).
float highest_limit(TileSight sight, ivec2 first, ivec2 last) {
    float rise = 0.0;
    for (int axis = 0; axis < 2; ++axis) {
        vec2 way = vec2(float(first[axis]) - sight.centers[axis + 2], float(last[axis]) - sight.centers[axis]);
        rise += product_range(sight.planes[axis], way).y;
    }
    return (sight.biased + max(rise, 0.0)) * (1.0 + TILE_ROUNDING);
}
