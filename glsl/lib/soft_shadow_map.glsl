// The soft shadow map [Atty06] and the maps that it is made of. It is seen from the light's centre as the occluder map is, which
// is the view's shadow map, but reaches as far as shadows of its texels fall on visible receivers; the receiver map has the same
// texels. Depths are d = near / z (algorithm.md §1). Needs bounds.glsl and casting.glsl.

#include "bottom_map.glsl"

#define RESOURCE_receiver_map(AS) AS(50, texture2D, image2D, receiver_map)
#define RESOURCE_penumbra_extents ARRAY(52, uvec2, penumbra_extents)
#define RESOURCE_soft_shadows(AS) AS(53, texture2D, image2D, soft_shadows)
#define RESOURCE_bottom_shadows(AS) AS(54, texture2D, image2D, bottom_shadows)

// An extent without texels: its first is beyond its last.
const uvec2 NO_EXTENT = uvec2(0x00010001u, 0u);

// Places of texels: t = focal · tangent + center, as those of `Fit`.
struct Grid {
    vec2 focal;
    vec2 center;
};

// The rectangle that stands for the sub-light [half sizes]: the sub-light itself, or one of the same area and middle for a disc
// and what a disc's rim cuts.
vec4 light_box(View view) {
    vec2 middle = 0.5 * (view.extent.xy + view.extent.zw);
    vec2 size = view.extent.zw - view.extent.xy;
    vec2 reach = 0.5 * size * sqrt(view.area / (size.x * size.y));
    return vec4(middle - reach, middle + reach);
}

// How far tangents of a box of receivers reach to the upper side, given its coordinate and depths there.
float tangent_of(float side, float least, float most) { return side / max(side > 0.0 ? least : most, 1e-30); }

// The grid of the soft shadow map: between what the penumbrae of all casters reach and where receivers are.
Grid grid_of(View view, Fit fit) {
    vec4 box = light_box(view);
    float most = value_of(fit.receiver_bounds[2], 1.0);
    float least = -value_of(fit.receiver_bounds[5], 0.0);
    vec2 spread = view.half_size * max(1.0 / fit.near - 1.0 / most, 0.0);
    vec2 upper, lower;
    for (int axis = 0; axis < 2; ++axis) {
        float reached = value_of(fit.caster_bounds[axis], 0.0) - box[axis] * spread[axis];
        float reached_back = value_of(fit.caster_bounds[axis + 2], 0.0) + box[axis + 2] * spread[axis];
        upper[axis] = min(reached, tangent_of(value_of(fit.receiver_bounds[axis], 0.0), least, most));
        lower[axis] = max(-reached_back, -tangent_of(value_of(fit.receiver_bounds[axis + 3], 0.0), least, most));
    }
    Grid grid;
    // The outermost texels are beyond, for what is interpolated.
    grid.focal = (float(view.map_size) - 2.0) / max(upper - lower, vec2(1e-5));
    grid.center = 0.5 * (float(view.map_size) - 1.0) - grid.focal * 0.5 * (lower + upper);
    return grid;
}

// The depth of a texel's receiver; 0 = none.
float receiver_of(float stored) { return TELLS_CASTERS ? stored : farthest_of(stored); }
