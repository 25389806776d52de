#version 460
#extension GL_GOOGLE_include_directive : require
// The g-buffer's vertices, three per triangle, so that the geometric normal is one value a triangle.
#include "pass.glsl"

layout(binding = 0, scalar) readonly buffer FrameBlock { Frame frame; };
layout(binding = 1, scalar) readonly buffer Positions { vec3 positions[]; };
layout(binding = 2, scalar) readonly buffer Triangles { uvec3 triangles[]; };
layout(binding = 3, scalar) readonly buffer TriangleSurfaces { uint triangle_surfaces[]; };
layout(binding = 4, scalar) readonly buffer Texcoords { vec2 texcoords[]; };

layout(location = 0) out vec3 position;
layout(location = 1) flat out vec3 normal;
layout(location = 2) out vec2 uv;
layout(location = 3) flat out uint surface_index;

void main() {
    uint triangle = uint(gl_VertexIndex) / 3u;
    uvec3 corner = triangles[triangle];
    vec3 a = positions[corner.x];
    vec3 n = cross(positions[corner.y] - a, positions[corner.z] - a);
    normal = n / max(max(abs(n.x), abs(n.y)), max(abs(n.z), 1e-37));
    uint vertex = corner[uint(gl_VertexIndex) % 3u];
    position = positions[vertex];
    surface_index = triangle_surfaces[triangle];
    uv = TEXTURED ? texcoords[vertex] : vec2(0.0);
    // Reverse-Z without a far plane.
    vec3 from_eye = position - frame.eye;
    gl_Position = vec4(dot(from_eye, frame.right), -dot(from_eye, frame.up), frame.near, dot(from_eye, frame.forward));
}
