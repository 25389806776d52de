// A sum over all places of a kernel, in all layers of the shadow map. Needs `listed.glsl` and the binding `partial`;
// the technique defines `add_up`.

// Adds up over a layer from `scan` on, to its end or as far as the driver lets loops run: one by one, so that the sum
// does not depend on where rounds end.
void add_up(Listed listed, uint layer, inout Scan scan, inout float sum);

// False: `sum` is not complete yet, another round goes on.
bool sum_kernel(Listed listed, ivec2 first, ivec2 last, out float sum) {
    sum = is_first_round() ? 0.0 : partial[listed.index];
    uint layer;
    Scan scan = scan_at(first, last, next_number(listed), layer);
    while (layer < LAYERS && !out_of_turns(0u)) {
        ++steps;
        add_up(listed, layer, scan, sum);
        bool through = at_end(scan);
        layer += uint(through);
        scan.at = through ? scan.first : scan.at;
    }
    bool complete = close_round(listed, layer < LAYERS, Progress(number_of(scan, layer), 0u, 0u, 0u));
    if (!complete) partial[listed.index] = sum;
    return complete;
}
