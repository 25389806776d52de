// Textures in a buffer of RGBA8 texels: one code for every driver, and for the ray tracer's twin.

readonly BUFFER(surfaces);
readonly BUFFER(texels);

int wrapped(int texel, int size, uint wrap) {
    if (wrap == 2u) return clamp(texel, 0, size - 1);
    int turn = wrap == 1u ? 2 * size : size;
    int at = texel % turn;
    at = at < 0 ? at + turn : at;
    return at < size ? at : 2 * size - 1 - at;
}

vec4 texel_at(Surface surface, ivec2 texel) {
    ivec2 size = ivec2(surface.texture_size);
    int x = wrapped(texel.x, size.x, surface.wrap.x);
    int y = wrapped(texel.y, size.y, surface.wrap.y);
    return unpackUnorm4x8(texels[surface.texture_first + uint(y * size.x + x)]);
}

// The surface's colour (sRGB-encoded as stored) and alpha at `uv`, without the base colour factor.
vec4 texture_at(Surface surface, vec2 uv) {
    if (surface.texture_size.x == 0u) return vec4(1.0);
    vec2 at = uv * vec2(surface.texture_size);
    if (surface.linear == 0u) return texel_at(surface, ivec2(floor(at)));
    at -= 0.5;
    ivec2 texel = ivec2(floor(at));
    vec2 share = at - vec2(texel);
    vec4 top = mix(texel_at(surface, texel), texel_at(surface, texel + ivec2(1, 0)), share.x);
    vec4 bottom = mix(texel_at(surface, texel + ivec2(0, 1)), texel_at(surface, texel + ivec2(1, 1)), share.x);
    return mix(top, bottom, share.y);
}

// Whether light passes through the surface at `uv` (alphaMode MASK).
bool is_hole(Surface surface, vec2 uv) {
    return surface.alpha_cutoff > 0.0
        && surface.base_color.a * texture_at(surface, uv).a < surface.alpha_cutoff;
}
