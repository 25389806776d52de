#version 460
#extension GL_GOOGLE_include_directive : require
// Adds what views side by side have found occluded, in their order, so that the sum has the bits of views one after another; and takes it
// away for the next. Views that have nothing to say about a pixel have left 0 there. Dispatched over the pixels of each view: the first
// one's invocations do it for all.
#include "pass.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(frame);
BUFFER(occlusion);
BUFFER(occluded_by_view);

#include "surface.glsl"

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size)) || gl_WorkGroupID.z > 0u) return;
    uint index = index_of(pixel);
    float sum = occlusion[index];
    for (uint i = 0u; i < gl_NumWorkGroups.z; ++i) {
        uint at = slot_of(push.index + i) * frame.size.x * frame.size.y + index;
        sum += occluded_by_view[at];
        occluded_by_view[at] = 0.0;
    }
    occlusion[index] = sum;
}
