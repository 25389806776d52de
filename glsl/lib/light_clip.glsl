// The sub-light as the area that segments are integrated over: clipping to its outline, and directions around its centre
// (algorithm.md §3).

// Where the direction `q` leaves the square [−1, 1]², counted along its border: 0 at +x, 2 at +y, 4 at
// −x, 6 at −y; [−1, 7]. Opposite directions are exactly 4 apart.
float perimeter(vec2 q) {
    bool wide = abs(q.x) >= abs(q.y);
    float ratio = (wide ? q.y : q.x) / (wide ? q.x : q.y);
    return wide ? (q.x > 0.0 ? 0.0 : 4.0) + ratio : (q.y > 0.0 ? 2.0 : 6.0) - ratio;
}

// How often the way from perimeter parameter a to b, seen from the centre under less than 180°, must be
// corrected by a full turn (8). side: +1 or −1, on which side of the segment the centre lies (left, right).
// Without it the rounding of a direction could turn a half-turn over (algorithm.md §3).
float full_turns(float a, float b, float side) {
    float way = b - a;
    float turn = way > 4.0 ? -1.0 : way < -4.0 ? 1.0 : 0.0;
    way += 8.0 * turn;
    if (abs(way) > 3.5 && way * side < 0.0) turn += side;
    return turn;
}

// Clips the segment a→b, in homogeneous light coordinates, to the sub-light's box. False: nothing left.
// Without early returns: some drivers make loops of them, and count.
bool clip_to_box(vec4 extent, inout vec3 a, inout vec3 b) {
    vec4 da = vec4(a.xy - a.z * extent.xy, a.z * extent.zw - a.xy);
    vec4 db = vec4(b.xy - b.z * extent.xy, b.z * extent.zw - b.xy);
    vec4 crossing = da / (da - db);
    float from = 0.0;
    float to = 1.0;
    [[unroll]] for (int i = 0; i < 4; ++i) {
        // Outside altogether: 2 is beyond every end. Written so that a NaN is outside.
        if (da[i] < 0.0) from = max(from, db[i] > 0.0 ? crossing[i] : 2.0);
        else if (db[i] < 0.0) to = min(to, crossing[i]);
    }
    vec3 way = b - a;
    // A vertex inside keeps its bits: the next segment starts with the same ones.
    if (to < 1.0) b = a + to * way;
    if (from > 0.0) a = a + from * way;
    return from < to && a.z > 0.0 && b.z > 0.0;
}
