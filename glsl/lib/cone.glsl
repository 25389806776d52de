// Cones of receivers around a light that shines to all sides: cells of the sides of a cube, seen from its centre. Every receiver
// is in one of them, whatever rounding does; those inside the light are in none.

// sphere: centre and radius.
uint cone_of(vec4 sphere, vec3 position) {
    vec3 way = position - sphere.xyz;
    if (dot(way, way) <= sphere.w * sphere.w) return ALL_CONES;
    vec3 size = abs(way);
    uint axis = size.x >= max(size.y, size.z) ? 0u : size.y >= size.z ? 1u : 2u;
    vec3 turned = axis == 0u ? way : axis == 1u ? way.yzx : way.zxy;
    precise vec2 share = 0.5 * (turned.yz / max(abs(turned.x), 1e-30)) + 0.5;
    uvec2 cell = uvec2(clamp(share * float(CONE_SPLIT), 0.0, float(CONE_SPLIT - 1u)));
    uint side = 2u * axis + uint(turned.x < 0.0);
    return 1u + (side * CONE_SPLIT + cell.y) * CONE_SPLIT + cell.x;
}
