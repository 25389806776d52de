// Radial integration of contours [GBP07; algorithm.md §3]. Around the sub-light's centre, the area that a contour's edge
// leaves over is what lies beyond the edge within its angle; the sum over all edges, taken from the whole area if the centre
// is hidden, or else from 0, is the area that is hidden. Needs receiver.glsl, contour.glsl and map.glsl.

#include "light_clip.glsl"
#include "cut.glsl"

// Signed area of the part of the sub-light that lies beyond the segment a→b, seen from the centre,
// within the segment's angle. a, b: homogeneous light coordinates. side: on which side of the segment the
// centre lies, see `full_turns`.
// A segment outside the light contributes exactly 0.
float area_beyond(View view, vec3 a, vec3 b, float side) {
    bool inside = clip_to_box(IS_CUT ? view.extent : vec4(-1.0, -1.0, 1.0, 1.0), a, b);
    vec2 start = a.xy / a.z;
    vec2 end = b.xy / b.z;
    if (DISC_LIGHT) inside = clip_to_rim(view.rim, start, end) && inside;
    if (EDGES > 0u) inside = clip_to_edges(view, start, end) && inside;
    float from = perimeter(start);
    float to = perimeter(end);
    // A square's area between centre and border is ½ per unit of perimeter.
    float sector = 0.5 * (to - from + 8.0 * full_turns(from, to, side));
    if (IS_CUT) {
        // The table starts at direction 0 while parameters of directions just below it are negative.
        float cut = float(from < 0.0) - float(to < 0.0);
        sector = sector_to(view, to) - sector_to(view, from) + view.area * (full_turns(from, to, side) + cut);
    }
    float area = sector - 0.5 * (start.x * end.y - start.y * end.x);
    return inside ? area : 0.0;
}

// `area_beyond` of a contour's edge, for one receiver.
float edge_beyond(View view, Receiver receiver, Edge edge) {
    vec3 a = back_project(receiver, edge.a.xy - receiver.t, edge.a.z);
    vec3 b = back_project(receiver, edge.b.xy - receiver.t, edge.b.z);
    return area_beyond(view, a, b, side_of(edge, receiver.t));
}

// `edge_beyond` of one segment of a cell; 0 where the cell has fewer.
float segment_beyond(View view, Receiver receiver, ivec2 cell, vec4 depths, uint mask, uint segment) {
    float area = edge_beyond(view, receiver, edge_of(cell, depths, mask, segment));
    return segment < segment_count(mask) ? area : 0.0;
}

// The sub-light's area if its centre is hidden, or else 0. The contour itself is asked, not the nearest sample, so that
// centre and edges cannot disagree (algorithm.md §3).
float centre_area(View view, Receiver receiver, uint layer) {
    ivec2 cell = ivec2(floor(receiver.t));
    bool inside = false;
    if (all(lessThan(uvec2(cell), uvec2(view.map_size - 1u)))) {
        vec4 depths = depths_of(layer, cell);
        inside = inside_contour(cell, depths, occluding(receiver, cell, depths), receiver.t);
    }
    return inside ? view.area : 0.0;
}
