// A technique that tests single samples of the map around a pixel's projection: an invocation for each pixel. The technique
// defines two functions, `hidden_share` and `samples_read_by_pixel`; the rest is here.

#include "receiver.glsl"
#include "count.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;

readonly BUFFER(frame);
readonly BUFFER(views);
readonly BUFFER(fits);
#include "shadow_map.glsl"

#include "surface.glsl"
#include "part_of_view.glsl"
#include "occlusion.glsl"

// [0, 1] Share of the sub-light that the technique holds for hidden.
float hidden_share(View view, Fit fit, uvec2 pixel, Receiver receiver);

// Depths that it reads for each pixel that the view looks at.
uint samples_read_by_pixel();

// The depth at the sample nearest to `t`; beyond the map it is empty.
float nearest_depth(View view, vec2 t) {
    ivec2 texel = ivec2(floor(clamp(t, vec2(-2.0), vec2(view.map_size + 1u)) + 0.5));
    if (any(greaterThanEqual(uvec2(texel), uvec2(view.map_size)))) return 0.0;
    return sample_of(view_index(), texel);
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    View view = views[view_index()];
    Fit fit = fits[view_index()];
    SurfacePoint point = surface_at(pixel);
    vec3 to_point = point.position - view.center;
    bool looked_at = point.exists && in_view(view, point.position, point.normal) && fit.level_count > 0u;
    float occluded = 0.0;
    // A loop, since some drivers execute both sides of an `if`: of the pixels of a side face most are another face's.
    [[dont_unroll]] for (uint once = 0u; once < uint(looked_at); ++once)
        occluded = view.weight * hidden_share(view, fit, pixel, project(view, fit, to_point, point.normal, point.error));
    if (!ACCUMULATE || looked_at) add_occluded(index_of(pixel), occluded);
    if (COUNT && looked_at) {
        samples_read = samples_read_by_pixel();
        atomicAdd(counters.pixels, 1u);
        count_work();
    }
}
