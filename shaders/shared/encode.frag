// Puts the ground under the picture and encodes it to sRGB, straight alpha.
uniform sampler2D picture;     // premultiplied, display-linear
uniform vec4 ground;           // premultiplied, display-linear

out vec4 encoded;

vec3 srgb_from_linear(vec3 linear) {
    vec3 low = linear * 12.92;
    vec3 high = 1.055 * pow(max(linear, 0.0), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(linear, vec3(0.0031308)));
}

void main() {
    vec4 above = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    vec4 both = above + (1.0 - above.a) * ground;
    vec3 straight = both.rgb / max(both.a, 1e-6);
    encoded = vec4(srgb_from_linear(clamp(straight, 0.0, 1.0)), both.a);
}
