#version 460
#extension GL_GOOGLE_include_directive : require
// Leaves out the triangles that shadow no visible receiver of this view, appends the others to the index list of its shadow
// map and reduces their bounds (algorithm.md §10). A triangle casts no shadow when sub-light and receivers lie on one closed
// side of its plane, or when it lies outside the region of the lines between them. No caster is left out, whatever rounding
// does; the bounds hold all that is kept of triangles inside the region.
#include "pass.glsl"
#include "bounds.glsl"
#include "receiver.glsl"
#include "caster_region.glsl"
#include "caster_position.glsl"
#include "casting.glsl"

layout(local_size_x = GROUP_SIZE) in;

readonly BUFFER(frame);
readonly BUFFER(views);
BUFFER(fits);
readonly BUFFER(triangles);
writeonly BUFFER(caster_indices);

// Upper bounds of one invocation's casters; see `Fit`.
struct Reach {
    vec4 tangents;
    float negated_near;
};

const float NONE = -1e38;

vec3 receiver_corner(Fit fit, float side) {
    return side * vec3(value_of(fit.receiver_bounds[side > 0.0 ? 0 : 3], 0.0),
                       value_of(fit.receiver_bounds[side > 0.0 ? 1 : 4], 0.0),
                       value_of(fit.receiver_bounds[side > 0.0 ? 2 : 5], 0.0));
}

// The largest normal · (x − at) − rounding · |x|₁ of all points x of a box: how far it reaches beyond the plane through `at`
// and beyond rounding, which grows with each point's own coordinates, so that far receivers do not blur near ones.
float reach_beyond(Box box, vec3 normal, vec3 at, float rounding) {
    vec3 middle = clamp(vec3(0.0), box.lower, box.upper);
    vec3 reach = max(normal * (box.lower - at) - rounding * abs(box.lower),
                     normal * (box.upper - at) - rounding * abs(box.upper));
    reach = max(reach, normal * (middle - at) - rounding * abs(middle));
    return reach.x + reach.y + reach.z;
}

// Whether the light or a receiver is on the side of the triangle's plane that `normal` points to, beyond rounding. Corners
// are exact relative to the light (caster_position.glsl), receivers are found from positions relative to the eye.
// `center`: the sub-light's, relative to what positions are.
bool reaches_beyond(vec3 normal, vec3 at, Box light, Box receivers, vec3 center) {
    float of_corner = dot(abs(at), vec3(1.0)) * length(normal);
    float of_light = reach_beyond(light, normal, at, 0.0) - CORNER_ROUNDING * of_corner;
    float rounding = PLANE_ROUNDING * length(normal);
    float of_receivers = reach_beyond(receivers, normal, at, rounding) - PLANE_ROUNDING * of_corner
                       - rounding * dot(abs(center), vec3(1.0));
    return max(of_light, of_receivers) > 0.0;
}

bool one_sided(vec3 corner[3], Box light, Box receivers, vec3 center) {
    vec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    return !reaches_beyond(normal, corner[0], light, receivers, center)
        || !reaches_beyond(-normal, corner[0], light, receivers, center);
}

void include(inout Reach reach, vec3 p) {
    reach.tangents = max(reach.tangents, vec4(p.xy, -p.xy) / p.z);
    reach.negated_near = max(reach.negated_near, -p.z);
}

// Clips a polygon of `count` ≤ 3 corners to the region and reduces what is left. False: nothing is.
bool include_clipped(inout Reach reach, View view, Box light, vec4 slopes, float depth_max, vec3 corner[3], int count) {
    vec3 polygon[3 + PLANE_COUNT];
    for (int i = 0; i < 3; ++i) polygon[i] = corner[i];
    for (uint plane = 0u; plane < PLANE_COUNT && count > 0; ++plane) {
        vec3 clipped[3 + PLANE_COUNT];
        int kept = 0;
        vec3 previous = polygon[count - 1];
        float before = plane_distances(view, light, slopes, depth_max, previous)[plane];
        for (int i = 0; i < count; ++i) {
            vec3 current = polygon[i];
            float after = plane_distances(view, light, slopes, depth_max, current)[plane];
            if ((before < 0.0) != (after < 0.0) && kept < 3 + int(PLANE_COUNT))
                clipped[kept++] = mix(previous, current, before / (before - after));
            if (after >= 0.0 && kept < 3 + int(PLANE_COUNT)) clipped[kept++] = current;
            previous = current;
            before = after;
        }
        polygon = clipped;
        count = kept;
    }
    for (int i = 0; i < count; ++i) include(reach, polygon[i]);
    return count > 0;
}

// Reduces the triangle's part inside the region into the bounds. False: it has none.
bool include_triangle(inout Reach reach, View view, Box light, vec4 slopes, float depth_max, vec3 corner[3]) {
    float[PLANE_COUNT] a = plane_distances(view, light, slopes, depth_max, corner[0]);
    float[PLANE_COUNT] b = plane_distances(view, light, slopes, depth_max, corner[1]);
    float[PLANE_COUNT] c = plane_distances(view, light, slopes, depth_max, corner[2]);
    bool inside = true;
    bool outside = false;
    for (uint plane = 0u; plane < PLANE_COUNT; ++plane) {
        outside = outside || max(a[plane], max(b[plane], c[plane])) < 0.0;
        inside = inside && min(a[plane], min(b[plane], c[plane])) >= 0.0;
    }
    if (inside) for (int i = 0; i < 3; ++i) include(reach, corner[i]);
    bool crosses = !inside && !outside;
    bool clipped = include_clipped(reach, view, light, slopes, depth_max, corner, crosses ? 3 : 0);
    return inside || clipped;
}

void append(uvec3 triangle, bool masked) {
    uint at = masked ? 3u * frame.opaque_count + atomicAdd(fits[push.index].masked_draw[0], 3u)
                     : atomicAdd(fits[push.index].opaque_draw[0], 3u);
    for (uint i = 0u; i < 3u; ++i) caster_indices[at + i] = triangle[i];
}

void main() {
    Fit fit = fits[push.index];
    if (fit.receiver_count == 0u) return;
    View view = views[push.index];
    Box light = box_of_light(view);
    Box receivers = Box(receiver_corner(fit, -1.0), receiver_corner(fit, 1.0));
    vec4 slopes = slopes_of(fit);
    float depth_max = max(receivers.upper.z, light.upper.z);
    Reach reach = Reach(vec4(NONE), NONE);
    uint stride = gl_NumWorkGroups.x * GROUP_SIZE;
    for (uint index = gl_GlobalInvocationID.x; index < frame.opaque_count + frame.masked_count; index += stride) {
        if (!casts(index)) continue;
        uvec3 triangle = triangles[index];
        vec3 corner[3];
        for (int i = 0; i < 3; ++i) corner[i] = caster_position(view, triangle[i]);
        if (!one_sided(corner, light, receivers, view.center)
            && include_triangle(reach, view, light, slopes, depth_max, corner))
            append(triangle, index >= frame.opaque_count);
    }
    vec4 tangents = subgroupMax(reach.tangents);
    float negated_near = subgroupMax(reach.negated_near);
    if (negated_near == NONE || !subgroupElect()) return;
    for (int i = 0; i < 4; ++i) atomicMax(fits[push.index].caster_bounds[i], bound_of(tangents[i]));
    atomicMax(fits[push.index].caster_bounds[4], bound_of(negated_near));
}
