// Unshadowed irradiance by a rectangle or a disc of constant radiance (polygons: polygon_irradiance.glsl), E = ∫ cos ω dω over what of it is above the
// surface's horizon.
//
// In the light's plane, x and y count from the foot of the receiver's perpendicular; D is its length, and
// h(x, y) = slope · (x, y, D) the height of a point of the plane above the surface. With ρ² = D² + x² and y = ρ tan ψ,
// the points of a line x = const lie on a great circle through the pole of y, dω = D/ρ² dx · cos ψ dψ, and
//
//     E = ∫ D/ρ² dx ∫ (h₀/ρ cos ψ + slope.y sin ψ) cos ψ dψ,    h₀ = h(x, 0).
//
// With Δ = ψ₁ − ψ₀, r₀ and r₁ the distances of the line's ends, and h the height of the point that halves Δ, the inner
// integral is ½ [h₀/ρ (Δ − sin Δ) + tan(Δ/2) ρ h (1/r₀ + 1/r₁)²]. The outer one is a Gauss quadrature over up to three
// panels, between which the horizon meets the light's border. All lengths that vanish with the light (of a panel, of a
// line) are taken from its half sizes and not from differences of positions, and the integrand is positive: nothing
// cancels, and small lights end in area · cos · cos / r². Only basic arithmetic and square roots: their precision is
// stated by Vulkan, that of trigonometric functions is too coarse.
//
// Relative error: below 1e-3 for half sizes from 0 to 100 times the distance from the light's centre, as long as two cosines
// are above 1e-3: the one at the light, of the way to its centre, and the height of the light's highest point over the sum of
// distance and half sizes. Where one is below 1e-4, the rounding of positions and normals decides. Finite everywhere.

#include "facing.glsl"
#include "beam.glsl"
#include "outline.glsl"

// [scale] Shorter lengths are taken for it: the limit of a point is reached within a share of 1e-18.
const float SHORTEST = 1e-9;
const float PI = 3.14159265;

// A light as a receiver in front of its plane sees it; lengths are divided by a scale that makes them at most 1.
struct SeenLight {
    bool disc;
    vec2 half_size;
    // From the foot to the light's centre.
    vec2 center;
    // D.
    float distance;
    // The normal's components along x, y and towards the plane; 0 ≤ x and, but for discs, x ≤ y.
    vec3 slope;
};

vec2 direction_of(vec2 v) {
    float square = dot(v, v);
    return square > 0.0 ? v * inversesqrt(square) : vec2(0.0);
}

// The direction of y, in the light's own u and v. Along x, neither the horizon nor the border near the foot should be
// steep: a rectangle chooses between its axes, a disc halves the angle between the directions of steepest height and of the
// nearest border.
vec2 axis_of(bool disc, vec2 center, vec2 slope) {
    if (!disc) return abs(slope.x) > abs(slope.y) ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    vec2 up = direction_of(slope);
    vec2 outward = direction_of(center);
    vec2 axis = direction_of(up + (dot(up, outward) < 0.0 ? -outward : outward));
    return axis == vec2(0.0) ? vec2(0.0, 1.0) : axis;
}

SeenLight seen_light(Light light, vec3 to_center, vec3 normal, float inverse_scale) {
    SeenLight seen;
    seen.disc = light.round != 0u;
    vec3 way = to_center * inverse_scale;
    vec2 center = vec2(dot(way, light.u), dot(way, light.v));
    vec2 slope = vec2(dot(normal, light.u), dot(normal, light.v));
    vec2 y = axis_of(seen.disc, center, slope);
    vec2 x = vec2(y.y, -y.x);
    slope = vec2(dot(slope, x), dot(slope, y));
    // Mirrored, so that heights rise along x and y.
    vec2 sense = vec2(slope.x < 0.0 ? -1.0 : 1.0, slope.y < 0.0 ? -1.0 : 1.0);
    vec2 half_size = max(light.half_size * inverse_scale, SHORTEST);
    seen.half_size = seen.disc || y.y != 0.0 ? half_size : half_size.yx;
    seen.center = sense * vec2(dot(center, x), dot(center, y));
    seen.distance = -dot(way, light.n);
    seen.slope = vec3(abs(slope), -dot(normal, light.n));
    return seen;
}

