// The contour in every dual cell of a kernel [GBP07, as re-implemented in Yang09 §6]. Needs `listed.glsl` and
// `radial.glsl`.

// Goes on to the next cell with a contour and stays there; returns its mask, or 0 when there is none left.
uint find_contour(Listed listed, uint layer, inout Scan scan) {
    uint mask = 0u;
    uint turns = 0u;
    while (segment_count(mask) == 0u && !at_end(scan) && !out_of_turns(turns)) {
        ++turns;
        mask = occluding(listed.receiver, scan.at, depths_of(layer, scan.at));
        if (segment_count(mask) == 0u) advance(scan);
    }
    nodes_visited += turns;
    samples_read += 4u * turns;
    steps += subgroupMax(turns) + 1u;
    return mask;
}

// Adds up what lies beyond the edges of a layer, times `sign`. The loops are nested so that invocations side by side
// integrate together and look for contours together; the rare second segment of a cell is a turn of its own.
void add_beyond(Listed listed, uint layer, inout Scan scan, float sign, inout float sum) {
    uint segment = 0u;
    while (segment > 0u || !(at_end(scan) || out_of_turns(0u))) {
        ++steps;
        uint mask = find_contour(listed, layer, scan);
        vec4 depths = depths_of(layer, scan.at);
        sum += sign * segment_beyond(listed.view, listed.receiver, scan.at, depths, mask, segment);
        edges_extracted += uint(segment < segment_count(mask));
        bool more = segment + 1u < segment_count(mask);
        segment = more ? 1u : 0u;
        if (!more && segment_count(mask) > 0u) advance(scan);
    }
}

// The sub-light's area if its centre is hidden, asked of the contour itself (trap 1), or 0.
float centre_area(Listed listed, uint layer) {
    ivec2 cell = ivec2(floor(listed.receiver.t));
    bool inside = false;
    if (all(lessThan(uvec2(cell), uvec2(listed.view.map_size - 1u)))) {
        vec4 depths = depths_of(layer, cell);
        inside = inside_contour(cell, depths, occluding(listed.receiver, cell, depths), listed.receiver.t);
    }
    return inside ? listed.view.area : 0.0;
}
