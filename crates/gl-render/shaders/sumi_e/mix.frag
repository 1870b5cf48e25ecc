// Pass 4 of the source (the effect that `styles/sumi_e.rs` names): adds up how much each picture darkens. It computes
// in sRGB values, as they are stored.
#include "shared/encode.glsl"
#include "sumi_e/paper.glsl"
uniform sampler2D interior;
uniform sampler2D silhouette;
uniform vec4 background;         // alpha 0 where the paper is left out

out vec4 mixed;                  // straight alpha, display-linear

// In Direct3D 9 a pixel's centre lies where four texels meet. So a pixel is the mean of its own texel and of those to
// its left, above it, and above left. At the left and upper edge of the picture the interior is clamped, and the
// silhouette wraps around.
float at_corner(sampler2D picture, bool wraps) {
    ivec2 size = textureSize(picture, 0);
    ivec2 at = ivec2(gl_FragCoord.xy);
    float sum = 0.0;
    for (int index = 0; index < 4; index++) {
        ivec2 tap = at + ivec2(-(index & 1), index >> 1);
        tap = wraps ? (tap + size) % size : clamp(tap, ivec2(0), size - 1);
        sum += texelFetch(picture, tap, 0).r;
    }
    return sum * 0.25;
}

void main() {
    vec3 c1 = vec3(at_corner(interior, false));
    vec3 c2 = vec3(at_corner(silhouette, true));
    vec3 c3 = background.a > 0.0 ? bare_paper(felt(paper_at(gl_FragCoord.xy))) : vec3(1.0);
    vec3 laid = 1.0 - clamp((1.0 - c1) + (1.0 - c2) + (1.0 - c3), 0.0, 1.0);
    mixed = background.a > 0.0 ? vec4(linear_from_srgb(laid), 1.0) : vec4(vec3(0.0), 1.0 - laid.r);
}
