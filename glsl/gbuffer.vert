#version 460
#extension GL_GOOGLE_include_directive : require
// The g-buffer's vertices, three per triangle, so that what the triangle's pixels share is one value a triangle.
#include "pass.glsl"

readonly BUFFER(frame);
readonly BUFFER(positions);
readonly BUFFER(triangles);
readonly BUFFER(triangle_surfaces);
readonly BUFFER(texcoords);
readonly BUFFER(triangle_planes);
readonly BUFFER(vertex_colors);

layout(constant_id = 30) const bool ORTHOGRAPHIC = false;  // the camera's rays are parallel
layout(constant_id = 66) const bool COLORED = false;       // vertices have colours

layout(location = 0) flat out vec4 plane;    // unit normal of the front, and its product with any point of the triangle
layout(location = 1) flat out vec2 z_range;  // [scene units] of the corners along the view axis
layout(location = 2) out vec2 uv;
layout(location = 3) flat out uint surface_index;
layout(location = 4) out vec3 color;         // [0, 1] linear

void main() {
    uint triangle = uint(gl_VertexIndex) / 3u;
    uvec3 corner = triangles[triangle];
    vec3 z = vec3(dot(positions[corner.x], frame.forward), dot(positions[corner.y], frame.forward),
                  dot(positions[corner.z], frame.forward));
    plane = triangle_planes[triangle];
    z_range = vec2(min(z.x, min(z.y, z.z)), max(z.x, max(z.y, z.z)));
    uint vertex = corner[uint(gl_VertexIndex) % 3u];
    surface_index = triangle_surfaces[triangle];
    color = COLORED ? vertex_colors[vertex] : vec3(1.0);
    uv = TEXTURED ? texcoords[vertex] : vec2(0.0);
    // Reverse-Z from the eye at the origin, of a pinhole without a far plane.
    vec3 position = positions[vertex];
    float along = dot(position, frame.forward);
    vec2 depth = ORTHOGRAPHIC ? vec2((frame.far - along) / (frame.far - frame.near), 1.0) : vec2(frame.near, along);
    gl_Position = vec4(dot(position, frame.right), -dot(position, frame.up), depth);
}
