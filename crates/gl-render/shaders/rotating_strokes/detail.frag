// How much detail each body has, in blocks of a few pixels: change of colour or turn of the surface, outlines,
// highlights. The result is blurred widely afterwards, so that small strokes come and go slowly when a shadow sweeps
// over them.
#include "shared/oklab.glsl"
uniform sampler2D reference_color;
uniform sampler2D depth_and_id;
#include "rotating_strokes/surface.glsl"
uniform sampler2D glint;
uniform sampler2D normal;            // and gloss
uniform float px_scale;              // output pixels per pixel of the scene's own size
uniform mat4 view_from_world;
uniform int block_px;                // side of a block

out vec4 detail;                     // change or turn, outline, highlight; a: body id; its fraction: 0.499 × the
                                     // body's share of the block

// Change of Oklab per pixel of the scene's own size: no detail below the first, full detail above the second.
const vec2 CHANGE = vec2(0.004, 0.034);
// The weight of an edge of colour. An edge is narrow, so it counts more than a turn, which goes on for longer.
const float EDGE = 1.6;
// How fast the surface turns, summed over x and y, radians per pixel of the scene's own size: no detail below the
// first, full detail above the second. In the middle of a ball of 100 px radius it is 0.02.
const vec2 TURN = vec2(0.012, 0.050);
// A leap of the depth within a body, as a share of the depth: no outline below the first, an outline above the second.
const vec2 LEAP = vec2(0.01, 0.03);

void main() {
    ivec2 last = textureSize(depth_and_id, 0) - 1;
    ivec2 block = ivec2(gl_FragCoord.xy) * block_px;
    // A block has the detail of its foremost body only. That body's share of sixteen taps is the weight of the block
    // in all means, so that thin bodies fade in and out.
    ivec2 taps[5];
    vec2 front = vec2(0.0);
    for (int index = 0; index < 5; index++) {
        ivec2 offset = index == 4 ? ivec2(block_px / 2) : ivec2(index & 1, index >> 1) * (block_px - 1);
        taps[index] = min(block + offset, last);
        vec2 there = texelFetch(depth_and_id, taps[index], 0).xy;
        if (there.y != 0.0 && (front.y == 0.0 || there.x < front.x)) front = there;
    }
    float share = 0.0;
    vec2 shares[16];
    for (int index = 0; index < 16; index++) {
        shares[index] = surface_at(vec2(block) + (vec2(index & 3, index >> 2) + 0.5) * (0.25 * float(block_px)));
        vec2 there = shares[index];
        if (there.y != 0.0 && (front.y == 0.0 || there.x < front.x)) front = there;
    }
    for (int index = 0; index < 16; index++) share += shares[index].y == front.y ? 0.0625 : 0.0;
    detail = vec4(0.0);
    if (front.y == 0.0) return;
    int reach_px = max(int(round(2.0 * px_scale)), 1);
    int rim_px = max(int(round(3.0 * px_scale)), 1);
    float count = 0.0;
    float outline = 0.0;
    for (int index = 0; index < 5; index++) {
        ivec2 at = taps[index];
        if (texelFetch(depth_and_id, at, 0).y != front.y) continue;
        count += 1.0;
        vec3 here = oklab_from_linear(texelFetch(reference_color, at, 0).rgb);
        vec3 slopes[2] = vec3[2](vec3(0.0), vec3(0.0));
        vec3 facing = texelFetch(normal, at, 0).xyz;
        float turn = 0.0;
        for (int axis = 0; axis < 2; axis++) {
            ivec2 next = min(at + ivec2(1 - axis, axis) * reach_px, last);
            // The turn is taken over a distance so large that the mesh's facets do not count. Where the body is
            // narrower than this distance, no turn is added.
            ivec2 far = ivec2(1 - axis, axis) * (3 * reach_px);
            ivec2 ends[2] = ivec2[2](max(at - far, ivec2(0)), min(at + far, last));
            if (texelFetch(depth_and_id, ends[0], 0).y == front.y && texelFetch(depth_and_id, ends[1], 0).y == front.y) {
                vec3 turned = texelFetch(normal, ends[1], 0).xyz - texelFetch(normal, ends[0], 0).xyz;
                turn += length(turned) * (px_scale / float(6 * reach_px));
            }
            if (texelFetch(depth_and_id, next, 0).y != front.y) continue;
            slopes[axis] = (oklab_from_linear(texelFetch(reference_color, next, 0).rgb) - here) * (px_scale / float(reach_px));
        }
        float change = sqrt(dot(slopes[0], slopes[0]) + dot(slopes[1], slopes[1]));
        float of_color = clamp((change - CHANGE.x) / (CHANGE.y - CHANGE.x), 0.0, 1.0);
        // Near its outline every surface turns fast per pixel, so the turn is converted to turn per length of surface.
        turn *= clamp((mat3(view_from_world) * facing).z, 0.0, 1.0);
        float of_form = clamp((turn - TURN.x) / (TURN.y - TURN.x), 0.0, 1.0);
        detail.r += max(EDGE * of_color, of_form);
        detail.b += texelFetch(glint, at, 0).r;
        if (index == 4) continue;
        ivec2 outward = (ivec2(index & 1, index >> 1) * 2 - 1) * rim_px;
        vec2 there = texelFetch(depth_and_id, clamp(at + outward, ivec2(0), last), 0).xy;
        // A border with something in front of the body is not its outline.
        if (there.y != front.y) {
            if (there.y == 0.0 || there.x > front.x) outline += 0.5;
            continue;
        }
        // The place at `outward` is on the body too. It counts as past an outline if the body's part here stands
        // in front of its part there: the depth then leaps by more than the surface's slope explains.
        float depth = texelFetch(depth_and_id, at, 0).x;
        vec2 before = texelFetch(depth_and_id, clamp(at - outward, ivec2(0), last), 0).xy;
        float leap = there.x - depth - (before.y == front.y ? max(depth - before.x, 0.0) : 0.0);
        outline += 0.5 * smoothstep(LEAP.x, LEAP.y, leap / depth);
    }
    detail = vec4(detail.r / max(count, 1.0), min(outline, 1.0), detail.b / max(count, 1.0), front.y + 0.499 * share);
}
