// Finds where a point lies in a quad, as `impasto_core::inverse_bilinear` does. The comments there explain the formula,
// and say for which quads it holds.
float wedge(vec2 a, vec2 b) {
    return a.x * b.y - a.y * b.x;
}

// over / under, clamped to -10,000..10,000; 0 / 0 is 0.
float bounded_ratio(float over, float under) {
    const float FARTHEST = 1e4;
    if (abs(over) < abs(under) * FARTHEST) return over / under;
    if (over == 0.0) return 0.0;
    return (over < 0.0) == (under < 0.0) ? FARTHEST : -FARTHEST;
}

// (u, v) of a point in a quad, wound either way. Its corners p0 to p3 have (u, v) = (0, 0), (1, 0), (0, 1) and (1, 1).
vec2 inverse_bilinear(vec2 point, vec2 p0, vec2 p1, vec2 p2, vec2 p3) {
    vec2 q = point - p0;
    vec2 b1 = p1 - p0;
    vec2 b2 = p2 - p0;
    vec2 b3 = p0 - p1 - p2 + p3;
    float a = wedge(b2, b3);
    float b = wedge(b3, q) - wedge(b1, b2);
    float c = wedge(b1, q);
    float winding = wedge(p3 - p0, p2 - p1) < 0.0 ? -1.0 : 1.0;
    float root = winding * sqrt(max(b * b - 4.0 * a * c, 0.0));
    float v = winding * b > 0.0 ? bounded_ratio(-b - root, 2.0 * a) : bounded_ratio(2.0 * c, root - b);
    vec2 over = q - b2 * v;
    vec2 under = b1 + b3 * v;
    float u = abs(under.x) > abs(under.y) ? bounded_ratio(over.x, under.x) : bounded_ratio(over.y, under.y);
    return vec2(u, v);
}
