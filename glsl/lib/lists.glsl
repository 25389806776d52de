// Appends to the lists of packets and pixels; a list's length and the dispatch that works it off grow
// together. Needs the bindings `lists`, `packets` and `pixels`.

// A packet of one pixel is a pixel.
const bool PIXELWISE = PACKET_WIDTH * PACKET_HEIGHT == 1u;

// [packet] Packets that a work group works off.
uint packets_per_group() { return LANES && !PIXELWISE ? GROUP_SIZE / (PACKET_WIDTH * PACKET_HEIGHT) : GROUP_SIZE; }

void append_packet(Packet packet) {
    uint at = atomicAdd(lists[push.index].packet_count, 1u);
    packets[at] = packet;
    if (at % packets_per_group() != 0u) return;
    uint group = at / packets_per_group();
    atomicMax(lists[push.index].packet_groups.x, min(group + 1u, GROUPS_PER_ROW));
    atomicMax(lists[push.index].packet_groups.y, group / GROUPS_PER_ROW + 1u);
    atomicMax(lists[push.index].packet_groups.z, 1u);
}

void append_pixel(uint pixel) {
    uint at = atomicAdd(lists[push.index].pixel_count, 1u);
    pixels[at] = pixel;
    if (at % GROUP_SIZE != 0u) return;
    uint group = at / GROUP_SIZE;
    atomicMax(lists[push.index].pixel_groups.x, min(group + 1u, GROUPS_PER_ROW));
    atomicMax(lists[push.index].pixel_groups.y, group / GROUPS_PER_ROW + 1u);
    atomicMax(lists[push.index].pixel_groups.z, 1u);
}
