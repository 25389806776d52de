// [0, 1] The share of a light's shine that goes along a way from its centre (`Beam` of scene/light/beam.rs).
float beam_share(Light light, vec3 way) {
    float cosine = dot(light.beam, way) * inversesqrt(max(dot(way, way), 1e-36));
    float root = clamp(1.0 - (light.beam_start - cosine) * light.beam_slope, 0.0, 1.0);
    return root * root;
}
