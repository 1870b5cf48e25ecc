// A finished picture over the background.
uniform sampler2D picture;     // premultiplied, display-linear
uniform vec4 background;       // premultiplied, display-linear

out vec4 laid;                 // straight alpha, display-linear

void main() {
    vec4 paint = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    vec4 both = paint + (1.0 - paint.a) * background;
    laid = vec4(both.rgb / max(both.a, 1e-6), both.a);
}
