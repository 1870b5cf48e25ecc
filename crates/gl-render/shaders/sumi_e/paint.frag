// Lays ink in the shape of the brush mark, on the stroke's own body and a little past it. The darkest ink stays; alpha
// counts overlaps.
#include "shared/stroke_shape.glsl"
in vec2 mark_at;
in vec2 from_center_px;
flat in vec4 ink;
flat in vec4 mark;
flat in vec4 body;
flat in vec2 own;
flat in vec4 form;
flat in float leaning;

uniform sampler2DArray brush_marks; // paint, height, tint
uniform sampler2D depth_and_id;
uniform float units_per_px_at_1; // world units per pixel at depth 1; at any depth if rays are parallel
uniform float orthographic;

out vec4 laid;

// FILL as in `impasto_core::brush`, FREE as in `Stroke::FREE`.
const float FILL = 0.84;
const float FREE = 1e6;

vec2 surface_at(vec2 at_px) {
    ivec2 texel = clamp(ivec2(floor(at_px)), ivec2(0), textureSize(depth_and_id, 0) - 1);
    return texelFetch(depth_and_id, texel, 0).xy;
}

// How much ink lies past the stroke's own body: a little, with a ragged edge; over bodies in front only a soft edge.
float past_body(vec2 here, float tint) {
    float bias = 2.0 * units_per_px_at_1 * mix(own.x, 1.0, orthographic);
    float away_px = length(from_center_px);
    vec2 inward = -from_center_px / max(away_px, 1e-3);
    float reach_px = body.z * (1.0 + 0.7 * tint);
    if (here.y != 0.0 && here.x < own.x - bias) reach_px = 0.35;
    float on_own = 0.0;
    for (int index = 0; index < 4; index++) {
        float back_px = clamp(reach_px + (float(index) - 1.5) * 0.7, 0.0, away_px);
        on_own += surface_at(gl_FragCoord.xy + inward * back_px).y == own.y ? 0.25 : 0.0;
    }
    return on_own;
}

void main() {
    vec2 quad_at = mark_at;
    float level = mark.y;
    if (form.x > 0.0) {
        quad_at = on_mark(mark_at, form, leaning);
        if (any(lessThan(quad_at, vec2(0.0))) || any(greaterThan(quad_at, vec2(1.0)))) discard;
        level = level_where_narrow(level, quad_at.x, form.z);
    }
    float u = quad_at.x;
    vec2 at = vec2(u, 0.5 + (quad_at.y - 0.5) * body.w);
    at.y -= mark.w * ((u - 0.5) * (u - 0.5) - 0.06) * 0.5 * FILL;
    vec3 texel = textureLod(brush_marks, vec3(at, mark.x), level).rgb;
    // Fei bai, "flying white": as the brush runs dry its hairs part, and the paper shows between them.
    float cut = mix(ink.a, 1.0 - 0.3 * (1.0 - ink.a), body.y * smoothstep(0.25, 1.0, u));
    float alpha = smoothstep(cut - mark.z, cut + mark.z, texel.r);
    if (alpha <= 0.0) discard;
    float tint = texel.b * 2.0 - 1.0;
    if (body.z < FREE) {
        vec2 here = surface_at(gl_FragCoord.xy);
        if (here.y != own.y) alpha *= past_body(here, tint);
    }
    // Pigment gathers at the edge, the brush gives less as it goes, and some hairs carry more than others.
    float edge = 1.0 - smoothstep(0.0, 0.16, texel.r - cut);
    float carried = (1.0 + 0.16 * edge) * mix(1.06, 0.78, u) * (1.0 + 0.20 * tint);
    vec3 taken = ink.rgb * (carried * alpha * body.x);
    laid = vec4(taken, 0.55 * max(max(taken.r, taken.g), taken.b));
}
