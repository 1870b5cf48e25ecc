// Colours a body by noise. Several layers of one texture move against each other and are multiplied: T = Π X·Y, where X
// and Y are two lookups per layer, one moved along x, the other along y. The colour is T to the power `exponent`, times
// the tint.
in vec2 texture_at;

uniform sampler2D layer_noise;   // repeats
uniform int layer_count;         // k: the layers are 1 .. k - 1
uniform vec2 tiling;
uniform vec2 tile_offset;
uniform vec2 travelled;          // how far layers moved, texture lengths mod 1; y is 0 unless they go round a circle
uniform float speed;
uniform float first_way;         // way of the first layer: 1 forward, -1 backward
uniform float exponent;
uniform vec4 tint;               // linear, may be brighter than 1; A the opacity
uniform float alpha_is_grey;
uniform float bloom;
uniform float threshold;

layout(location = 0) out vec4 color;    // premultiplied, display-linear
layout(location = 1) out vec4 glint;    // strength 0, with the alpha of the look: hides the highlights behind it
layout(location = 2) out vec4 highlight; // as `glint`
layout(location = 3) out vec4 glow;     // premultiplied

vec4 noise_at(vec2 at) {
    vec4 texel = texture(layer_noise, at);
    return vec4(texel.rgb, mix(texel.a, texel.r, alpha_is_grey));
}

void main() {
    vec2 at = texture_at * tiling + tile_offset;
    // A sum of logarithms, because the product of many layers would underflow.
    vec4 product_ln2 = vec4(0.0);
    float way = first_way;
    for (int index = 1; index < layer_count; index++) {
        float share = float(index) / float(layer_count);
        vec2 along_x = vec2(travelled.x + speed * share, travelled.y) * way;
        vec2 along_y = vec2(travelled.y, travelled.x + speed * share) * way;
        product_ln2 += log2(max(noise_at(at + share + along_x), 1e-30));
        product_ln2 += log2(max(noise_at(at + share + along_y), 1e-30));
        way = -way;
    }
    vec4 layered = clamp(exp2(product_ln2 * exponent), 0.0, 1.0) * tint;
    float alpha = layered.a;
    color = vec4(layered.rgb * alpha, alpha);
    glint = vec4(0.0, 0.0, 0.0, alpha);
    highlight = glint;
    float brightest = max(layered.r, max(layered.g, layered.b));
    float beyond = max(brightest - threshold, 0.0) / max(brightest, 1e-6);
    glow = vec4(layered.rgb * (beyond * bloom * alpha), alpha);
}
