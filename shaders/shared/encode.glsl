// Lays premultiplied paint over the background and encodes to sRGB, straight alpha.
vec3 srgb_from_linear(vec3 linear) {
    vec3 low = linear * 12.92;
    vec3 high = 1.055 * pow(max(linear, 0.0), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(linear, vec3(0.0031308)));
}

// Both premultiplied and display-linear.
vec4 encode_over(vec4 paint, vec4 background) {
    vec4 both = paint + (1.0 - paint.a) * background;
    vec3 straight = both.rgb / max(both.a, 1e-6);
    return vec4(srgb_from_linear(clamp(straight, 0.0, 1.0)), both.a);
}
