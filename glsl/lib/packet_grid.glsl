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
