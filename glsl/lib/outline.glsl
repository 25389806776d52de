// The corners of lights that are polygons. Needs the buffer `corners`.

layout(constant_id = 71) const bool POLYGONS = false;  // some light is one

bool is_polygon(Light light) { return POLYGONS && light.corner_count > 0u; }

// [half sizes]
vec2 corner_at(Light light, uint i) { return corners[light.corner_first + i]; }

// How far a polygon reaches along a direction of its plane, in half sizes, times the direction's length.
float polygon_reach(Light light, vec2 direction) {
    precise float reach = -1e38;
    for (uint i = 0u; i < light.corner_count; ++i) {
        precise vec2 along = corner_at(light, i) * direction;
        reach = max(reach, along.x + along.y);
    }
    return reach;
}
