// Casters as a view sees them. Needs the bindings `positions` and `position_residuals`.

// A vertex in the frame of the view's face. What is near to the light is as exact as f32 is there, wherever positions are
// relative to: what their rounding left over is added to the difference.
vec3 caster_position(View view, uint vertex) {
    vec3 residual = RESIDUALS ? position_residuals[vertex] : vec3(0.0);
    precise vec3 way = (positions[vertex] - view.center) + (residual - view.center_residual);
    return to_face(view, way);
}
