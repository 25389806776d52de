// Kernels [GBP06, SS07; Yang09 eq. 1; algorithm.md §5]: which dual cells can project onto the sub-light. No cell that does
// is left out. Needs receiver.glsl.

// [texel] Farther than any map reaches from where a receiver falls.
const float ENDLESS = 1e9;

struct Cells {
    ivec2 first;
    ivec2 last;
    // The kernel lies inside the map: nothing was cut off.
    bool whole;
};

uint packed(ivec2 cell) { return uint(cell.x) | uint(cell.y) << 16; }

ivec2 unpacked(uint cell) { return ivec2(cell & 0xffffu, cell >> 16); }

// The cells that occluders no nearer to the light than `depth_max` can project from.
Cells kernel_cells(View view, Receiver receiver, float depth_max) {
    float near_side = depth_max - receiver.d;
    precise vec2 lower = near_side * view.extent.xy / vec2(receiver.ku.x, receiver.kv.y);
    precise vec2 upper = near_side * view.extent.zw / vec2(receiver.ku.x, receiver.kv.y);
    if (OBLIQUE) {
        lower = vec2(0.0);
        upper = vec2(0.0);
        bool unbounded = false;
        for (int i = 0; i < 4; ++i) {
            vec2 q = vec2((i & 1) == 0 ? view.extent.x : view.extent.z, (i & 2) == 0 ? view.extent.y : view.extent.w);
            vec3 offset = texel_offset(receiver, q, depth_max);
            lower = min(lower, offset.xy);
            upper = max(upper, offset.xy);
            unbounded = unbounded || offset.z == 0.0;
        }
        // A part of the light lies beyond the map's horizon. Where the horizon cuts the light's border there is no
        // bound, on either side that one of the corners is on.
        if (unbounded) {
            lower = ENDLESS * sign(lower);
            upper = ENDLESS * sign(upper);
        }
    }
    int edge = int(view.map_size) - 2;
    precise vec2 first = floor(clamp(receiver.t + lower, vec2(-2.0), vec2(edge + 2)));
    precise vec2 last = floor(clamp(receiver.t + upper, vec2(-2.0), vec2(edge + 2)));
    Cells cells;
    cells.first = max(ivec2(first), ivec2(0));
    cells.last = min(ivec2(last), ivec2(edge));
    cells.whole = all(equal(cells.first, ivec2(first))) && all(equal(cells.last, ivec2(last)));
    return cells;
}