// (s − atan s) / s³ with z = s², off by up to 4.3e-6.
float arc_polynomial(float z) {
    float q = ARCTANGENT[5];
    for (int i = 4; i >= 0; --i) q = q * z + ARCTANGENT[i];
    return q;
}

// θ − sin θ for θ in [0, π], t = tan(θ/2): twice the area between an arc and its chord.
float arc_excess(float t) {
    bool obtuse = t > 1.0;
    float s = obtuse ? 1.0 / t : t;
    float z = s * s;
    float q = arc_polynomial(z);
    float c = 1.0 / (1.0 + z);
    return obtuse ? PI - 2.0 * s * (1.0 - z * q + c) : 2.0 * s * z * (c - q);
}

// The integrand over x: irradiance by the line at x, which is s half sizes from the light's centre, per length.
float irradiance_by_line(SeenLight seen, float x, float s) {
    float reach = seen.half_size.y * (seen.disc ? sqrt(max((1.0 - s) * (1.0 + s), 0.0)) : 1.0);
    float level = seen.slope.x * x + seen.slope.z * seen.distance;
    float horizon = -level / max(seen.slope.y, 1e-9);
    float y0 = max(seen.center.y - reach, horizon);
    float y1 = seen.center.y + reach;
    float extent = min(2.0 * reach, y1 - horizon);
    float square = seen.distance * seen.distance + x * x;
    float rho = sqrt(square);
    float r0 = sqrt(square + y0 * y0);
    float r1 = sqrt(square + y1 * y1);
    // tan(Δ/2) = sin Δ / (1 + cos Δ) = (1 − cos Δ) / sin Δ, each by r₀ r₁.
    float cosine = square + y0 * y1;
    float sine = rho * extent;
    float sum = r0 * r1 + abs(cosine);
    float tangent = cosine < 0.0 ? sum / sine : sine / sum;
    float height = level + seen.slope.y * ((y0 * r1 + y1 * r0) / (r0 + r1));
    float nearness = (r0 + r1) / (r0 * r1);
    float inner = level / rho * arc_excess(tangent) + tangent * rho * height * nearness * nearness;
    return extent > 0.0 ? 0.5 * inner * seen.distance / square : 0.0;
}

// (1 + g, 1 − g) with g = tan(θ/2) of the angle θ in which x is seen from `away`.
vec2 half_tangents(float x, float away) {
    float sum = sqrt(away * away + x * x) + away;
    float larger = 1.0 + abs(x) / sum;
    float smaller = 2.0 * away / (sum * larger);
    return x < 0.0 ? vec2(smaller, larger) : vec2(larger, smaller);
}

// What the lines from s = `from` to `to` add. The quadrature is over g; `away` is a distance that all visible points of the
// light keep.
float irradiance_by_panel(SeenLight seen, float from, float to, float away) {
    vec2 first = half_tangents(seen.center.x + from * seen.half_size.x, away);
    vec2 last = half_tangents(seen.center.x + to * seen.half_size.x, away);
    vec2 pole = away / first;
    // dg/ds = half_size.x / away · …, so that s and g can be had from one another without differences of x.
    float extent = seen.half_size.x * (to - from) / dot(pole, 1.0 / last);
    float sum = 0.0;
    for (int i = 0; i < 2 * IRRADIANCE_NODES.length(); ++i) {
        vec2 node = IRRADIANCE_NODES[i / 2];
        float share = 0.5 + ((i & 1) == 0 ? -0.5 : 0.5) * node.x;
        vec2 g = mix(first, last, share);
        float inverse = 1.0 / (g.x * g.y);
        float x = away * (g.x - g.y) * inverse;
        float s = from + extent * share * dot(pole, g.yx) * inverse / seen.half_size.x;
        float stretch = away * dot(g, g) * inverse * inverse;
        sum += node.y * stretch * irradiance_by_line(seen, x, s);
    }
    return 0.5 * extent * sum;
}

