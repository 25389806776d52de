// The two levels of quality between which a pixel's visibility is blended [Schwarz08 §4.2]: a pass adds what one of them says, by
// its share. What a receiver, a packet or a kernel is at a level: as if the level were the map. Needs receiver.glsl, kernel.glsl
// and map.glsl.

#include "quality.glsl"

readonly BUFFER(quality);

// [level] The whole level that the pass reads for a pixel.
int level_read(uint pixel) { return int(floor(quality[pixel])) + int(QUALITY == QUALITY_COARSER); }

// [0, 1] The pixel's share in the level that the pass reads.
float share_of_level(uint pixel) {
    if (QUALITY == QUALITY_FINEST) return 1.0;
    float coarser = fract(quality[pixel]);
    return QUALITY == QUALITY_COARSER ? coarser : 1.0 - coarser;
}

// Makes this invocation read the level that the pass reads for a pixel.
void choose_level(View view, uint pixel) {
    if (QUALITY == QUALITY_FINEST) return;
    level_of_quality = level_read(pixel);
    coarse_map_size = view.map_size;
}

// [depth] By how much more a receiver with this plane is biased: the bias in texels of the level, and half of one, for a coarse
// texel of the receiver's own surface is as near to the light as its nearest part.
float coarse_bias(View view, vec2 plane, float d) {
    precise float slope = abs(plane.x) + abs(plane.y);
    precise float bias = slope * (float((1 << level_of_quality) - 1) * (view.bias + 0.5));
    return min(bias, BIAS_SLOPE_MAX * d);
}

// What an entry of the pixel list says of the level that is left to it.
uint left_to_list() {
    if (QUALITY == QUALITY_FINEST) return 0u;
    return QUALITY == QUALITY_FINER ? LISTED_FINER : LISTED_COARSER;
}

Receiver at_level(View view, Receiver receiver) {
    if (!reads_coarse_map()) return receiver;
    float side = float(1 << level_of_quality);
    receiver.biased += coarse_bias(view, receiver.plane, receiver.d);
    receiver.t = beside_vertices(coarse_place(receiver.t, level_of_quality));
    receiver.plane *= side;
    receiver.ku *= side;
    receiver.kv *= side;
    receiver.b *= side;
    return receiver;
}

Cells at_level(Cells cells) {
    if (!reads_coarse_map()) return cells;
    return coarse_cells(cells, level_of_quality);
}

// [texel] A place of the map, kept in a packet, at the level.
vec2 place_at_level(vec2 t) { return coarse_place(t, level_of_quality); }

Packet at_level(View view, Packet packet) {
    if (!reads_coarse_map()) return packet;
    float side = float(1 << level_of_quality);
    Cells cells = at_level(Cells(unpacked(packet.first), unpacked(packet.last), true));
    packet.first = packed(cells.first);
    packet.last = packed(cells.last);
    // Bounds of its receivers' biases, from those of their planes.
    vec2 low = abs(packet.planes.xy);
    vec2 high = abs(packet.planes.zw);
    vec2 flattest = mix(min(low, high), vec2(0.0), lessThan(packet.planes.xy * packet.planes.zw, vec2(0.0)));
    float least = coarse_bias(view, flattest, packet.depth_far) * (1.0 - BIAS_ROUNDING);
    float most = coarse_bias(view, max(low, high), packet.depth_max) * (1.0 + BIAS_ROUNDING);
    packet.depth_min += least;
    packet.depth_max += most;
    packet.plane_depths += vec2(least, most);
    packet.planes *= side;
    packet.origin = place_at_level(packet.origin);
    packet.centers = vec4(place_at_level(packet.centers.xy), place_at_level(packet.centers.zw));
    return packet;
}
