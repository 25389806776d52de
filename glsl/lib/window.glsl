// The order of the pixels of a window in which local packets form (`Window`): those that follow on one another are near to one
// another (Morton).

uint place_in_window(uvec2 pixel) {
    uvec2 low = pixel & 1u;
    uvec2 middle = pixel << 1 & 4u;
    uvec2 high = pixel << 2 & 16u;
    uvec2 spread = low | middle | high;
    return spread.x | spread.y << 1;
}

uvec2 pixel_in_window(uint place) {
    uvec2 spread = uvec2(place, place >> 1);
    return spread & 1u | spread >> 1 & 2u | spread >> 2 & 4u;
}

// The place of bit number `rank` of those that are set, counted from 0; there are more than that.
uint place_of_bit(uvec2 bits, uint rank) {
    uint below = bitCount(bits.x);
    bool high = rank >= below;
    uint word = high ? bits.y : bits.x;
    rank -= high ? below : 0u;
    uint place = 0u;
    for (uint width = 16u; width > 0u; width >>= 1) {
        uint lower = bitCount(bitfieldExtract(word, int(place), int(width)));
        bool beyond = rank >= lower;
        place += beyond ? width : 0u;
        rank -= beyond ? lower : 0u;
    }
    return place + (high ? 32u : 0u);
}

// The first `count` of the bits that are set.
uvec2 first_bits(uvec2 bits, uint count) {
    if (bitCount(bits.x) + bitCount(bits.y) <= count) return bits;
    uint end = place_of_bit(bits, count);
    uint below = (1u << (end & 31u)) - 1u;
    return end < 32u ? uvec2(bits.x & below, 0u) : uvec2(bits.x, bits.y & below);
}
