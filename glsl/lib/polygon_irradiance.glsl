// Unshadowed irradiance by a convex polygon of constant radiance: of what of it is above the surface's horizon.
//
// Where the light is wide, Lambert's sum over its sides: with Γ = a × b of a side's ends as seen from the receiver, at the angle θ,
// E = ½ Σ θ n · Γ / |Γ|. Its terms are of the order of the light's size over its distance, and E of the order of the square: they
// cancel. So lights that are small beside their distance are a fan of triangles around the highest corner, each with the seven
// nodes of Radon's rule: all terms are positive, and small lights end in area · cos · cos / r².
//
// Error: a thousandth of E, and where the light is wide 1e-6 more (E is at most π), under the conditions of
// irradiance.glsl. Finite everywhere. Needs irradiance.glsl's `SHORTEST` and `arc_polynomial`, and outline.glsl.

// [share of the distance] Sum of the half sizes up to which a light is small.
const float SMALL = 0.25;

// Radon's rule of degree 5: the centroid, and two orbits of three nodes. Weight, and barycentric coordinate of the corner that a node is nearest to
// or farthest from.
const float CENTROID_WEIGHT = 0.225;
const vec2 ORBITS[2] = vec2[2](vec2(0.125939181, 0.797426985), vec2(0.132394153, 0.0597158718));

// A polygon as a receiver in front of its plane sees it; lengths are divided by a scale that makes them at most 1.
struct SeenPolygon {
    Light light;
    vec2 half_size;
    // From the foot to the light's centre.
    vec2 center;
    float distance;
    // The normal's components along u, v and towards the plane.
    vec3 slope;
    // Of the light's centre over the horizon.
    float height;
};

// A point of the plane: its offset from the light's centre, and its height over the horizon.
vec3 corner_of(SeenPolygon seen, uint i) {
    vec2 at = corner_at(seen.light, i) * seen.half_size;
    return vec3(at, seen.height + dot(seen.slope.xy, at));
}

// θ with tan(θ/2) = t, in [0, π].
float angle_of(float t) {
    bool obtuse = t > 1.0;
    float s = obtuse ? 1.0 / t : t;
    float quarter = s / (1.0 + sqrt(1.0 + s * s));
    float square = quarter * quarter;
    float angle = 4.0 * quarter * (1.0 - square * arc_polynomial(square));
    return obtuse ? PI - angle : angle;
}

// Lambert's term of a side, twice; on the horizon n · Γ = |Γ|.
float irradiance_by_side(SeenPolygon seen, vec2 a, vec2 b, bool on_horizon) {
    vec2 side = b - a;
    vec2 from = seen.center + a;
    vec2 to = seen.center + b;
    float moment = from.x * side.y - from.y * side.x;
    float cross_square = seen.distance * seen.distance * dot(side, side) + moment * moment;
    float cross_length = sqrt(cross_square);
    float square = seen.distance * seen.distance;
    float product = sqrt(square + dot(from, from)) * sqrt(square + dot(to, to));
    float cosine = square + dot(from, to);
    float sum = product + abs(cosine);
    float tangent = cosine < 0.0 ? sum / max(cross_length, 1e-30) : cross_length / sum;
    float rise = seen.slope.z * moment + seen.distance * (seen.slope.y * side.x - seen.slope.x * side.y);
    return angle_of(tangent) * (on_horizon ? 1.0 : rise / max(cross_length, 1e-30));
}

// cos · cos / r² of a point, over the distance.
float irradiance_by_node(SeenPolygon seen, vec3 at) {
    vec2 way = seen.center + at.xy;
    float square = seen.distance * seen.distance + dot(way, way);
    return at.z / (square * square);
}

// Twice the irradiance by a small triangle.
float irradiance_by_triangle(SeenPolygon seen, vec3 apex, vec3 a, vec3 b) {
    vec3 sum = apex + a + b;
    float mean = CENTROID_WEIGHT * irradiance_by_node(seen, sum / 3.0);
    for (int orbit = 0; orbit < 2; ++orbit) {
        float own = ORBITS[orbit].y;
        float other = 0.5 * (1.0 - own);
        mean += ORBITS[orbit].x * (irradiance_by_node(seen, other * sum + (own - other) * apex)
                                   + irradiance_by_node(seen, other * sum + (own - other) * a)
                                   + irradiance_by_node(seen, other * sum + (own - other) * b));
    }
    vec2 first = a.xy - apex.xy;
    vec2 second = b.xy - apex.xy;
    return max(first.x * second.y - first.y * second.x, 0.0) * mean * seen.distance;
}

// E, [0, π].
float irradiance_by_seen_polygon(SeenPolygon seen, bool small) {
    vec3 apex = corner_of(seen, 0u);
    for (uint i = 1u; i < seen.light.corner_count; ++i) {
        vec3 corner = corner_of(seen, i);
        if (corner.z > apex.z) apex = corner;
    }
    float sum = 0.0;
    vec3 sets = apex;
    vec3 rises = apex;
    vec3 from = corner_of(seen, seen.light.corner_count - 1u);
    for (uint i = 0u; i < seen.light.corner_count; ++i) {
        vec3 to = corner_of(seen, i);
        vec3 a = from;
        vec3 b = to;
        vec3 crossing = vec3(mix(from.xy, to.xy, from.z / (from.z - to.z)), 0.0);
        bool from_below = !(from.z > 0.0);
        bool to_below = !(to.z > 0.0);
        if (from_below) a = crossing;
        if (to_below) b = crossing;
        if (from_below && !to_below) rises = crossing;
        if (to_below && !from_below) sets = crossing;
        if (!from_below || !to_below)
            sum += small ? irradiance_by_triangle(seen, apex, a, b) : irradiance_by_side(seen, a.xy, b.xy, false);
        from = to;
    }
    // Along the horizon, where it cuts the light.
    sum += small ? irradiance_by_triangle(seen, apex, sets, rises) : irradiance_by_side(seen, sets.xy, rises.xy, true);
    return apex.z > 0.0 ? clamp(0.5 * sum, 0.0, PI) : 0.0;
}

float irradiance_by_polygon(Light light, vec3 to_center, vec3 normal, float inverse_scale) {
    vec3 way = to_center * inverse_scale;
    SeenPolygon seen;
    seen.light = light;
    seen.half_size = max(light.half_size * inverse_scale, SHORTEST);
    seen.center = vec2(dot(way, light.u), dot(way, light.v));
    seen.distance = -dot(way, light.n);
    seen.slope = vec3(dot(normal, light.u), dot(normal, light.v), -dot(normal, light.n));
    if (!(seen.distance > 0.0)) return 0.0;
    seen.distance = max(seen.distance, SHORTEST);
    seen.height = dot(seen.slope, vec3(seen.center, seen.distance));
    bool small = seen.half_size.x + seen.half_size.y < SMALL * length(way);
    float area = light.area * seen.half_size.x * seen.half_size.y;
    return irradiance_by_seen_polygon(seen, small) / area * inverse_scale * inverse_scale;
}
