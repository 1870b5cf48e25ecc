// The glow at a quarter of the size: each pixel is the mean of the 4 x 4 pixels of `glow` that it covers.
uniform sampler2D glow;

out vec4 gathered;

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * 4;
    ivec2 last = textureSize(glow, 0) - 1;
    vec3 sum = vec3(0.0);
    for (int index = 0; index < 16; index++)
        sum += texelFetch(glow, min(first + ivec2(index & 3, index >> 2), last), 0).rgb;
    gathered = vec4(sum / 16.0, 0.0);
}
