// The penumbra pixels of a packet that an invocation integrates: all of them, or a single one where LANES is set. What is
// kept of a receiver is kept field by field: those that a map parallel to the light does not need cost nothing. Packets have
// no receivers with the sub-light's centre behind their plane. Needs receiver.glsl, surface.glsl,
// packet_grid.glsl and resume.glsl.

layout(constant_id = 10) const uint SLOTS = 1u;  // [pixel] integrated by one invocation

bool is_kept[SLOTS];
// One more than the last that is. Not a constant, or drivers unroll the loops and compile for half a minute.
uint slot_end = 0u;
uint pixel_index[SLOTS];
vec2 receiver_t[SLOTS];
float receiver_d[SLOTS];
float receiver_biased[SLOTS];
vec2 receiver_plane[SLOTS];
vec2 receiver_ku[SLOTS];
vec2 receiver_kv[SLOTS];
vec2 receiver_b[SLOTS];
// [half sizes²] What is hidden by the edges so far.
float sum[SLOTS];

// Back-projection scale of a map that is parallel to the light, which all receivers share.
vec2 kappa;

void keep_pixel(View view, Fit fit, uint slot, uint index) {
    SurfacePoint point = surface_at(pixel_at(index));
    Receiver receiver = project(view, fit, point.position - view.center, point.normal);
    is_kept[slot] = true;
    slot_end = slot + 1u;
    pixel_index[slot] = index;
    receiver_t[slot] = receiver.t;
    receiver_d[slot] = receiver.d;
    receiver_biased[slot] = receiver.biased;
    receiver_plane[slot] = receiver.plane;
    if (OBLIQUE) receiver_ku[slot] = receiver.ku;
    if (OBLIQUE) receiver_kv[slot] = receiver.kv;
    if (OBLIQUE) receiver_b[slot] = receiver.b;
    sum[slot] = is_first_round() ? 0.0 : partial[index];
}

// Keeps what `lane` has to integrate of the packet at a place of the grid. False: that is nothing.
bool keep_pixels(View view, Fit fit, uvec2 place, uint lane) {
    kappa = fit.near / (fit.focal * view.half_size);
    uint index;
    if (LANES) {
        bool wanted = is_penumbra(place, lane, index);
        if (wanted) keep_pixel(view, fit, 0u, index);
        return wanted;
    }
    // Unrolled, it would be most of what drivers compile.
    [[dont_unroll]] for (uint i = 0u; i < SLOTS; ++i) {
        is_kept[i] = false;
        if (is_penumbra(place, i, index)) keep_pixel(view, fit, i, index);
    }
    return true;
}

Receiver receiver_of(uint slot) {
    Receiver receiver = Receiver(receiver_t[slot], receiver_d[slot], receiver_biased[slot], receiver_plane[slot], false,
                                 vec2(kappa.x, 0.0), vec2(0.0, kappa.y), vec2(0.0));
    if (OBLIQUE) receiver.ku = receiver_ku[slot];
    if (OBLIQUE) receiver.kv = receiver_kv[slot];
    if (OBLIQUE) receiver.b = receiver_b[slot];
    return receiver;
}
