// The contour in every dual cell of a kernel [GBP07, as re-implemented in Yang09 §6]. Needs `listed.glsl` and
// `radial.glsl`.

// Goes on to the next cell with a contour; `found` is that cell.
void next_contour(Listed listed, uint layer, inout Scan scan, out ivec2 found, out vec4 depths, out uint mask) {
    found = scan.at;
    depths = vec4(0.0);
    mask = 0u;
    uint turns = 0u;
    while (segment_count(mask) == 0u && !at_end(scan) && !out_of_turns(turns)) {
        ++turns;
        found = scan.at;
        depths = depths_of(layer, found);
        mask = mask_of(depths, listed.receiver.biased);
        advance(scan);
    }
    nodes_visited += turns;
    samples_read += 4u * turns;
    steps += subgroupMax(turns) + 1u;
}

// Sum of what lies beyond the edges of a layer. The loops are nested so that invocations side by side integrate
// together and look for contours together; the rare second segment of a cell is a turn of its own.
float sum_beyond(Listed listed, uint layer, inout Scan scan) {
    ivec2 found = scan.at;
    vec4 depths = vec4(0.0);
    uint mask = 0u;
    uint segment = 0u;
    bool more = false;
    float beyond = 0.0;
    while (more || !(at_end(scan) || out_of_turns(0u))) {
        ++steps;
        segment = more ? segment + 1u : 0u;
        if (!more) next_contour(listed, layer, scan, found, depths, mask);
        beyond += segment_beyond(listed.view, listed.receiver, found, depths, mask, segment);
        edges_extracted += uint(segment < segment_count(mask));
        more = segment + 1u < segment_count(mask);
    }
    return beyond;
}

// The sub-light's area if its centre is hidden, asked of the contour itself (trap 1), or 0.
float centre_area(Listed listed, uint layer) {
    ivec2 cell = ivec2(floor(listed.receiver.t));
    bool inside = false;
    if (all(lessThan(uvec2(cell), uvec2(listed.view.map_size - 1u)))) {
        vec4 depths = depths_of(layer, cell);
        inside = inside_contour(cell, depths, mask_of(depths, listed.receiver.biased), listed.receiver.t);
    }
    return inside ? listed.view.area : 0.0;
}
