// A scan of a rectangle of cells or texels, row by row, in all layers of the shadow map one after the other: how a technique
// over the pixel list (pixel_list.glsl) sums up over a kernel that it has no hierarchy for.

// A search stays at what it has found, and whoever has seen to that goes on (`advance`).
struct Scan {
    ivec2 first;
    ivec2 last;
    ivec2 at;
};

bool at_end(Scan scan) { return scan.at.y > scan.last.y; }

void advance(inout Scan scan) {
    scan.at = scan.at.x < scan.last.x ? scan.at + ivec2(1, 0) : ivec2(scan.first.x, scan.at.y + 1);
}

// Number of the place in the scans of all layers.
uint number_of(Scan scan, uint layer) {
    uvec2 side = uvec2(scan.last - scan.first + 1);
    uvec2 at = uvec2(scan.at - scan.first);
    return (layer * side.y + at.y) * side.x + at.x;
}

// The scan of `first` … `last` at the place with a number, and the layer that the place is in.
Scan scan_at(ivec2 first, ivec2 last, uint number, out uint layer) {
    uvec2 side = uvec2(last - first + 1);
    layer = number / (side.x * side.y);
    uint rest = number % (side.x * side.y);
    return Scan(first, last, first + ivec2(rest % side.x, rest / side.x));
}

// The technique adds up over a layer from `scan` on, to its end or as far as the budget lasts.
void sum_layer(uint layer, inout Scan scan);

// Adds up over the places `first` … `last` of all layers: `sum_kernel` of a technique that scans.
Progress sum_layers(ivec2 first, ivec2 last, Progress from) {
    uint layer;
    Scan scan = scan_at(first, last, from.next, layer);
    REPEAT_WHILE(layer < LAYERS) {
        sum_layer(layer, scan);
        bool through = at_end(scan);
        layer += uint(through);
        scan.at = through ? scan.first : scan.at;
    }
    return Progress(layer < LAYERS ? number_of(scan, layer) : FINISHED, 0u, 0u, 0u);
}
