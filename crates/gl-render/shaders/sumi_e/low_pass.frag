// Passes 1 and 3 of the source (the effect that `styles/sumi_e.rs` names): the mean of nine pixels two apart, clamped
// at the picture's edges.
uniform sampler2D picture;

out vec4 blurred;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(picture, 0) - 1;
    vec4 sum = vec4(0.0);
    for (int index = 0; index < 9; index++) {
        ivec2 tap = at + (ivec2(index % 3, index / 3) - 1) * 2;
        sum += texelFetch(picture, clamp(tap, ivec2(0), last), 0);
    }
    blurred = sum / 9.0;
}
