#version 460
#extension GL_GOOGLE_include_directive : require
// Visibility of the pixel list's pixels from several peeled layers of the shadow map [BCS08]: the areas that the
// layers' occluders hide add up, micropatches or contours. What the first layer hides from the light's centre is not missed;
// what two layers hide counts twice.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "pixel_list.glsl"
#include "radial.glsl"
#include "scan.glsl"
#include "flat_contour.glsl"
#include "micropatch.glsl"
#include "flat_micropatch.glsl"

void sum_layer(uint layer, inout Scan scan) {
    if (CONTOURS) sum_contours(layer, scan);
    else sum_patches(layer, scan);
}

// Patches stand on the texels at the corners of the kernel's dual cells.
Progress sum_kernel(Progress from) { return sum_layers(pixel.first, pixel.last + (CONTOURS ? 0 : 1), from); }

float hidden_share() {
    float hidden = sum[0];
    for (uint layer = 0u; layer < (CONTOURS ? LAYERS : 0u); ++layer)
        hidden += centre_area(pixel.view, pixel.receiver, layer);
    return share_of(hidden, pixel.view.area);
}
