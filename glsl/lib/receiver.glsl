// A receiver as a view sees it: where it falls on the map, how deep, which samples occlude it, and where the line through an
// occluder meets the light (algorithm.md §1, §8). Passes that project a receiver anew come to the same bits.

struct Receiver {
    // [texel] Its projection, t_p. Never on a line of contour vertices: see `beside_vertices`.
    vec2 t;
    // Depth near / z.
    float d;
    // Depth moved towards the light by the bias: samples with a larger depth may occlude.
    float biased;
    // [per texel] By how much the depth of the receiver's own plane changes; see `limit_at`.
    vec2 plane;
    // The sub-light's centre is behind the plane: what stands above the plane is farther away than it; see `ceiling_at`.
    bool behind;
    // Back-projection q = (ku · Δt, kv · Δt) / (Δd + b · Δt), with Δt = t − t_p and Δd = d − d_p.
    vec2 ku;
    vec2 kv;
    vec2 b;
};

// `dot` in a stated order of summation: integers are decided on what follows from it, and passes that
// compute it anew must come to the same bits.
float dot_exact(vec3 a, vec3 b) {
    precise float sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
}

#include "parallel.glsl"
#include "cone.glsl"

layout(constant_id = 61) const bool CONES = false;  // the view's receivers are those in its cone

layout(constant_id = 65) const bool BEAM = false;  // the light's shine is kept in a cone

// Whether a position relative to the eye is out of the cone that the light's shine is kept in.
bool is_out_of_beam(View view, vec3 position) {
    precise vec3 way = position - view.sphere.xyz;
    precise float square = dot_exact(way, way);
    return dot_exact(view.beam, way) < view.beam_cosine * sqrt(square);
}

// A direction or relative position in the frame of the view's face.
vec3 to_face(View view, vec3 world) {
    return vec3(dot_exact(world, view.right), dot_exact(world, view.up), dot_exact(world, view.forward));
}

// The face that a receiver belongs to, from its position in the light's frame (any axis scales).
uint face_of(vec3 in_light, float reach) {
    vec2 side = abs(in_light.xy);
    if (max(side.x, side.y) <= reach * in_light.z) return 0u;
    if (side.x >= side.y) return in_light.x > 0.0 ? 1u : 2u;
    return in_light.y > 0.0 ? 3u : 4u;
}

// Whether the sub-light's view has to look at a surface point: it lies in front of the light, belongs
// to the view's face and cone and to the light's beam, and at least a part of the sub-light is in front of it.
// position: relative to the eye; normal: of the visible side.
bool in_view(View view, vec3 position, vec3 normal) {
    if (CONES && cone_of(view.sphere, position) != view.cone) return false;
    vec3 way = position - view.center;
    if (BEAM && is_out_of_beam(view, position)) return false;
    vec3 to_point = mapped(view, way);
    normal = mapped_normal(view, way, normal);
    precise vec3 in_light = vec3(dot_exact(to_point, view.light_u) * view.half_size.x * view.half_size.x,
                                 dot_exact(to_point, view.light_v) * view.half_size.y * view.half_size.y,
                                 dot_exact(to_point, view.light_n));
    in_light.xy /= view.half_size;
    if (!(in_light.z > 0.0)) return false;
    if (face_of(in_light, view.reach) != view.face) return false;
    precise vec2 along = vec2(dot_exact(normal, view.light_u), dot_exact(normal, view.light_v)) * view.half_size
                       * view.half_size;
    precise vec2 reach = max(along * view.extent.xy, along * view.extent.zw);
    precise float sum = reach.x + reach.y;
    return sum > dot_exact(normal, to_point);
}

// A place on the map beside all contour vertices: these lie on multiples of ½. One ulp beside them, no vertex is ever exactly at
// the light's centre, where it would have no direction.
vec2 beside_vertices(vec2 t) {
    if (fract(2.0 * t.x) == 0.0) t.x = uintBitsToFloat(floatBitsToUint(t.x) + 1u);
    return t;
}

