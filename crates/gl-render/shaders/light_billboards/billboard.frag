// The icon of a light over the finished picture, dimmed where something stands in front of it. Its texture coordinates
// are computed from the quad's corners.
#include "shared/inverse_bilinear.glsl"
in vec2 on_plane;
flat in vec4 first_two;
flat in vec4 last_two;

uniform sampler2DArray icons;    // r: ink, g: the disc under the ink
uniform sampler2D depth_and_id;
uniform float icon;              // layer of `icons`; below 0: a thin ring instead
uniform float px;                // a pixel as a share of half the quad's side
uniform vec4 ink;                // encoded sRGB, straight alpha
uniform float depth;             // depth of the icon along the gaze
uniform float softness;          // from this depth behind a surface on, the icon is dimmed fully

out vec4 over;                   // premultiplied, encoded

const float DIMMED = 0.35;
const float DISC = 0.55;

// The ring in the channels of `icons`: a line just inside the circle that fits into the quad, and a wider line under
// it.
vec2 ring() {
    vec2 middle = 0.5 * (first_two.xy + last_two.zw);
    float radius = length(on_plane - middle) / (0.5 * distance(first_two.xy, first_two.zw));
    float off_px = abs(radius - 1.0 + 2.0 * px) / px;
    return vec2(1.0 - smoothstep(0.3, 1.3, off_px), 1.0 - smoothstep(0.8, 2.0, off_px));
}

void main() {
    vec2 texel;
    if (icon < 0.0) {
        texel = ring();
    } else {
        vec2 uv = inverse_bilinear(on_plane, first_two.xy, first_two.zw, last_two.xy, last_two.zw);
        texel = texture(icons, vec3(uv, icon)).rg;
    }
    if (texel.g <= 0.0) discard;
    float there = texelFetch(depth_and_id, ivec2(gl_FragCoord.xy), 0).x;
    float hidden = there > 0.0 ? smoothstep(0.0, softness, depth - there) : 0.0;
    float alpha = (texel.r + (1.0 - texel.r) * texel.g * DISC) * ink.a * mix(1.0, DIMMED, hidden);
    float share = texel.r / max(texel.r + (1.0 - texel.r) * texel.g * DISC, 1e-4);
    over = vec4(ink.rgb * share * alpha, alpha);
}
