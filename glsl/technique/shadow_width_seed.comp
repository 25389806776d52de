#version 460
#extension GL_GOOGLE_include_directive : require
// The beginning of the shadow-width map [Kirsch03 §4, the inverted occlusion map]: 0 where nothing is drawn, the largest width
// elsewhere; for jump flooding the texel itself, or none.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "shadow_width.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(views);
readonly BUFFER(fits);
#include "shadow_map.glsl"
writeonly BUFFER(shadow_widths);

void main() {
    View view = views[view_index()];
    Fit fit = fits[view_index()];
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    // A view without casters is not read.
    if (fit.level_count == 0u || !in_map(texel, view.map_size)) return;
    bool hidden = sample_of(view_index(), texel) > 0.0;
    float widest = max(width_of(view, fit, vec2(START, 0.0)), width_of(view, fit, vec2(0.0, START)));
    vec2 seed = hidden ? vec2(-1.0) : vec2(texel);
    shadow_widths[place_of(texel, 0u, view.map_size)] = FLOOD ? seed : vec2(hidden ? widest : 0.0, 0.0);
}
