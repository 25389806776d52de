// Contours of occluders by marching squares on the dual grid [GBP07; algorithm.md §2]. Corners of a cell count
// counter-clockwise from (0, 0): 0 (0, 0), 1 (1, 0), 2 (1, 1), 3 (0, 1). Edge e runs from corner e to corner e + 1. Needs
// receiver.glsl.

// Per mask of occluding corners (bit = corner): number of segments, then start and end edge of each, two
// bits apiece. A segment has the occluders on its left; the two saddles keep them apart.
const uint SEGMENTS[16] = uint[16](
    0u, 49u, 5u, 53u, 25u, 434u, 9u, 57u, 45u, 33u, 710u, 37u, 29u, 17u, 13u, 0u);

uint mask_of(vec4 depths, vec4 limits) {
    return uint(depths.x > limits.x) | uint(depths.y > limits.y) << 1 | uint(depths.z > limits.z) << 2
         | uint(depths.w > limits.w) << 3;
}

// The corners of a cell that occlude a receiver.
uint occluding(Receiver receiver, ivec2 cell, vec4 depths) {
    vec2 at = vec2(cell);
    return uint(occludes(receiver, at, depths.x)) | uint(occludes(receiver, at + vec2(1.0, 0.0), depths.y)) << 1
         | uint(occludes(receiver, at + vec2(1.0, 1.0), depths.z)) << 2
         | uint(occludes(receiver, at + vec2(0.0, 1.0), depths.w)) << 3;
}

uint segment_count(uint mask) { return SEGMENTS[mask] & 3u; }

uint start_edge(uint mask, uint segment) { return SEGMENTS[mask] >> (2u + 4u * segment) & 3u; }

uint end_edge(uint mask, uint segment) { return SEGMENTS[mask] >> (4u + 4u * segment) & 3u; }

// [cell] The contour vertex on an edge: its midpoint.
vec2 midpoint(uint edge) {
    return vec2(edge == 1u ? 1.0 : edge == 3u ? 0.0 : 0.5, edge == 2u ? 1.0 : edge == 0u ? 0.0 : 0.5);
}

// The depth of a contour vertex is that of the edge's occluding corner: at a start edge its first
// corner, at an end edge its second.
float start_depth(vec4 depths, uint edge) { return depths[edge]; }

float end_depth(vec4 depths, uint edge) { return depths[(edge + 1u) & 3u]; }

// A contour segment in texels, with the depth of its occluders: x, y, d of its start and of its end.
struct Edge {
    vec3 a;
    vec3 b;
};

Edge edge_of(ivec2 cell, vec4 depths, uint mask, uint segment) {
    uint from = start_edge(mask, segment);
    uint to = end_edge(mask, segment);
    return Edge(vec3(vec2(cell) + midpoint(from), start_depth(depths, from)),
                vec3(vec2(cell) + midpoint(to), end_depth(depths, to)));
}

// On which side of an edge the point `t` lies: +1 left (the occluder's), −1 right.
// For a point in the edge's cell every difference and product is exact, so the sign is that of the difference
// of two floats: the centre test and the integration ask the same question and get the same answer (algorithm.md §3).
float side_of(Edge edge, vec2 t) {
    precise vec2 way = edge.b.xy - edge.a.xy;
    precise vec2 offset = t - edge.a.xy;
    precise float left = way.x * offset.y;
    precise float right = way.y * offset.x;
    return left > right ? 1.0 : -1.0;
}

// Whether the point `t` of a cell lies inside the contour.
bool inside_contour(ivec2 cell, vec4 depths, uint mask, vec2 t) {
    bool inside = mask == 15u;
    for (uint i = 0u; i < segment_count(mask); ++i)
        inside = inside || side_of(edge_of(cell, depths, mask, i), t) > 0.0;
    return inside;
}
