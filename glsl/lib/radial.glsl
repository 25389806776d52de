// Radial integration of a cell's contour [GBP07; algorithm.md §3]. Needs the binding `sectors`.

// The sub-light's area between the directions with perimeter parameters a and b, `turn` full turns
// added (see `turns`).
float sector_to(View view, float parameter) {
    float step = (parameter < 0.0 ? parameter + 8.0 : parameter) * (float(SECTOR_STEPS) / 8.0);
    uint entry = min(uint(step), SECTOR_STEPS - 1u);
    return mix(sectors[view.sector_first + entry], sectors[view.sector_first + entry + 1u], step - float(entry));
}

// Signed area of the part of the sub-light that lies beyond the segment a→b, seen from the centre,
// within the segment's angle. a, b: homogeneous light coordinates. side: on which side of the segment the
// centre lies, see `turns`.
// A segment outside the light contributes exactly 0.
float area_beyond(View view, vec3 a, vec3 b, float side) {
    bool inside = clip_to_box(ROUND ? view.extent : vec4(-1.0, -1.0, 1.0, 1.0), a, b);
    vec2 start = a.xy / a.z;
    vec2 end = b.xy / b.z;
    if (ROUND) inside = clip_to_rim(view.rim, start, end) && inside;
    float from = perimeter(start);
    float to = perimeter(end);
    // A square's area between centre and border is ½ per unit of perimeter.
    float sector = 0.5 * (to - from + 8.0 * turns(from, to, side));
    if (ROUND) {
        // The table starts at direction 0 while parameters of directions just below it are negative.
        float cut = float(from < 0.0) - float(to < 0.0);
        sector = sector_to(view, to) - sector_to(view, from) + view.area * (turns(from, to, side) + cut);
    }
    float beyond = sector - 0.5 * (start.x * end.y - start.y * end.x);
    return inside ? beyond : 0.0;
}

// `area_beyond` of a contour's edge, for one receiver.
float edge_beyond(View view, Receiver receiver, Edge edge) {
    vec3 a = back_project(receiver, edge.a.xy - receiver.t, edge.a.z);
    vec3 b = back_project(receiver, edge.b.xy - receiver.t, edge.b.z);
    return area_beyond(view, a, b, side_of(edge, receiver.t));
}

// `edge_beyond` of one segment of a cell; 0 where the cell has fewer.
float segment_beyond(View view, Receiver receiver, ivec2 cell, vec4 depths, uint mask, uint segment) {
    float beyond = edge_beyond(view, receiver, edge_of(cell, depths, mask, segment));
    return segment < segment_count(mask) ? beyond : 0.0;
}

// The corners of a cell that occlude.
uint occluding(Receiver receiver, ivec2 cell, vec4 depths) {
    vec2 at = vec2(cell);
    return uint(occludes(receiver, at, depths.x)) | uint(occludes(receiver, at + vec2(1.0, 0.0), depths.y)) << 1
         | uint(occludes(receiver, at + vec2(1.0, 1.0), depths.z)) << 2
         | uint(occludes(receiver, at + vec2(0.0, 1.0), depths.w)) << 3;
}

// The samples at a cell's corners, counter-clockwise from (0, 0).
vec4 samples_of(texture2D shadow_map, ivec2 cell) {
    return vec4(texelFetch(shadow_map, cell, 0).x, texelFetch(shadow_map, cell + ivec2(1, 0), 0).x,
                texelFetch(shadow_map, cell + ivec2(1, 1), 0).x, texelFetch(shadow_map, cell + ivec2(0, 1), 0).x);
}

// Share of the sub-light that is hidden, given the sum of what lies beyond the contour's segments.
// The centre is asked of the contour itself, not of the nearest sample (trap 1).
float occluded_share(View view, Receiver receiver, texture2D shadow_map, float beyond) {
    ivec2 cell = ivec2(floor(receiver.t));
    bool inside = false;
    if (all(lessThan(uvec2(cell), uvec2(view.map_size - 1u)))) {
        vec4 depths = samples_of(shadow_map, cell);
        inside = inside_contour(cell, depths, occluding(receiver, cell, depths), receiver.t);
    }
    return clamp(((inside ? view.area : 0.0) - beyond) / view.area, 0.0, 1.0);
}
