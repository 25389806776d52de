#version 460
#extension GL_GOOGLE_include_directive : require
// One instance of a host's mesh, moved to its place and appended to the casters' triangles. Whatever the host's indices are,
// nothing is read or written outside of the mesh.
#include "pass.glsl"

layout(local_size_x = GROUP_SIZE) in;

readonly BUFFER(instances);
readonly BUFFER(host_vertices);
readonly BUFFER(host_indices);
writeonly BUFFER(positions);
writeonly BUFFER(triangles);

vec3 position_of(Instance instance, uint vertex) {
    uint word = instance.vertex_word_first + vertex * instance.vertex_words;
    vec4 local = vec4(uintBitsToFloat(host_vertices[word]), uintBitsToFloat(host_vertices[word + 1u]),
                      uintBitsToFloat(host_vertices[word + 2u]), 1.0);
    // Products with the identity's zeros and ones are exact, so that a mesh that stands in the world keeps its bits.
    precise vec3 world = vec3(dot(instance.transform[0], local), dot(instance.transform[1], local),
                              dot(instance.transform[2], local));
    return world;
}

// An index that is out of range names the last vertex: what it draws is wrong, what it reads is there.
uint corner(Instance instance, uint index) {
    uint vertex = index;
    if (instance.index_bytes == 4u) vertex = host_indices[instance.index_first + index];
    if (instance.index_bytes == 2u) {
        uint at = instance.index_first + index;
        vertex = (host_indices[at / 2u] >> (16u * (at % 2u))) & 0xffffu;
    }
    return instance.position_first + min(vertex, instance.vertex_count - 1u);
}

void main() {
    Instance instance = instances[push.index];
    uint stride = gl_NumWorkGroups.x * GROUP_SIZE;
    for (uint vertex = gl_GlobalInvocationID.x; vertex < instance.vertex_count; vertex += stride)
        positions[instance.position_first + vertex] = position_of(instance, vertex);
    for (uint triangle = gl_GlobalInvocationID.x; triangle < instance.triangle_count; triangle += stride)
        triangles[instance.triangle_first + triangle] =
            uvec3(corner(instance, 3u * triangle), corner(instance, 3u * triangle + 1u), corner(instance, 3u * triangle + 2u));
}
