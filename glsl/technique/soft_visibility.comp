#version 460
#extension GL_GOOGLE_include_directive : require
// The soft shadow map projected onto what is visible [Atty06 §3.1]: bilinear between those texels whose receivers the pixel does
// not lie before. A pixel before all of them is on an occluder, which receives no shadow. Of two maps, that of the occluders'
// tops and that of their bottoms, the darker counts [Atty06 §3.5].
#include "pass.glsl"
#include "side_by_side.glsl"
#include "bounds.glsl"
#include "casting.glsl"
#include "filtered.glsl"
#include "soft_shadow_map.glsl"

layout(constant_id = 47) const bool TWO_SIDED = false;  // there is a map of the shadows of bottoms

TEXTURE(receiver_map);
TEXTURE(soft_shadows);
TEXTURE(bottom_shadows);

// [share of d] By how much a pixel's plane may be farther away at a texel than at the pixel to be compared there: of the texels
// round a receiver one is always where its plane rises, and the walls of an occluder are not to reach the ground.
const float SLACK = 0.01;
// [share of d] Curvature and rounding.
const float TOLERANCE = 1e-3;

// Whether the pixel's plane lies no nearer to the light than the receiver of a texel. at: the texel's centre in the occluder map.
bool receives(Receiver pixel, vec2 at, float depth) {
    float own = pixel.d + max(rise_at(pixel, at), -SLACK * pixel.d);
    return depth > 0.0 && own <= (1.0 + TOLERANCE) * depth;
}

float hidden_share(View view, Fit fit, uvec2 pixel, Receiver receiver) {
    Grid grid = grid_of(view, fit);
    vec2 t = grid.focal * ((receiver.t - fit.center) / fit.focal) + grid.center;
    t = clamp(t, vec2(0.0), vec2(view.map_size - 1u));
    ivec2 first = min(ivec2(t), ivec2(view.map_size) - 2);
    vec2 share = t - vec2(first);
    float sum = 0.0;
    float weight = 0.0;
    [[unroll]] for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        ivec2 texel = first + corner;
        vec2 along = mix(1.0 - share, share, vec2(corner));
        vec2 at = fit.focal * ((vec2(texel) - grid.center) / grid.focal) + fit.center;
        float hidden = texelFetch(soft_shadows, texel, 0).x;
        if (TWO_SIDED) hidden = max(hidden, texelFetch(bottom_shadows, texel, 0).x);
        if (receives(receiver, at, receiver_of(texelFetch(receiver_map, texel, 0).x))) {
            sum += along.x * along.y * hidden;
            weight += along.x * along.y;
        }
    }
    return weight > 0.0 ? clamp(sum / weight, 0.0, 1.0) : 0.0;
}

uint samples_read_by_pixel() { return TWO_SIDED ? 12u : 8u; }
