// The farthest back faces of what casts, over the texels of the shadow map.

#define RESOURCE_bottom_map(AS) AS(51, texture2D, image2D, bottom_map)

// The depth that a map of the farthest holds where it stores 1 − d, so that the farthest is what its test keeps; 0 = empty.
float farthest_of(float stored) { return stored > 0.0 ? 1.0 - stored : 0.0; }
