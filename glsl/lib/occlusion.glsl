// The image that all views of a light add to, whatever the technique: the weighted share of the light that is occluded. What each view
// has found is kept apart where pixels are joined from others, and where views are side by side, for add_up.comp to add it in their order.
// Needs part_of_view.glsl.

#include "share.glsl"

BUFFER(occlusion);
BUFFER(occluded_by_view);

// A view's word on a pixel; occluded: its weight times the share of the sub-light that is occluded.
void add_occluded(uint pixel, float occluded) {
    if (SIDE_BY_SIDE || EVALUATE > 0u) occluded_by_view[first_pixel() + pixel] = occluded;
    if (SIDE_BY_SIDE) return;
    if (ACCUMULATE || QUALITY != QUALITY_FINEST) occlusion[pixel] += occluded;
    else occlusion[pixel] = occluded;
}
