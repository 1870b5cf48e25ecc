// Four tones with soft steps between them, in a texture one texel high: interpolated, and clamped at its ends.
uniform sampler2D tones;

float tone_at(float light) {
    int count = textureSize(tones, 0).x;
    float at = clamp(light * float(count) - 0.5, 0.0, float(count - 1));
    int first = int(floor(at));
    int second = min(first + 1, count - 1);
    float dark = texelFetch(tones, ivec2(first, 0), 0).r;
    float bright = texelFetch(tones, ivec2(second, 0), 0).r;
    return mix(dark, bright, at - float(first));
}
