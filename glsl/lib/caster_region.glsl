// The region that holds every point of every line from the sub-light to a visible receiver, in the
// frame of the view's face (algorithm.md §10). What lies outside casts no visible shadow. Needs bounds.glsl and
// receiver.glsl.

struct Box {
    vec3 lower;
    vec3 upper;
};

// [scene units] The sub-light's bounding box, relative to its centre. In the front face it is flat.
Box box_of_light(View view) {
    Box box = Box(vec3(0.0), vec3(0.0));
    vec2 square = view.half_size * view.half_size;
    vec3 u = to_face(view, view.light_u) * square.x;
    vec3 v = to_face(view, view.light_v) * square.y;
    for (int i = 0; i < 4; ++i) {
        vec3 corner = u * ((i & 1) == 0 ? view.extent.x : view.extent.z)
                    + v * ((i & 2) == 0 ? view.extent.y : view.extent.w);
        box.lower = min(box.lower, corner);
        box.upper = max(box.upper, corner);
    }
    return box;
}

// Slopes of the planes through the light's box that just reach a receiver: x ≤ upper.x + slope · (z −
// lower.z) and so on for +x, +y, −x, −y. A light that extends along z needs planes that open.
vec4 slopes_to(Box light, vec3 receiver) {
    float height = max(receiver.z - light.lower.z, 1e-30);
    vec4 slope = vec4(receiver.xy - light.upper.xy, light.lower.xy - receiver.xy) / height;
    return light.upper.z > light.lower.z ? max(slope, vec4(0.0)) : slope;
}

// The widest of all receivers'.
vec4 slopes_of(Fit fit) {
    return vec4(value_of(fit.receiver_slopes[0], 0.0), value_of(fit.receiver_slopes[1], 0.0),
                value_of(fit.receiver_slopes[2], 0.0), value_of(fit.receiver_slopes[3], 0.0));
}

const uint PLANE_COUNT = 11u;

// By how much the region is opened, relative to the coordinates' magnitude: a point of the light and a
// single receiver span a line, of which rounding would leave nothing.
const float REGION_ROUNDING = 2e-6;

// Signed distance (up to a factor) of a point to each of the region's planes, ≥ 0 inside: four slopes,
// four widest tangents, behind the farthest receiver, above the lamp's own surface, and at the eye.
float[PLANE_COUNT] plane_distances(View view, Box light, vec4 slopes, float depth_max, vec3 p) {
    vec4 border = vec4(light.upper.xy, -light.lower.xy) + slopes * (p.z - light.lower.z);
    vec4 open = border - vec4(p.xy, -p.xy) + REGION_ROUNDING * (abs(border) + abs(p.xyxy));
    float widest = TANGENT_MAX * p.z;
    float in_light = p.x * dot(view.light_n, view.right) + p.y * dot(view.light_n, view.up)
                   + p.z * dot(view.light_n, view.forward);
    return float[PLANE_COUNT](open.x, open.y, open.z, open.w, widest - p.x, widest + p.x, widest - p.y,
                              widest + p.y, depth_max - p.z, in_light - view.touch, p.z - view.touch);
}
