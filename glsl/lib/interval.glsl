// Closed intervals: x = the least, y = the greatest.

// Of v · a with v in a box.
vec2 dot_range(vec3 lower, vec3 upper, vec3 a) {
    vec3 from = lower * a;
    vec3 to = upper * a;
    return vec2(dot(min(from, to), vec3(1.0)), dot(max(from, to), vec3(1.0)));
}

vec2 product_range(vec2 a, vec2 b) {
    vec4 products = vec4(a.x * b, a.y * b);
    return vec2(min(min(products.x, products.y), min(products.z, products.w)),
                max(max(products.x, products.y), max(products.z, products.w)));
}

// The greatest size of what is in it.
float size_of(vec2 range) { return max(abs(range.x), abs(range.y)); }
