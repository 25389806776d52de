// What light a surface point sends to the eye, and its encoding. Needs irradiance.glsl and the buffers `frame`, `lights`, `exposure`
// and `visibility`.

// Linear radiance of a diffuse surface; each light's unshadowed irradiance counts by the visibility that a pixel has of it. index:
// that pixel's.
vec3 shaded(vec3 position, vec3 normal, vec3 albedo_linear, uint index) {
    vec3 light_sum = vec3(exposure.ambient);
    for (uint i = 0u; i < exposure.light_count; ++i) {
        float seen = visibility[i * frame.size.x * frame.size.y + index];
        if (!(seen > 0.0)) continue;
        light_sum += seen * irradiance(lights[i], position, normal) / PI * lights[i].intensity;
    }
    return albedo_linear * light_sum * exposure.scale;
}

// Tone-mapped [Reinhard 2002, eq. 4], in [0, 1].
vec3 toned(vec3 color) {
    // Extended Reinhard on the brightest channel, white at 4: hues are kept.
    float peak = max(max(color.r, color.g), max(color.b, 1e-6));
    color *= (1.0 + peak / 16.0) / (1.0 + peak);
    return clamp(color, 0.0, 1.0);
}

// sRGB-encoded.
vec3 encoded(vec3 color) {
    return mix(12.92 * color, 1.055 * pow(color, vec3(1.0 / 2.4)) - 0.055, greaterThan(color, vec3(0.0031308)));
}
