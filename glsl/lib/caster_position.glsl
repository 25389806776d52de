// Casters as a view sees them: a vertex relative to the light's centre, and in the frame of the view's face (algorithm.md §1). Needs
// receiver.glsl.

layout(constant_id = 25) const bool RESIDUALS = false;  // casters' positions have residuals

readonly BUFFER(positions);
readonly BUFFER(position_residuals);

// What is near to the light is as exact as f32 is there, wherever positions are
// relative to: what their rounding left over is added to the difference.
vec3 caster_way(View view, uint vertex) {
    vec3 residual = RESIDUALS ? position_residuals[vertex] : vec3(0.0);
    precise vec3 way = (positions[vertex] - view.center) + (residual - view.center_residual);
    return way;
}

vec3 caster_position(View view, uint vertex) { return to_face(view, mapped(view, caster_way(view, vertex))); }
