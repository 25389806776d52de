// The image that all views of a light add to, whatever the technique: the weighted share of the light that is occluded. Views side by
// side keep what they have found apart, for add_up.comp to add in their order. Needs part_of_view.glsl.

#include "share.glsl"

BUFFER(occlusion);
writeonly BUFFER(occluded_by_view);

// A view's word on a pixel; occluded: its weight times the share of the sub-light that is occluded.
void add_occluded(uint pixel, float occluded) {
    if (SIDE_BY_SIDE) occluded_by_view[first_pixel() + pixel] = occluded;
    else if (ACCUMULATE || QUALITY != QUALITY_FINEST) occlusion[pixel] += occluded;
    else occlusion[pixel] = occluded;
}
