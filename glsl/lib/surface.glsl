// The visible surface as the g-buffer has it, a point for each pixel. Needs the buffer `frame`.

layout(constant_id = 29) const bool GIVEN_SURFACE = false;  // a host has the surface already

TEXTURE(position_world);
TEXTURE(normal_world);

struct SurfacePoint {
    // [scene units] Relative to the eye.
    vec3 position;
    // Unit vector: geometric normal of the visible side.
    vec3 normal;
    // There is a surface.
    bool exists;
    // [scene units] By how much the position may be off, beyond what 32 bits round off.
    float error;
};

SurfacePoint surface_at(uvec2 pixel) {
    vec4 position = texelFetch(position_world, ivec2(pixel), 0);
    return SurfacePoint(position.xyz, texelFetch(normal_world, ivec2(pixel), 0).xyz, position.w > 0.0,
                        GIVEN_SURFACE ? position.w : 0.0);
}

// Pixels are numbered row by row.
uvec2 pixel_at(uint index) { return uvec2(index % frame.size.x, index / frame.size.x); }

uint index_of(uvec2 pixel) { return pixel.y * frame.size.x + pixel.x; }
