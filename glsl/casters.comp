#version 460
#extension GL_GOOGLE_include_directive : require
// Leaves out the triangles that shadow no visible receiver of this view, appends the others to the index list of its shadow
// map and reduces their bounds (algorithm.md §10). A triangle casts no shadow when sub-light and receivers lie on one closed
// side of its plane, or when it lies outside the region of the lines between them. No caster is left out, whatever rounding
// does; the bounds hold all that is kept of triangles inside the region.
#include "pass.glsl"
#include "side_by_side.glsl"
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

#include "caster_list.glsl"

// Upper bounds of one invocation's casters; see `Fit`.
struct Reach {
    vec4 tangents;
    float negated_near;
};

const float NONE = -1e38;

// What bounds hold: upper ones of x, y, z, −x, −y, −z.
Box box_of(uint bounds[6]) {
    return Box(-vec3(value_of(bounds[3], 0.0), value_of(bounds[4], 0.0), value_of(bounds[5], 0.0)),
               vec3(value_of(bounds[0], 0.0), value_of(bounds[1], 0.0), value_of(bounds[2], 0.0)));
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

// A triangle's plane, in the frame of the view's face, which parallel rays map, and in the scene's.
struct Plane {
    // Towards the same side; of any length.
    vec3 normal;
    vec3 scene_normal;
    // Of one of its corners, from the light's centre.
    vec3 at;
    vec3 scene_at;
};

// corner: the first, in the frame of the view's face; ways: to all of them from the light's centre.
Plane plane_of(View view, vec3 corner, vec3 ways[3]) {
    Plane plane;
    plane.scene_normal = cross(ways[1] - ways[0], ways[2] - ways[0]);
    plane.scene_at = ways[0];
    plane.normal = to_face(view, mapped_normal(view, ways[0], plane.scene_normal));
    plane.at = corner;
    return plane;
}

// By how much receivers in a box reach beyond a plane and beyond rounding. They are found from positions relative to the eye, from
// which the light's centre is at `center`.
float receivers_beyond(Box receivers, vec3 normal, vec3 at, vec3 center) {
    float rounding = PLANE_ROUNDING * length(normal);
    return reach_beyond(receivers, normal, at, rounding) - rounding * (dot(abs(at), vec3(1.0)) + dot(abs(center), vec3(1.0)));
}

// Whether the light or a receiver is on the side of the triangle's plane that `side` times its normal points to, beyond rounding.
// Corners are exact relative to the light (caster_position.glsl). No receiver reaches farther than each of the boxes does:
// level ground is at the border of the scene's, however the light is turned.
bool reaches_beyond(Plane plane, float side, View view, Box light, Box receivers, Box in_scene) {
    vec3 normal = side * plane.normal;
    float of_light = reach_beyond(light, normal, plane.at, 0.0)
                   - CORNER_ROUNDING * dot(abs(plane.at), vec3(1.0)) * length(normal);
    return of_light > 0.0
        || (receivers_beyond(receivers, normal, plane.at, view.center) > 0.0
            && receivers_beyond(in_scene, side * plane.scene_normal, plane.scene_at, view.center) > 0.0);
}

bool one_sided(Plane plane, View view, Box light, Box receivers, Box in_scene) {
    return !reaches_beyond(plane, 1.0, view, light, receivers, in_scene)
        || !reaches_beyond(plane, -1.0, view, light, receivers, in_scene);
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
    uint at = masked ? first_masked_index(view_index()) + atomicAdd(fits[view_index()].masked_draw[0], 3u)
                     : first_opaque_index(view_index()) + atomicAdd(fits[view_index()].opaque_draw[0], 3u);
    for (uint i = 0u; i < 3u; ++i) caster_indices[at + i] = triangle[i];
}

void main() {
    Fit fit = fits[view_index()];
    if (fit.receiver_count == 0u) return;
    View view = views[view_index()];
    Box light = box_of_light(view);
    Box receivers = box_of(fit.receiver_bounds);
    Box in_scene = box_of(fit.receiver_box);
    in_scene = Box(in_scene.lower - view.center, in_scene.upper - view.center);
    vec4 slopes = slopes_of(fit);
    float depth_max = max(receivers.upper.z, light.upper.z);
    Reach reach = Reach(vec4(NONE), NONE);
    uint stride = gl_NumWorkGroups.x * GROUP_SIZE;
    for (uint index = gl_GlobalInvocationID.x; index < frame.opaque_count + frame.masked_count; index += stride) {
        if (!casts(index)) continue;
        uvec3 triangle = triangles[index];
        vec3 ways[3];
        vec3 corner[3];
        for (int i = 0; i < 3; ++i) ways[i] = caster_way(view, triangle[i]);
        for (int i = 0; i < 3; ++i) corner[i] = to_face(view, mapped(view, ways[i]));
        if (!one_sided(plane_of(view, corner[0], ways), view, light, receivers, in_scene)
            && include_triangle(reach, view, light, slopes, depth_max, corner))
            append(triangle, index >= frame.opaque_count);
    }
    vec4 tangents = subgroupMax(reach.tangents);
    float negated_near = subgroupMax(reach.negated_near);
    if (negated_near == NONE || !subgroupElect()) return;
    for (int i = 0; i < 4; ++i) atomicMax(fits[view_index()].caster_bounds[i], bound_of(tangents[i]));
    atomicMax(fits[view_index()].caster_bounds[4], bound_of(negated_near));
}
