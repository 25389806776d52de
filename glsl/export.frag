#version 460
#extension GL_GOOGLE_include_directive : require
// The visibility as a host's image: the same in all channels, and the background's where there is no surface.
#include "pass.glsl"

readonly BUFFER(frame);
readonly BUFFER(host);
readonly BUFFER(visibility);

layout(location = 0) out vec4 result;

void main() {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    float value = visibility[pixel.y * frame.size.x + pixel.x];
    // NaN is no surface, and compares false.
    result = vec4(value >= 0.0 ? value : host.background);
}
