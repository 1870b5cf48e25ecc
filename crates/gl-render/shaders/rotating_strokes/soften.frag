// Averages the height of the paint, at half the picture's size. The average tells thin paint from thick; the height
// compared with it tells furrows from ridges.
uniform sampler2D height;
uniform float step_px;           // pixels of the full size

out vec4 softened;

void main() {
    vec2 texel = 1.0 / vec2(textureSize(height, 0));
    vec2 at = gl_FragCoord.xy * 2.0 * texel;
    float sum = 0.0;
    for (int index = 0; index < 4; index++) {
        vec2 offset = (vec2(index & 1, index >> 1) * 2.0 - 1.0) * step_px;
        sum += textureLod(height, at + offset * texel, 0.0).r;
    }
    softened = vec4(sum * 0.25);
}
