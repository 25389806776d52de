// Appends to the lists of packets and pixels; a list's length and the dispatches that work it off grow together. Needs the
// buffers `packets` and `pixels`, part_of_view.glsl, rounds.glsl and packet_grid.glsl.

BUFFER(lists);

// A packet of one pixel is a pixel.
const bool PIXELWISE = PIXELS_PER_PACKET == 1u;

// [packet] Packets that a work group works off.
uint packets_per_group() { return LANES && !PIXELWISE ? GROUP_SIZE / PIXELS_PER_PACKET : GROUP_SIZE; }

// The first entry of a group makes the dispatch reach all of it.
void append_packet(Packet packet) {
    uint at = atomicAdd(lists[view_index()].packet_count, 1u);
    packets[at] = packet;
    if (at % packets_per_group() == 0u) reach_packets(0u, at / packets_per_group());
}

void append_pixel(uint pixel) {
    uint at = atomicAdd(lists[view_index()].pixel_count, 1u);
    pixels[first_pixel() + at] = pixel;
    if (at % GROUP_SIZE == 0u) reach_pixels(0u, at / GROUP_SIZE);
}
