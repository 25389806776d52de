// The map that takes a sun's sub-light to the centre of a disc and rays through it to lines through that centre
// (scene/light/sun.rs): with the height h of a point over the plane and the place x where its ray meets it, relative to
// `view.center`, the point is at L / h (x + L n). It keeps lines and planes. Needs `dot_exact`.

layout(constant_id = 60) const bool PARALLEL = false;  // the light is a sun

// [scene units] How high a point is over the plane.
float height_of(View view, vec3 to_point) { return -dot_exact(to_point, view.light_n); }

// Where the view sees a point; what is not seen by a sun stays where it is.
vec3 mapped(View view, vec3 to_point) {
    if (!PARALLEL) return to_point;
    float height = height_of(view, to_point);
    precise vec3 at = (to_point + view.ray * height + view.light_n * view.parallel) * (view.parallel / height);
    return at;
}

// The normal of the plane through a point, of some length.
vec3 mapped_normal(View view, vec3 to_point, vec3 normal) {
    if (!PARALLEL) return normal;
    precise vec3 across = normal - view.light_n * dot_exact(normal, view.light_n);
    precise vec3 at = across - view.light_n * (dot_exact(normal, to_point) / view.parallel);
    return at;
}
