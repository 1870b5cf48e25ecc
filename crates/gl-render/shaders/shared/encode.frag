// The last pass: encodes a style's finished picture as sRGB.
#include "shared/encode.glsl"
uniform sampler2D picture;     // straight alpha, display-linear
uniform float exposure;        // a factor

out vec4 encoded;              // straight alpha, sRGB

void main() {
    vec4 painted = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    encoded = vec4(srgb_from_linear(clamp(painted.rgb * exposure, 0.0, 1.0)), painted.a);
}
