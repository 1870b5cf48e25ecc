// How much happens on each body, in blocks of a few pixels: change of colour, outlines, highlights. What is decided by it is
// spread wide afterwards, so that small strokes come and go slowly when a shadow sweeps over them.
#include "shared/oklab.glsl"
uniform sampler2D reference_color;
uniform sampler2D depth_and_id;
uniform sampler2D glint;
uniform float px_scale;              // output pixels per pixel of the scene's own size
uniform int block_px;                // side of a block

out vec4 detail;                     // change of colour 0..1, outline 0..1, highlight 0..1, body id

// Oklab per pixel of the scene's own size: below the first nothing happens, from the second on much.
const vec2 CHANGE = vec2(0.004, 0.034);

void main() {
    ivec2 last = textureSize(depth_and_id, 0) - 1;
    ivec2 block = ivec2(gl_FragCoord.xy) * block_px;
    vec2 middle = texelFetch(depth_and_id, min(block + block_px / 2, last), 0).xy;
    detail = vec4(0.0, 0.0, 0.0, middle.y);
    if (middle.y == 0.0) return;
    int reach_px = max(int(round(2.0 * px_scale)), 1);
    int rim_px = max(int(round(3.0 * px_scale)), 1);
    for (int index = 0; index < 4; index++) {
        ivec2 at = min(block + ivec2(index & 1, index >> 1) * max(block_px / 2, 1), last);
        if (texelFetch(depth_and_id, at, 0).y != middle.y) continue;
        vec3 here = oklab_from_linear(texelFetch(reference_color, at, 0).rgb);
        vec3 slopes[2] = vec3[2](vec3(0.0), vec3(0.0));
        for (int axis = 0; axis < 2; axis++) {
            ivec2 next = min(at + ivec2(1 - axis, axis) * reach_px, last);
            if (texelFetch(depth_and_id, next, 0).y != middle.y) continue;
            slopes[axis] = (oklab_from_linear(texelFetch(reference_color, next, 0).rgb) - here) * (px_scale / float(reach_px));
        }
        float change = sqrt(dot(slopes[0], slopes[0]) + dot(slopes[1], slopes[1]));
        detail.r += 0.25 * clamp((change - CHANGE.x) / (CHANGE.y - CHANGE.x), 0.0, 1.0);
        ivec2 outward = (ivec2(index & 1, index >> 1) * 2 - 1) * rim_px;
        vec2 there = texelFetch(depth_and_id, clamp(at + outward, ivec2(0), last), 0).xy;
        // What stands in front of the body makes no outline of its own.
        if (there.y != middle.y && (there.y == 0.0 || there.x > middle.x)) detail.g += 0.5;
        detail.b += 0.25 * min(texelFetch(glint, at, 0).r, 1.0);
    }
    detail.g = min(detail.g, 1.0);
}
