// A finished picture over its ground, encoded.
#include "shared/encode.glsl"
uniform sampler2D picture;     // premultiplied, display-linear
uniform vec4 ground;           // premultiplied, display-linear

out vec4 encoded;

void main() {
    encoded = encode_over(texelFetch(picture, ivec2(gl_FragCoord.xy), 0), ground);
}
