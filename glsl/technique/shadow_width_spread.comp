#version 460
#extension GL_GOOGLE_include_directive : require
// A pass that spreads widths over the map, `push.level` of SPREADS. From three or six neighbours: the least of a texel's width
// and of its neighbours' plus the way to them, at a distance that doubles [Kirsch03 §4]. By jump flooding: the nearest of the
// texels that eight neighbours know, at a distance that halves [RT06]; exact but for rare texels that are off by a fraction.
// DEVIATION [Kirsch03 §4]: what a neighbour adds is the length of the way, for texels are not square and neighbours at 60° lie on
// no grid.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "shadow_width.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(views);
readonly BUFFER(fits);
BUFFER(shadow_widths);

const vec2 DIRECTIONS[6] = vec2[6](vec2(1.0, 0.0), vec2(0.5, 0.8660254), vec2(-0.5, 0.8660254), vec2(-1.0, 0.0),
                                   vec2(-0.5, -0.8660254), vec2(0.5, -0.8660254));

// The least width by way of neighbours; what lies beyond the map is not hidden.
vec2 least(View view, Fit fit, ivec2 texel) {
    float distance = float(1u << push.level);
    float width = shadow_widths[place_of(texel, push.level, view.map_size)].x;
    [[dont_unroll]] for (uint i = 0u; i < 6u; i += NEIGHBOURS == 0u ? 2u : 1u) {
        vec2 way = floor(distance * DIRECTIONS[i] + 0.5);
        ivec2 at = texel + ivec2(way);
        ivec2 held = clamp(at, ivec2(0), ivec2(view.map_size - 1u));
        float known = shadow_widths[place_of(held, push.level, view.map_size)].x;
        width = min(width, (at == held ? known : 0.0) + width_of(view, fit, way));
    }
    return vec2(width, 0.0);
}

// The nearest of the texels that eight neighbours and the texel itself know.
vec2 nearest(View view, Fit fit, ivec2 texel) {
    int distance = 1 << (SPREADS - 1u - push.level);
    vec2 best = vec2(-1.0);
    float width = 1e30;
    [[dont_unroll]] for (int i = 0; i < 9; ++i) {
        ivec2 at = texel + distance * ivec2(i % 3 - 1, i / 3 - 1);
        ivec2 held = clamp(at, ivec2(0), ivec2(view.map_size - 1u));
        vec2 known = shadow_widths[place_of(held, push.level, view.map_size)];
        float far = known.x < 0.0 ? 1e30 : width_of(view, fit, vec2(texel) - known);
        best = far < width ? known : best;
        width = min(width, far);
    }
    return best;
}

void main() {
    View view = views[view_index()];
    Fit fit = fits[view_index()];
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (fit.level_count == 0u || !in_map(texel, view.map_size)) return;
    vec2 found = FLOOD ? nearest(view, fit, texel) : least(view, fit, texel);
    // The last pass of flooding measures how far what it has found is.
    if (FLOOD && push.level + 1u == SPREADS) found = vec2(width_of(view, fit, vec2(texel) - found), 0.0);
    shadow_widths[place_of(texel, push.level + 1u, view.map_size)] = found;
}
