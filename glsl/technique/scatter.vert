#version 460
#extension GL_GOOGLE_include_directive : require
// A rectangle of the soft shadow map for each texel of the occluder map, its micropatch's penumbra extent; none where it is empty.
#include "pass.glsl"
#include "bounds.glsl"
#include "casting.glsl"
#include "soft_shadow_map.glsl"

layout(constant_id = 46) const bool BOTTOM_PATCHES = false;  // patches have bottoms

readonly BUFFER(views);
readonly BUFFER(fits);
#include "shadow_map.glsl"
TEXTURE(bottom_map);
readonly BUFFER(penumbra_extents);

// In light widths per unit of depth, so that a difference over one of depths is one of places on the light [0, 1]².
layout(location = 0) flat out vec4 patch_bounds;  // lower and upper corner of the patch, seen from the light's centre
layout(location = 1) flat out vec4 texel_place;   // scale and offset from a texel's place in the window to what its receiver is seen under
layout(location = 2) flat out vec4 depths;        // the light's centre on the light; the patch's depth and that of its bottom

void main() {
    View view = views[push.index];
    Fit fit = fits[push.index];
    Grid grid = grid_of(view, fit);
    uvec2 extent = penumbra_extents[gl_InstanceIndex];
    uvec2 first = uvec2(extent.x & 0xffffu, extent.x >> 16);
    uvec2 end = uvec2(extent.y & 0xffffu, extent.y >> 16) + 1u;
    // Two triangles, of corners 0 1 2 and 3 2 1.
    uint corner = gl_VertexIndex < 3 ? uint(gl_VertexIndex) : 6u - uint(gl_VertexIndex);
    vec2 window = vec2((corner & 1u) != 0u ? end.x : first.x, (corner & 2u) != 0u ? end.y : first.y);
    gl_Position = vec4(window * (2.0 / float(view.map_size)) - 1.0, 0.5, 1.0);

    ivec2 texel = ivec2(gl_InstanceIndex % int(view.map_size), gl_InstanceIndex / int(view.map_size));
    vec4 box = light_box(view);
    vec2 scale = fit.near / (view.half_size * (box.zw - box.xy));
    patch_bounds = (vec4(vec2(texel) - 0.5, vec2(texel) + 0.5) - fit.center.xyxy) / fit.focal.xyxy * scale.xyxy;
    texel_place = vec4(scale / grid.focal, -(grid.center + 0.5) / grid.focal * scale);
    float top = sample_of(push.index, texel);
    float bottom = farthest_of(texelFetch(bottom_map, texel, 0).x);
    vec2 own = push.level == 0u ? vec2(top, BOTTOM_PATCHES ? bottom : 0.0) : vec2(bottom, 0.0);
    depths = vec4(-box.xy / (box.zw - box.xy), own);
}