// error: [scene units] by how much the point may be off, beyond what 32 bits round off.
Receiver project(View view, Fit fit, vec3 to_point, vec3 normal, float error) {
    Receiver receiver;
    precise vec3 p = to_face(view, mapped(view, to_point));
    precise float inverse_z = 1.0 / p.z;
    precise vec2 t = fit.focal * (p.xy * inverse_z) + fit.center;
    precise float d = fit.near * inverse_z;

    vec3 n = to_face(view, mapped_normal(view, to_point, normal));
    precise float height = dot_exact(n, p);
    precise vec2 slope = abs(n.xy) * fit.near / (fit.focal * max(abs(height), 1e-30));
    precise float slope_bias = min((slope.x + slope.y) * view.bias, BIAS_SLOPE_MAX * d);
    precise vec3 magnitude = abs(to_point) + abs(view.center);
    precise float nearness = PARALLEL ? 1.0 / height_of(view, to_point) : inverse_z;
    precise float rounding = BIAS_ROUNDING * d * (1.0 + (magnitude.x + magnitude.y + magnitude.z) * nearness);
    // A plane that is off by `error` has depths that are off by the same share as its distance from the light.
    precise float misplaced = d * min(error / max(abs(height), 1e-30), 1.0);
    precise float biased = d + slope_bias + rounding + misplaced;

    receiver.t = beside_vertices(t);
    receiver.d = d;
    receiver.biased = biased;
    receiver.behind = !(height < 0.0);
    precise vec2 plane = n.xy * fit.near / (fit.focal * (receiver.behind ? max(height, 1e-30) : min(height, -1e-30)));
    receiver.plane = clamp(plane, -PLANE_MAX, PLANE_MAX);
    precise vec2 ku = vec2(fit.near / (fit.focal.x * view.half_size.x), 0.0);
    precise vec2 kv = vec2(0.0, fit.near / (fit.focal.y * view.half_size.y));
    precise vec2 b = vec2(0.0);
    if (OBLIQUE) {
        precise vec3 g = p * inverse_z;
        vec3 m = to_face(view, view.light_n);
        vec3 lu = to_face(view, view.light_u);
        vec3 lv = to_face(view, view.light_v);
        float mg = dot_exact(m, g);
        ku = fit.near * (lu.xy - m.xy * (dot_exact(lu, g) / mg)) / fit.focal;
        kv = fit.near * (lv.xy - m.xy * (dot_exact(lv, g) / mg)) / fit.focal;
        b = -d * (m.xy / fit.focal) / mg;
    }
    receiver.ku = ku;
    receiver.kv = kv;
    receiver.b = b;
    return receiver;
}

// By how much the receiver's plane is nearer to the light at a sample than at t_p.
float rise_at(Receiver receiver, vec2 texel) {
    precise vec2 way = texel - receiver.t;
    precise float rise = receiver.plane.x * way.x + receiver.plane.y * way.y;
    return rise;
}

// The depth beyond which a sample occludes: nearer to the light than the receiver, and above its plane. Without the plane,
// where a tilted surface comes nearer to the light it would be an occluder itself, and the contour of what stands before
// it would be lost. (DEVIATION [GBP07, Yang09]: they compare with the receiver's depth alone.)
float limit_at(Receiver receiver, vec2 texel) {
    precise float limit = receiver.biased + (receiver.behind ? 0.0 : max(rise_at(receiver, texel), 0.0));
    return limit;
}

// The depth of the plane that samples are compared with, at t_p: that of `limit_at`, or of `ceiling_at`.
float plane_depth_of(Receiver receiver) {
    precise float ceiling = receiver.d - (receiver.biased - receiver.d);
    return receiver.behind ? ceiling : receiver.biased;
}

// Seen from behind the receiver's plane, samples above it occlude up to this depth. What is nearer to the sub-light's
// centre is below the plane, as is the surface itself, and hides only such parts of the light as are below it as well.
float ceiling_at(Receiver receiver, vec2 texel) {
    precise float ceiling = (receiver.d - (receiver.biased - receiver.d)) + rise_at(receiver, texel);
    return ceiling;
}

// Whether a sample occludes.
bool occludes(Receiver receiver, vec2 texel, float depth) {
    bool below = receiver.behind && depth > ceiling_at(receiver, texel);
    return depth > limit_at(receiver, texel) && !below;
}

// The highest limit at samples first … last.
float highest_limit(Receiver receiver, ivec2 first, ivec2 last) {
    return limit_at(receiver, mix(vec2(first), vec2(last), greaterThan(receiver.plane, vec2(0.0))));
}

// Where the line from the receiver through the occluder point (t_p + dt, d) meets the light plane, as
// (x, y, w) with q = (x, y) / w in half sizes; w > 0 for points between receiver and light.
vec3 back_project(Receiver receiver, vec2 dt, float d) {
    vec3 oblique = vec3(dot(receiver.ku, dt), dot(receiver.kv, dt), d - receiver.d + dot(receiver.b, dt));
    return OBLIQUE ? oblique : vec3(receiver.ku.x * dt.x, receiver.kv.y * dt.y, d - receiver.d);
}

// [texel] Where, seen from t_p, an occluder of depth `d` stands that hides the light's point q: the inverse of
// `back_project`. Its third component is 0 where no such place is on the map's side of its horizon.
vec3 texel_offset(Receiver receiver, vec2 q, float d) {
    float near_side = d - receiver.d;
    if (!OBLIQUE) return vec3(near_side * q / vec2(receiver.ku.x, receiver.kv.y), 1.0);
    precise float determinant = receiver.ku.x * receiver.kv.y - receiver.ku.y * receiver.kv.x;
    precise vec2 at = vec2(q.x * receiver.kv.y - q.y * receiver.ku.y, q.y * receiver.ku.x - q.x * receiver.kv.x) / determinant;
    precise float share = 1.0 - (receiver.b.x * at.x + receiver.b.y * at.y);
    return share > 1e-4 ? vec3(at * (near_side / share), 1.0) : vec3(at, 0.0);
}
