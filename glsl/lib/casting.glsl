// Which triangles cast shadows, where a shot tells them from others.

layout(constant_id = 45) const bool TELLS_CASTERS = false;  // some triangles cast no shadows

readonly BUFFER(triangle_casts);

bool casts(uint triangle) {
    return !TELLS_CASTERS || (triangle_casts[triangle >> 5] >> (triangle & 31u) & 1u) != 0u;
}
