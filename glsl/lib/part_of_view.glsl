// Where views that are looked at side by side keep their lists and what they know of each pixel: in a slot each. A view that is alone has
// the first. Needs the buffer `frame` and side_by_side.glsl.

layout(constant_id = 68) const bool SIDE_BY_SIDE = false;  // views are looked at side by side, not only their maps made

uint part_of_view(uint count) { return SIDE_BY_SIDE ? slot_of(view_index()) * count : 0u; }

uint first_pixel() { return part_of_view(frame.size.x * frame.size.y); }

uint first_tile() {
    uvec2 tiles = (frame.size + TILE_SIZE - 1u) / TILE_SIZE;
    return part_of_view(tiles.x * tiles.y);
}

uint first_window() { return first_tile() * (TILE_SIZE * TILE_SIZE / WINDOW_PIXELS_MIN); }
