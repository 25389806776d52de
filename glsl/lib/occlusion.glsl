// The image that all views of a light add to, whatever the technique: the weighted share of the light that is occluded.

#include "share.glsl"

BUFFER(occlusion);
BUFFER(view_occlusion);

// A view's word on a pixel; occluded: its weight times the share of the sub-light that is occluded.
void add_occluded(uint pixel, float occluded) {
    if (ACCUMULATE || QUALITY != QUALITY_FINEST) occlusion[pixel] += occluded;
    else occlusion[pixel] = occluded;
    if (EVALUATE > 0u) view_occlusion[pixel] = occluded;
}
