// Adds the blurred glow to the picture. It is light, and hides nothing.
uniform sampler2D gathered;

out vec4 color;

void main() {
    // A pixel of the glow covers 4 × 4 pixels of the picture, counted from the lower left.
    vec2 at = gl_FragCoord.xy / (4.0 * vec2(textureSize(gathered, 0)));
    color = vec4(texture(gathered, at).rgb, 0.0);
}
