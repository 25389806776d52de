#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
// Leaves out the triangles that shadow no visible receiver of this view, appends the others to the
// index list of its shadow map and reduces their bounds (algorithm.md §10). A triangle casts no
// shadow when sub-light and receivers lie on one closed side of its plane, or when it lies outside the
// region of the lines between them.
#include "pass.glsl"
#include "bounds.glsl"
#include "depth.glsl"
#include "caster_region.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(binding = 0, scalar) readonly buffer FrameBlock { Frame frame; };
layout(binding = 1, scalar) readonly buffer Views { View views[]; };
layout(binding = 2, scalar) buffer Fits { Fit fits[]; };
layout(binding = 3, scalar) readonly buffer Positions { vec3 positions[]; };
layout(binding = 4, scalar) readonly buffer Triangles { uvec3 triangles[]; };
layout(binding = 5, scalar) writeonly buffer CasterIndices { uint caster_indices[]; };

// Rounding of plane distances, relative to the coordinates' magnitude: receivers on the triangle's own
// plane count as on its side.
const float PLANE_ROUNDING = 2e-6;

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

// [least, largest] of normal · (x − at) over the box.
vec2 range_over(Box box, vec3 normal, vec3 at) {
    vec3 middle = 0.5 * (box.lower + box.upper) - at;
    float reach = dot(abs(normal), 0.5 * (box.upper - box.lower));
    return dot(normal, middle) + vec2(-reach, reach);
}

bool one_sided(vec3 corner[3], Box light, Box receivers, float magnitude) {
    vec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    float rounding = PLANE_ROUNDING * magnitude * length(normal);
    vec2 of_light = range_over(light, normal, corner[0]);
    vec2 of_receivers = range_over(receivers, normal, corner[0]);
    return max(of_light.y, of_receivers.y) <= rounding || min(of_light.x, of_receivers.x) >= -rounding;
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
    vec4 slopes = vec4(value_of(fit.receiver_slopes[0], 0.0), value_of(fit.receiver_slopes[1], 0.0),
                       value_of(fit.receiver_slopes[2], 0.0), value_of(fit.receiver_slopes[3], 0.0));
    float depth_max = max(receivers.upper.z, light.upper.z);
    vec3 largest = max(abs(receivers.lower), abs(receivers.upper)) + abs(view.center);
    Reach reach = Reach(vec4(NONE), NONE);
    uint stride = gl_NumWorkGroups.x * GROUP_SIZE;
    for (uint index = gl_GlobalInvocationID.x; index < frame.opaque_count + frame.masked_count; index += stride) {
        uvec3 triangle = triangles[index];
        vec3 corner[3];
        for (int i = 0; i < 3; ++i) corner[i] = to_face(view, positions[triangle[i]] - view.center);
        float magnitude = dot(max(largest, abs(corner[0]) + abs(view.center)), vec3(1.0));
        if (!one_sided(corner, light, receivers, magnitude)
            && include_triangle(reach, view, light, slopes, depth_max, corner))
            append(triangle, index >= frame.opaque_count);
    }
    vec4 tangents = subgroupMax(reach.tangents);
    float negated_near = subgroupMax(reach.negated_near);
    if (negated_near == NONE || !subgroupElect()) return;
    for (int i = 0; i < 4; ++i) atomicMax(fits[push.index].caster_bounds[i], bound_of(tangents[i]));
    atomicMax(fits[push.index].caster_bounds[4], bound_of(negated_near));
}
