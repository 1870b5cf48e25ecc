// How a stroke's colour is mixed from the colour that `resolve.vert` finds at its place. Colours are Oklab. A jitter,
// temperature or grading of 0 changes nothing.
#ifdef PALETTES
uniform sampler2D palettes;      // a row per palette: pigments in Oklab; w: how far colours keep to it, 0 past the end

const uint ANY_COLOR = 255u;
#endif

// Standard deviations from stroke to stroke, by layer: lightness, hue in degrees, chroma as a share.
const vec3 JITTER[8] = vec3[8](
    vec3(0.020, 7.0, 0.10), vec3(0.007, 3.5, 0.06), vec3(0.005, 3.0, 0.05),
    vec3(0.012, 8.0, 0.06), vec3(0.004, 3.0, 0.05), vec3(0.004, 3.0, 0.05),
    vec3(0.005, 2.0, 0.04), vec3(0.004, 2.0, 0.04)
);

struct Mixing {
    float jitter;
    float temperature;
    float grading;
    uint palette;
};

Mixing mixing_of(uint bytes) {
    return Mixing(
        float(bytes & 255u) / 25.5,
        float((bytes >> 8) & 255u) / 25.5,
        float((bytes >> 16) & 255u) / 255.0,
        bytes >> 24
    );
}

uint scramble(uint value) {
    uint state = value * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

// A random number with mean 0 and standard deviation 1, from four bytes of a hash.
float normal_from(uint bits, uint which) {
    uint hash = scramble(bits ^ scramble(which));
    float sum = float(hash & 255u) + float((hash >> 8) & 255u) + float((hash >> 16) & 255u) + float(hash >> 24);
    return (sum / 255.0 - 2.0) * 1.7320508;
}

// Reduces lightness to planes: steps with soft edges.
float planes(float lightness) {
    float at = (lightness + 0.03) * 11.0 - 0.5;
    return (floor(at) + smoothstep(0.1, 0.9, fract(at)) + 0.5) / 11.0 - 0.03;
}

vec3 graded(vec3 lab, vec3 wide, int kind) {
    if (kind == UNDERPAINTING) {
        // Pulled towards earth colours.
        return vec3(0.14 + 0.78 * (lab.x - 0.10), lab.yz * 0.78 + vec2(0.009, 0.014));
    }
    if (kind == ACCENTS) lab = wide + (lab - wide) * 1.45;
    if (kind == LIGHTS) lab.x += 0.043;
    // A contour line is a darker tone of the body that it bounds.
    if (kind == CONTOUR) lab = vec3(0.62 * lab.x, lab.yz * 1.1);
    float lightness = mix(lab.x, planes(lab.x), 0.25);
    // Darks keep some colour and never turn black.
    float dark = 1.0 - smoothstep(0.16, 0.42, lightness);
    float chroma = 1.06 + 0.16 * dark;
    return vec3(clamp(lightness, 0.13 + 0.3 * max(lightness - 0.13, -0.1), 0.985), lab.yz * chroma);
}

#ifdef PALETTES
vec3 from_palette(vec3 lab, uint palette) {
    const int MOST = 16;
    vec2 distances[MOST];
    float least = 1e9;
    for (int index = 0; index < MOST; index++) {
        vec4 pigment = texelFetch(palettes, ivec2(index, int(palette)), 0);
        vec3 away = (pigment.xyz - lab) * vec3(0.35, 1.0, 1.0);
        distances[index] = vec2(pigment.w, dot(away, away));
        if (pigment.w > 0.0) least = min(least, distances[index].y);
    }
    // Two pigments that are equally near are mixed, so that nothing jumps.
    vec2 sum = vec2(0.0);
    float weight = 0.0;
    for (int index = 0; index < MOST; index++) {
        float share = distances[index].x * exp(-(distances[index].y - least) / 0.0012);
        sum += texelFetch(palettes, ivec2(index, int(palette)), 0).yz * share;
        weight += share;
    }
    float mix_in = texelFetch(palettes, ivec2(0, int(palette)), 0).w;
    return vec3(lab.x, mix(lab.yz, sum / max(weight, 1e-6), mix_in));
}
#endif

// `wide` is the mean over a wider neighbourhood, `drift` slow noise over the surface.
vec3 mixed(vec3 lab, vec3 wide, int kind, Mixing mixing, uvec2 bits_and_drift) {
    float drift = uintBitsToFloat(bits_and_drift.y);
    uint bits = bits_and_drift.x;
    lab = mix(lab, graded(lab, wide, kind), mixing.grading);
    float light = smoothstep(0.25, 0.70, lab.x);
    // Light is warmer, shadow cooler.
    lab.yz += mixing.temperature * mix(vec2(-0.002, -0.008), vec2(0.003, 0.008), light);
#ifdef PALETTES
    if (mixing.palette != ANY_COLOR) lab = from_palette(lab, mixing.palette);
#endif
    vec3 deviation = JITTER[kind] * mixing.jitter;
    float value = normal_from(bits, 1u) * deviation.x * mix(0.55, 1.0, light) + 0.006 * mixing.jitter * drift;
    float turn = radians(normal_from(bits, 2u) * deviation.y * mix(1.25, 0.8, light) + 3.0 * mixing.jitter * drift);
    float chroma = exp(normal_from(bits, 3u) * deviation.z);
    float c = cos(turn), s = sin(turn);
    lab.yz = mat2(c, s, -s, c) * lab.yz * chroma;
    lab.yz += vec2(normal_from(bits, 4u) * 0.0035, normal_from(bits, 5u) * 0.0045) * mixing.jitter;
    lab.x += value;
    return lab;
}
