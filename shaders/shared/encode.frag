// A finished picture over the background, encoded.
#include "shared/encode.glsl"
uniform sampler2D picture;     // premultiplied, display-linear
uniform vec4 background;       // premultiplied, display-linear

out vec4 encoded;

void main() {
    encoded = encode_over(texelFetch(picture, ivec2(gl_FragCoord.xy), 0), background);
}
