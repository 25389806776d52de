// Techniques that test single samples of the map around a pixel's projection. Needs the bindings `frame`, `views`,
// `fits`, `position_world`, `normal_world`, `shadow_map`, `occlusion` and `counters`; the technique defines
// `occluded_of`.

// [0, 1] Share of the sub-light that the technique holds for occluded.
float occluded_of(View view, Fit fit, uvec2 pixel, Receiver receiver);

// The depth at the sample nearest to `t`; beyond the map it is empty.
float nearest_depth(View view, vec2 t) {
    ivec2 texel = ivec2(floor(clamp(t, vec2(-2.0), vec2(view.map_size + 1u)) + 0.5));
    if (any(greaterThanEqual(uvec2(texel), uvec2(view.map_size)))) return 0.0;
    return texelFetch(shadow_map, texel, 0).x;
}

// A pixel of the view; `samples`: depths read for each pixel that the view looks at.
void filter_pixel(uint samples) {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    uint index = pixel.y * frame.size.x + pixel.x;
    View view = views[push.index];
    Fit fit = fits[push.index];
    vec4 position = texelFetch(position_world, ivec2(pixel), 0);
    vec3 normal = texelFetch(normal_world, ivec2(pixel), 0).xyz;
    vec3 to_point = position.xyz - view.center;
    bool looked_at = position.w > 0.0 && in_view(view, to_point, normal) && fit.level_count > 0u;
    float occluded = 0.0;
    // A loop, since some drivers execute both sides of an `if`: of the pixels of a side face most are another face's.
    [[dont_unroll]] for (uint once = 0u; once < uint(looked_at); ++once)
        occluded = view.weight * occluded_of(view, fit, pixel, project(view, fit, to_point, normal));
    if (!ACCUMULATE) occlusion[index] = occluded;
    else if (looked_at) occlusion[index] += occluded;
    if (COUNT && looked_at) {
        atomicAdd(counters.pixels, 1u);
        COUNT_WIDE(counters.samples_read, samples)
    }
}
