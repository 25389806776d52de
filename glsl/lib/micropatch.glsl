// Micropatches: each occluding texel of the shadow map is a rectangle parallel to the map at the texel's depth,
// and their back-projections' areas add up [Atty06, GBP06]; in coarser levels microrects may take their place (occluder_box.glsl).
// For techniques over the pixel list (pixel_list.glsl); needs radial.glsl.

#include "microrect.glsl"
#include "occluder_box.glsl"

layout(constant_id = 15) const bool GAP_FILLING = false;  // patches reach out to their neighbours

bool fills_gaps() { return GAP_FILLING && !MICRORECTS; }

// [half sizes²] The sub-light's area inside a box, for a sub-light that is one.
float area_of_boxes(View view, vec2 lower, vec2 upper) {
    vec2 size = max(min(upper, view.extent.zw) - max(lower, view.extent.xy), vec2(0.0));
    return size.x * size.y;
}

// [half sizes²] The sub-light's area inside a quadrangle of homogeneous light coordinates, counter-clockwise. sides: for
// each side, from corner i to i + 1, +1 if the centre is left of it, else −1.
float area_in_quadrangle(View view, vec3 corners[4], vec4 sides) {
    float area = all(greaterThan(sides, vec4(0.0))) ? view.area : 0.0;
    [[unroll]] for (int i = 0; i < 4; ++i) area -= area_beyond(view, corners[i], corners[(i + 1) & 3], sides[i]);
    return area;
}

// [half sizes²] What the patch at `texel` hides of the sub-light. depths: its own, its left neighbour's and its
// bottom neighbour's, its own again where the neighbour is no occluder. With GAP_FILLING the patch's left and
// bottom sides reach out to where the neighbours end, if that closes a gap [GBP06]; microrects do not.
// DEVIATION [GBP06]: seen from a side face a patch is no box on the light; there its corners move.
float patch_area(View view, Receiver receiver, ivec2 texel, vec3 depths) {
    Box box = box_at(texel);
    vec2 lower = box.lower - receiver.t;
    vec2 upper = box.upper - receiver.t;
    vec2 neighbours = fills_gaps() ? depths.yz : depths.xx;
    vec3 corners[4];
    if (OBLIQUE) {
        vec2 outer = vec2(lower.x > 0.0 ? max(depths.x, neighbours.x) : min(depths.x, neighbours.x),
                          lower.y > 0.0 ? max(depths.x, neighbours.y) : min(depths.x, neighbours.y));
        float corner = outer.x == depths.x ? outer.y : outer.x;
        corners[0] = back_project(receiver, lower, corner);
        corners[1] = back_project(receiver, vec2(upper.x, lower.y), outer.y);
        corners[2] = back_project(receiver, upper, depths.x);
        corners[3] = back_project(receiver, vec2(lower.x, upper.y), outer.x);
    } else {
        vec2 scale = vec2(receiver.ku.x, receiver.kv.y);
        lower = min(scale * lower / (depths.x - receiver.d), scale * lower / (neighbours - receiver.d));
        upper = scale * upper / (depths.x - receiver.d);
        corners[0] = vec3(lower, 1.0);
        corners[1] = vec3(upper.x, lower.y, 1.0);
        corners[2] = vec3(upper, 1.0);
        corners[3] = vec3(lower.x, upper.y, 1.0);
    }
    // A box keeps its corners' signs when it is projected.
    vec4 sides = vec4(lessThan(vec4(lower.y, -upper.x, -upper.y, lower.x), vec4(0.0))) * 2.0 - 1.0;
    // Called in one place: drivers inline it, and some take minutes for two.
    float area = 0.0;
    if (OBLIQUE || IS_CUT) area = area_in_quadrangle(view, corners, sides);
    else area = area_of_boxes(view, lower, upper);
    return area;
}

// `depth` if it belongs to an occluder, or else `own`.
float occluder_or(Receiver receiver, float depth, float own) { return depth > receiver.biased ? depth : own; }

// As `patch_area`, with the neighbours' depths read from the map; 0 where `depth` is, which stands for no patch.
float patch_area_at(uint layer, ivec2 texel, float depth) {
    vec3 depths = vec3(depth);
    if (fills_gaps()) {
        depths.y = occluder_or(pixel.receiver, depth_at(layer, max(texel - ivec2(1, 0), ivec2(0))), depth);
        depths.z = occluder_or(pixel.receiver, depth_at(layer, max(texel - ivec2(0, 1), ivec2(0))), depth);
        samples_read += depth > 0.0 ? 2u : 0u;
    }
    edges_extracted += uint(depth > 0.0);
    float area = patch_area(pixel.view, pixel.receiver, texel, depths);
    return depth > 0.0 ? area : 0.0;
}
