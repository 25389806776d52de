#version 460
#extension GL_GOOGLE_include_directive : require
// The share of the light that a micropatch hides from a texel's receiver [Atty06 §3.4, §4.2]: its back-projection is a rectangle,
// as the light is. Blending adds the shares of all patches up. With a bottom, the share of either rectangle.
#include "pass.glsl"
#include "bounds.glsl"
#include "casting.glsl"
#include "soft_shadow_map.glsl"

layout(constant_id = 46) const bool BOTTOM_PATCHES = false;  // patches have bottoms

TEXTURE(receiver_map);

layout(location = 0) flat in vec4 patch_bounds;
layout(location = 1) flat in vec4 texel_place;
layout(location = 2) flat in vec4 depths;

layout(location = 0) out float hidden;

// What is left on the light, [0, 1]², of the back-projection of a patch that is nearer by `difference`; nothing if it is not.
vec4 on_light(vec4 seen, float difference) {
    return difference > 0.0 ? clamp(seen / difference + depths.xyxy, 0.0, 1.0) : vec4(0.0);
}

float area_of(vec4 box) {
    vec2 size = max(box.zw - box.xy, vec2(0.0));
    return size.x * size.y;
}

void main() {
    float receiver = receiver_of(texelFetch(receiver_map, ivec2(gl_FragCoord.xy), 0).x);
    vec4 seen = patch_bounds - (texel_place.xy * gl_FragCoord.xy + texel_place.zw).xyxy;
    vec4 top = on_light(seen, depths.z - receiver);
    float area = area_of(top);
    if (BOTTOM_PATCHES) {
        vec4 bottom = on_light(seen, depths.w - receiver);
        area += area_of(bottom) - area_of(vec4(max(top.xy, bottom.xy), min(top.zw, bottom.zw)));
    }
    hidden = receiver > 0.0 ? area : 0.0;
}
