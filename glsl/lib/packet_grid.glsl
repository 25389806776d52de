// The grid of packets over the image [Yang09 §4.1]. Needs the buffers `frame` and `kernels`.

const uint PIXELS_PER_PACKET = PACKET_WIDTH * PACKET_HEIGHT;

// [packet] Columns and rows.
uvec2 packet_grid() {
    uvec2 size = uvec2(PACKET_WIDTH, PACKET_HEIGHT);
    return (frame.size + size - 1u) / size;
}

// Whether pixel `i` of the packet at a place of the grid is to be integrated, and its index in the image.
bool is_penumbra(uvec2 place, uint i, out uint index) {
    uvec2 pixel = place * uvec2(PACKET_WIDTH, PACKET_HEIGHT) + uvec2(i % PACKET_WIDTH, i / PACKET_WIDTH);
    index = pixel.y * frame.size.x + pixel.x;
    return all(lessThan(pixel, frame.size)) && kernels[index].status == KERNEL_PENUMBRA;
}

// The order in which pixels of a packet go to the lanes of a subgroup: in packets of 8×8 those of any 4, 8, 16 or 32 lanes are near
// to one another (Morton).
uint in_window(uint i) {
    uint x = i & 1u | i >> 1 & 2u | i >> 2 & 4u;
    uint y = i >> 1 & 1u | i >> 2 & 2u | i >> 3 & 4u;
    return PACKET_WIDTH == 8u && PACKET_HEIGHT == 8u ? y * 8u + x : i;
}
