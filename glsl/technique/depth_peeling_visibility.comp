#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
// Visibility of the pixel list's pixels from several peeled layers of the shadow map [BCS08]: the areas that the
// layers' occluders hide add up, micropatches or contours.
#include "pass.glsl"
#include "depth.glsl"
#include "light.glsl"
#include "contour.glsl"
#include "kernel.glsl"
#include "count.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(binding = 0, scalar) readonly buffer FrameBlock { Frame frame; };
layout(binding = 1, scalar) readonly buffer Views { View views[]; };
layout(binding = 2, scalar) buffer Fits { Fit fits[]; };
layout(binding = 3) uniform texture2D position_world;
layout(binding = 4) uniform texture2D normal_world;
layout(binding = 5) uniform texture2D shadow_map;
layout(binding = 6) uniform texture2DArray layers;
layout(binding = 7, scalar) readonly buffer Kernels { Kernel kernels[]; };
layout(binding = 8, scalar) buffer Occlusion { float occlusion[]; };
layout(binding = 9, scalar) readonly buffer Sectors { float sectors[]; };
layout(binding = 10, scalar) buffer CountersBlock { Counters counters; };
layout(binding = 11, scalar) buffer ListsBlock { Lists lists[]; };
layout(binding = 12, scalar) readonly buffer Pixels { uint pixels[]; };
layout(binding = 13, scalar) buffer Partial { float partial[]; };
layout(binding = 14, scalar) buffer ProgressBlock { Progress progress[]; };
layout(binding = 15, scalar) buffer Rounds { Round rounds[]; };
#include "radial.glsl"
#include "listed.glsl"
#include "flat_contour.glsl"
#include "micropatch.glsl"
#include "flat_sum.glsl"

void add_up(Listed listed, uint layer, inout Scan scan, inout float sum) {
    if (CONTOURS) add_beyond(listed, layer, scan, -1.0, sum);
    else add_patches(listed, layer, scan, sum);
}

void main() {
    Listed listed;
    if (!find_listed(listed)) return;
    float hidden;
    // Patches stand on the texels at the corners of the kernel's dual cells.
    if (sum_kernel(listed, listed.first, listed.last + (CONTOURS ? 0 : 1), hidden)) {
        for (uint layer = 0u; layer < (CONTOURS ? LAYERS : 0u); ++layer) hidden += centre_area(listed, layer);
        conclude(listed, hidden / listed.view.area);
    }
    count_work();
}
