// Blurs the glow along one axis with a Gaussian.
uniform sampler2D gathered;
uniform vec2 axis;
uniform float sigma;             // in pixels of `gathered`

out vec4 spread;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(gathered, 0) - 1;
    int reach = int(ceil(3.0 * sigma));
    vec3 sum = vec3(0.0);
    float weight = 0.0;
    for (int step = -reach; step <= reach; step++) {
        float near = exp(-0.5 * float(step * step) / (sigma * sigma));
        ivec2 tap = at + ivec2(axis) * step;
        // Beyond the picture it is dark.
        bool inside = all(greaterThanEqual(tap, ivec2(0))) && all(lessThanEqual(tap, last));
        sum += inside ? texelFetch(gathered, tap, 0).rgb * near : vec3(0.0);
        weight += near;
    }
    spread = vec4(sum / weight, 0.0);
}
