// The contour in every dual cell of a kernel [GBP07, as re-implemented in Yang09 §6], for techniques that scan
// (pixel_list.glsl, scan.glsl). Needs radial.glsl.

// Goes on to the next cell with a contour and stays there; returns its mask, or 0 when there is none left.
uint find_contour(uint layer, inout Scan scan) {
    uint mask = 0u;
    SEARCH_WHILE(segment_count(mask) == 0u && !at_end(scan)) {
        mask = occluding(pixel.receiver, scan.at, depths_of(layer, scan.at));
        if (segment_count(mask) == 0u) advance(scan);
        ++nodes_visited;
        samples_read += 4u;
    }
    return mask;
}

// Takes what lies beyond the edges of a layer's contours from the sum. The loops are nested so that invocations side by side
// look for contours together and integrate together; the rare second segment of a cell is a turn of its own.
void sum_contours(uint layer, inout Scan scan) {
    uint segment = 0u;
    REPEAT_WHILE_PENDING(segment > 0u, segment > 0u || !at_end(scan)) {
        uint mask = find_contour(layer, scan);
        vec4 depths = depths_of(layer, scan.at);
        sum[0] -= segment_beyond(pixel.view, pixel.receiver, scan.at, depths, mask, segment);
        edges_extracted += uint(segment < segment_count(mask));
        bool more = segment + 1u < segment_count(mask);
        segment = more ? 1u : 0u;
        if (!more && segment_count(mask) > 0u) advance(scan);
    }
}
