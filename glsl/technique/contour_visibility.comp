#version 460
#extension GL_GOOGLE_include_directive : require
// Visibility of the pixel list's pixels from the contour in every dual cell of their kernels [GBP07, as re-implemented in
// Yang09 §6]. Right for all occluders that the centre of the sub-light sees, but for those that overlap on the light.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "pixel_list.glsl"
#include "radial.glsl"
#include "scan.glsl"
#include "flat_contour.glsl"

void sum_layer(uint layer, inout Scan scan) { sum_contours(layer, scan); }

Progress sum_kernel(Progress from) { return sum_layers(pixel.first, pixel.last, from); }

float hidden_share() { return share_of(sum[0] + centre_area(pixel.view, pixel.receiver, 0u), pixel.view.area); }
