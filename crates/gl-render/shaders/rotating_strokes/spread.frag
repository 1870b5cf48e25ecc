// Blurs the detail of each body within that body: a Gaussian, one axis at a time.
uniform sampler2D detail;            // change or turn, outline, highlight; a: body id; its fraction: half the body's
                                     // share of the block
uniform vec2 axis;                   // the step from one tap to the next, in texels

out vec4 spread;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(detail, 0) - 1;
    vec4 here = texelFetch(detail, at, 0);
    float weight = 2.0 * fract(here.a);
    vec3 sum = here.rgb * weight;
    for (int index = 1; index <= 4; index++) {
        float share = exp(-0.5 * float(index * index) / 4.0);
        for (int side = -1; side <= 1; side += 2) {
            ivec2 tap = at + ivec2(round(axis * float(index * side)));
            vec4 there = texelFetch(detail, clamp(tap, ivec2(0), last), 0);
            if (floor(there.a) != floor(here.a)) continue;
            float counted = share * 2.0 * fract(there.a);
            sum += there.rgb * counted;
            weight += counted;
        }
    }
    spread = vec4(sum / max(weight, 1e-4), here.a);
}
