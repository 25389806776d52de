// The micropatches in every texel of a kernel [GBP06], for techniques that scan (pixel_list.glsl, scan.glsl). Needs
// micropatch.glsl.

// Goes on to the next occluding texel and stays there; returns its depth, or 0 when there is none left.
float find_patch(uint layer, inout Scan scan) {
    float depth = 0.0;
    SEARCH_WHILE(depth == 0.0 && !at_end(scan)) {
        depth = occluder_or(pixel.receiver, box_depth(layer, scan.at), 0.0);
        if (depth == 0.0) advance(scan);
        ++nodes_visited;
        ++samples_read;
    }
    return depth;
}

// Adds the areas of a layer's patches up. The loops are nested so that invocations side by side look for occluders
// together and add up together.
void sum_patches(uint layer, inout Scan scan) {
    REPEAT_WHILE(!at_end(scan)) {
        float depth = find_patch(layer, scan);
        sum[0] += patch_area_at(layer, scan.at, depth);
        if (depth > 0.0) advance(scan);
    }
}
