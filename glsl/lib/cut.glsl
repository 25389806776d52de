// What bounds a sub-light within its box: a disc's rim, or the sides of a polygon. A part that nothing cuts is its box.

const bool IS_CUT = DISC_LIGHT || EDGES > 0u;

readonly BUFFER(sectors);

// The sub-light's area between direction 0 and the one with a perimeter parameter, from its table.
float sector_to(View view, float parameter) {
    float step = (parameter < 0.0 ? parameter + 8.0 : parameter) * (float(SECTOR_STEPS) / 8.0);
    uint entry = min(uint(step), SECTOR_STEPS - 1u);
    return mix(sectors[view.sector_first + entry], sectors[view.sector_first + entry + 1u], step - float(entry));
}

// [half sizes] A side's normal and its distance from the centre; it follows the table.
vec3 edge_line(View view, uint i) {
    uint first = view.sector_first + SECTOR_STEPS + 1u + 3u * i;
    return vec3(sectors[first], sectors[first + 1u], sectors[first + 2u]);
}

// How far a point is within the sides.
float height_in_edges(View view, vec2 q) {
    float height = 1e30;
    [[unroll]] for (uint i = 0u; i < EDGES; ++i) {
        vec3 line = edge_line(view, i);
        height = min(height, line.z - dot(line.xy, q));
    }
    return height;
}

// Whether a point of its box is on the sub-light.
bool on_light(View view, vec2 q) {
    return (!DISC_LIGHT || distance(q, view.rim.xy) <= view.rim.z) && (EDGES == 0u || height_in_edges(view, q) >= 0.0);
}

// Clips the segment a→b to the disc `rim`. False: nothing left.
bool clip_to_rim(vec3 rim, inout vec2 a, inout vec2 b) {
    vec2 way = b - a;
    vec2 from_center = a - rim.xy;
    float square = dot(way, way);
    float along = dot(from_center, way);
    float root = along * along - square * (dot(from_center, from_center) - rim.z * rim.z);
    float half_chord = sqrt(max(root, 0.0));
    float from = (-along - half_chord) / square;
    float to = (half_chord - along) / square;
    bool inside = root > 0.0 && max(from, 0.0) < min(to, 1.0);
    if (to < 1.0) b = a + to * way;
    if (from > 0.0) a = a + from * way;
    return inside;
}

// Clips the segment a→b to the sides. False: nothing left. As `clip_to_box`, whose result it takes.
bool clip_to_edges(View view, inout vec2 a, inout vec2 b) {
    float from = 0.0;
    float to = 1.0;
    [[unroll]] for (uint i = 0u; i < EDGES; ++i) {
        vec3 line = edge_line(view, i);
        float before = line.z - dot(line.xy, a);
        float after = line.z - dot(line.xy, b);
        float crossing = before / (before - after);
        if (before < 0.0) from = max(from, after > 0.0 ? crossing : 2.0);
        else if (after < 0.0) to = min(to, crossing);
    }
    vec2 way = b - a;
    if (to < 1.0) b = a + to * way;
    if (from > 0.0) a = a + from * way;
    return from < to;
}
