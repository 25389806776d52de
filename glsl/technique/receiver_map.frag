#version 460
#extension GL_GOOGLE_include_directive : require
// Which surfaces receive: not where they have holes, and, where everything casts, not the backs of closed ones, so front faces
// alone. These are moved towards the light by the slope bias as well, for what receives may be what casts.
#include "pass.glsl"
#include "texture.glsl"
#include "casting.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint surface_index;
layout(location = 2) flat in vec2 bias;

void main() {
    vec2 slope = abs(vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z)));
    if (TEXTURED && is_hole(surfaces[surface_index], uv)) discard;
    if (!TELLS_CASTERS && !gl_FrontFacing) discard;
    float depth = 1.0 - gl_FragCoord.z;
    float moved = min(dot(slope, bias), BIAS_SLOPE_MAX * depth) + BIAS_ROUNDING * (1.0 + depth);
    gl_FragDepth = TELLS_CASTERS ? gl_FragCoord.z : max(gl_FragCoord.z - moved, 1e-6);
}