// [half sizes] The two s at which the horizon meets the light's border, clamped to −1 … 1; both −1 if it passes below.
vec2 horizon_on_border(SeenLight seen, float height, vec2 rise) {
    if (!seen.disc) return clamp(vec2(-height - rise.y, rise.y - height) / max(rise.x, 1e-30), -1.0, 1.0);
    float steepest = max(length(rise), 1e-30);
    float from_center = clamp(-height / steepest, -1.0, 1.0);
    float half_chord = sqrt((1.0 - from_center) * (1.0 + from_center));
    vec2 ends = (from_center * rise.x + vec2(-half_chord, half_chord) * rise.y) / steepest;
    return from_center > -1.0 ? clamp(ends, -1.0, 1.0) : vec2(-1.0);
}

// The least distance from the receiver to points of the light above the horizon, or less.
float closest_approach(SeenLight seen) {
    float beside = (seen.disc ? length(seen.center) : abs(seen.center.y)) - seen.half_size.y;
    float away = length(vec2(seen.distance, max(beside, 0.0)));
    float horizon = seen.distance / max(length(seen.slope.xy), 1e-6);
    return seen.slope.z < 0.0 ? max(away, horizon) : away;
}

// E, [0, π].
float irradiance_by_seen(SeenLight seen) {
    vec2 rise = seen.slope.xy * seen.half_size;
    float height = dot(seen.slope, vec3(seen.center, seen.distance));
    float away = closest_approach(seen);
    vec2 horizon = horizon_on_border(seen, height, rise);
    float sum = 0.0;
    float from = -1.0;
    for (uint panel = 0u; panel < 3u; ++panel) {
        float to = panel == 0u ? horizon.x : panel == 1u ? horizon.y : 1.0;
        // The horizon crosses the one in the middle alone.
        bool above = panel == 1u || height + (panel == 0u ? -rise.x : rise.x) > 0.0;
        if (above && to > from) sum += irradiance_by_panel(seen, from, to, away);
        from = to;
    }
    return max(sum, 0.0);
}

#include "polygon_irradiance.glsl"

// As `irradiance`, of a light that no cone keeps its shine in.
float irradiance_everywhere(Light whole_light, vec3 position, vec3 normal) {
    Facing facing = facing_of(whole_light, position, normal);
    Light light = facing.light;
    vec3 way = facing.way;
    if (light.spread == SPREAD_POINT) {
        float square = max(dot(way, way), 1e-36);
        return max(dot(way, normal), 0.0) / (square * sqrt(square));
    }
    vec3 far = abs(way);
    float scale = max(far.x, max(far.y, far.z)) + light.half_size.x + light.half_size.y;
    float inverse_scale = 1.0 / max(scale, 1e-18);
    if (is_polygon(light)) return min(irradiance_by_polygon(light, way, normal, inverse_scale), 1e38);
    SeenLight seen = seen_light(light, way, normal, inverse_scale);
    if (!(seen.distance > 0.0)) return 0.0;
    seen.distance = max(seen.distance, SHORTEST);
    float area = light.area * seen.half_size.x * seen.half_size.y;
    // Inside a sphere of constant radiance a hemisphere of it is seen; the cap of `area` gives what its centre cannot.
    return min(irradiance_by_seen(seen) / area * inverse_scale * inverse_scale * facing.area, 1e38);
}

// [1 / scene units²] Irradiance at a point by a light whose radiance times area is 1.
float irradiance(Light light, vec3 position, vec3 normal) {
    return beam_share(light, position - light.center) * irradiance_everywhere(light, position, normal);
}
