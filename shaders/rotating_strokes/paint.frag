// Paint where the brush mark is, near its own body.
in vec2 tip_at;
in vec2 from_center_px;
flat in vec4 paint;
flat in vec3 tip;
flat in vec2 own;

uniform sampler2DArray tips;     // height of the mark, half-mixed paint across the hairs
uniform sampler2D depth_and_id;
uniform float overrun_px;        // how far paint may run past its own body
uniform float units_per_px_at_1; // world units per pixel at depth 1; at any depth where parallel
uniform float orthographic;

out vec4 over;

const float SOFT = 0.08;
const float OPACITY = 0.96;

vec2 surface_at(vec2 at_px) {
    ivec2 texel = clamp(ivec2(floor(at_px)), ivec2(0), textureSize(depth_and_id, 0) - 1);
    return texelFetch(depth_and_id, texel, 0).xy;
}

void main() {
    vec2 at = tip.z > 0.0 ? tip_at : vec2(tip_at.x, 1.0 - tip_at.y);
    vec2 mark = textureLod(tips, vec3(at, tip.x), tip.y).rg;
    float alpha = smoothstep(paint.a - SOFT, paint.a + SOFT, mark.r);
    if (alpha <= 0.0) discard;
    vec2 here = surface_at(gl_FragCoord.xy);
    if (here.y != own.y) {
        float bias = 2.0 * units_per_px_at_1 * mix(own.x, 1.0, orthographic);
        float away = length(from_center_px);
        vec2 inward = -from_center_px / max(away, 1e-3);
        // Ragged: loaded hairs run further.
        float reach = overrun_px * (0.4 + 1.2 * mark.g);
        // Another body in front of the stroke lets nothing over it; the ground and what lies behind take a little.
        if (here.y != 0.0 && here.x < own.x - bias) reach = 0.35;
        float on_own = 0.0;
        for (int index = 0; index < 4; index++) {
            float back = clamp(reach + (float(index) - 1.5) * 0.7, 0.0, away);
            on_own += surface_at(gl_FragCoord.xy + inward * back).y == own.y ? 0.25 : 0.0;
        }
        alpha *= on_own;
    }
    vec3 color = paint.rgb * (1.0 + 0.22 * (mark.g - 0.5));
    alpha *= OPACITY;
    over = vec4(color * alpha, alpha);
}
