// The rectangles that hide light at the level that an invocation reads. Needs map.glsl and microrect.glsl.

// [texel] Beyond the last corner of a kernel's cells, as far as rectangles reach back into it.
const int BOX_REACH = MICRORECTS ? 1 : 0;

// [texel] Lower and upper corner, in places of the level that is read.
struct Box {
    vec2 lower;
    vec2 upper;
};

bool reads_microrects() { return MICRORECTS && reads_coarse_map(); }

Microrect microrect_at(ivec2 place) {
    ivec2 texel = place - coarse_margin(level_of_quality);
    bool inside = all(lessThan(uvec2(texel), uvec2(coarse_side(level_of_quality, coarse_map_size))));
    Microrect rect = microrects[inside ? coarse_index(texel, level_of_quality, coarse_map_size) : 0u];
    rect.depth = inside ? rect.depth : 0.0;
    return rect;
}

// The depth of a texel's rectangle.
float box_depth(uint layer, ivec2 texel) {
    float depth = 0.0;
    if (reads_microrects()) depth = microrect_at(texel).depth;
    else depth = depth_at(layer, texel);
    return depth;
}

Box box_at(ivec2 texel) {
    Box box = Box(vec2(texel) - 0.5, vec2(texel) + 0.5);
    if (reads_microrects()) {
        Microrect rect = microrect_at(texel);
        vec2 reference = vec2((texel - coarse_margin(level_of_quality)) << level_of_quality);
        box.lower = coarse_place(reference + vec2(offset_of(rect.first)) - 0.5, level_of_quality);
        box.upper = coarse_place(reference + vec2(offset_of(rect.last)) + 0.5, level_of_quality);
    }
    return box;
}
