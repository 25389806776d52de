#version 450
// The casters of a view, as an engine draws them in hs_vk_draw: positions in the world, and the library's matrix.

layout(binding = 0) uniform View { mat4 clip_from_world; };
layout(location = 0) in vec3 position;

void main() { gl_Position = clip_from_world * vec4(position, 1.0); }
