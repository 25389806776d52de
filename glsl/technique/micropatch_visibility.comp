#version 460
#extension GL_GOOGLE_include_directive : require
// Visibility of the pixel list's pixels from the back-projected texels of their kernels [GBP06]: the patches' areas add up,
// with what leaks between them and what they hide twice. In coarser levels microrects may take their place [Schwarz08 §5.2].
#include "pass.glsl"
#include "side_by_side.glsl"
#include "pixel_list.glsl"
#include "radial.glsl"
#include "scan.glsl"
#include "micropatch.glsl"
#include "flat_micropatch.glsl"

void sum_layer(uint layer, inout Scan scan) { sum_patches(layer, scan); }

// The texels at the corners of the kernel's dual cells.
Progress sum_kernel(Progress from) { return sum_layers(pixel.first, pixel.last + 1 + BOX_REACH, from); }

float hidden_share() { return share_of(sum[0], pixel.view.area); }
