// sRGB values from linear ones, and back.
vec3 srgb_from_linear(vec3 linear) {
    vec3 low = linear * 12.92;
    vec3 high = 1.055 * pow(max(linear, 0.0), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(linear, vec3(0.0031308)));
}

// For styles that compute in sRGB values, 0..1. A value almost halfway between two bytes is first moved towards the
// nearer one, by a hundredth of a byte at most. Otherwise a driver's rounding on the way there and back could give the
// other byte.
vec3 linear_from_srgb(vec3 encoded) {
    vec3 nearest = roundEven(encoded * 255.0);
    encoded = clamp(encoded * 255.0, nearest - 0.49, nearest + 0.49) / 255.0;
    vec3 high = pow((encoded + 0.055) / 1.055, vec3(2.4));
    return mix(high, encoded / 12.92, lessThanEqual(encoded, vec3(0.04045)));
}
