// Paint over its ground, encoded. Under an underpainting the ground is toned: where a body is, it carries a quiet wash
// of the body's own colour, so that a chink between strokes never shows bare ground.
#include "shared/encode.glsl"
uniform sampler2D picture;           // premultiplied, display-linear
uniform sampler2D reference_color;   // alpha 1 where a body is
uniform vec4 ground;                 // premultiplied, display-linear
uniform float wash;                  // 0 bare ground .. 1 the body's own colour

out vec4 encoded;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 body = texelFetch(reference_color, at, 0);
    vec4 toned = ground;
    // Ground that is left out (transparent) stays out.
    toned.rgb = mix(ground.rgb, body.rgb * vec3(0.90, 0.85, 0.80), wash * body.a * ground.a);
    encoded = encode_over(texelFetch(picture, at, 0), toned);
}
