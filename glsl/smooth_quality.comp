#version 460
#extension GL_GOOGLE_include_directive : require
// Levels of quality smoothed along rows, then along columns, over 11 pixels each [Schwarz08 §4.2]: their mean as far as the surface
// goes on and is penumbra. So levels change little from pixel to pixel and no pixel takes part in what another surface needs.
// DEVIATION [Schwarz08 §4.2]: a surface ends where it is more than a share of its distance from the light off the planes of its
// neighbours, not where depth changes: what is seen at a grazing angle goes on.
#include "pass.glsl"
#include "side_by_side.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(constant_id = 54) const bool COLUMNS = false;  // rows otherwise

readonly BUFFER(frame);
readonly BUFFER(views);
readonly BUFFER(kernels);
BUFFER(quality);
BUFFER(quality_rows);

#include "surface.glsl"

// [pixel] To both sides.
const int REACH = 5;
// [share of the distance from the light] Off the plane of the pixel before.
const float OFF_PLANE = 0.02;

bool goes_on(View view, SurfacePoint from, SurfacePoint to) {
    vec3 way = to.position - from.position;
    float off = max(abs(dot(from.normal, way)), abs(dot(to.normal, way)));
    return off <= OFF_PLANE * distance(to.position, view.center);
}

bool is_penumbra(ivec2 pixel) {
    return all(lessThan(uvec2(pixel), frame.size)) && kernels[index_of(uvec2(pixel))].status == KERNEL_PENUMBRA;
}

float level_at(ivec2 pixel) {
    uint index = index_of(uvec2(pixel));
    return COLUMNS ? quality_rows[index] : quality[index];
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!is_penumbra(pixel)) return;
    View view = views[view_index()];
    float sum = level_at(pixel);
    float count = 1.0;
    for (int way = -1; way <= 1; way += 2) {
        SurfacePoint before = surface_at(uvec2(pixel));
        for (int i = 1; i <= REACH; ++i) {
            ivec2 next = pixel + way * (COLUMNS ? ivec2(0, i) : ivec2(i, 0));
            if (!is_penumbra(next)) break;
            SurfacePoint point = surface_at(uvec2(next));
            if (!goes_on(view, before, point)) break;
            sum += level_at(next);
            ++count;
            before = point;
        }
    }
    uint index = index_of(uvec2(pixel));
    if (COLUMNS) quality[index] = sum / count;
    else quality_rows[index] = sum / count;
}
