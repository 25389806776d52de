// A light as a receiver sees it: flat.

struct Facing {
    // With the plane and the half sizes that the receiver sees.
    Light light;
    // [scene units] From the receiver to the light's centre; of a sun's disc at a distance of 1.
    vec3 way;
    // [scene units] Coordinates that the way is found from.
    vec3 magnitude;
    // The disc's area over that which the light's `intensity` goes with.
    float area;
    // The receiver is inside the light.
    bool inside;
};

// The disc through a sphere's centre that faces a receiver and hides the same of the sky.
void face_sphere(inout Facing facing, vec3 normal) {
    float square = dot(facing.way, facing.way);
    float radius = facing.light.half_size.x;
    float beyond = square - radius * radius;
    facing.inside = !(beyond > 0.0);
    facing.area = square / max(beyond, 1e-6 * square);
    facing.light.half_size *= sqrt(facing.area);
    facing.light.n = -facing.way * inversesqrt(max(square, 1e-36));
    // The axis that the normal leans along, or any.
    vec3 lean = normal - facing.light.n * dot(normal, facing.light.n);
    vec3 least = abs(facing.light.n.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    lean = dot(lean, lean) > 1e-6 ? lean : least - facing.light.n * dot(least, facing.light.n);
    facing.light.v = normalize(lean);
    facing.light.u = cross(facing.light.v, facing.light.n);
}

Facing facing_of(Light light, vec3 position, vec3 normal) {
    vec3 way = light.center - position;
    Facing facing = Facing(light, way, abs(way) + abs(light.center), 1.0, false);
    if (light.spread == SPREAD_SUN) {
        facing.way = -light.n;
        facing.magnitude = abs(light.n);
    }
    if (light.spread == SPREAD_SPHERE) face_sphere(facing, normal);
    return facing;
}
