// Ink on the paper: the blurred wash, the strokes over it, and the effect of the paper on both. This shader computes in
// sRGB values: wash and strokes each take a share of what is below (`mix.frag` subtracts instead).
#include "shared/encode.glsl"
#include "sumi_e/paper.glsl"
uniform sampler2D soft;          // silhouette, interior, seal red, body
uniform sampler2D wide;          // the same, blurred far
uniform sampler2D strokes;       // the share that ink takes of each channel; alpha grows with overlaps
uniform vec4 background;         // alpha 0 where the paper is left out
uniform vec3 ink;
uniform vec3 seal;
uniform vec4 amounts;            // of the wash, of strokes, density, silhouette
uniform vec4 wetness;            // bleed, how far ink bleeds in px, dryness, pixels per pixel of the scene's own size
uniform vec2 size_px;

out vec4 laid;                   // straight alpha, display-linear

const float MOST_INK = 0.97;

// The share that the wash takes of each channel.
vec3 wash_at(vec2 at, vec3 here, vec3 slow) {
    float bleed = wetness.x;
    // Ink spreads along fibres and stops where the pulp is thick.
    vec2 creep = vec2(felt(at * 1.7 + 0.31).x, felt(at.yx * 1.7 + 0.67).x) * 1.6 + 0.25 * here.yz;
    vec2 shift = creep * wetness.y / size_px;
    vec4 near = texture(soft, gl_FragCoord.xy / size_px + shift * 0.45 * bleed);
    vec4 far = texture(wide, gl_FragCoord.xy / size_px + shift * bleed);
    // The ink has a ragged front and is even behind it.
    float front = smoothstep(0.10, 0.42, far.a + 0.55 * here.y + 0.5 * slow.x);
    float red = clamp(near.b / max(near.a, 1e-3), 0.0, 1.0);
    float drinks = min(1.5 * bleed, 1.0) * (1.0 - 0.6 * red) * smoothstep(-0.06, 0.16, slow.x + 0.2 * here.x);
    vec4 run = mix(near, far * front, drinks);
    // The outline is broken here and there.
    float found = clamp(0.70 + 3.4 * slow.y, 0.12, 1.0);
    float dark = 1.0 - (1.0 - run.g * (1.25 - 0.25 * run.g)) * (1.0 - amounts.w * found * run.r);
    // Pigment gathers where the water ends, and settles into the tooth.
    float edge = clamp(4.0 * near.a * (1.0 - near.a), 0.0, 1.0);
    float tide = 4.0 * front * (1.0 - front) * far.a;
    dark *= 1.0 + 0.25 * edge * (1.0 - drinks) + 0.45 * tide * drinks;
    dark *= 1.0 + fibre_strength * (0.4 * here.z + 0.5 * here.y + 1.1 * here.x);
    // Where the brush was dry the tooth stays white.
    float tooth = here.z + 0.7 * here.y + 1.1 * slow.z;
    dark *= 1.0 - wetness.z * 0.75 * smoothstep(0.02, 0.16, tooth) * smoothstep(0.9, 0.3, run.r);
    red = clamp(run.b / max(run.a, 1e-3), 0.0, 1.0);
    dark = mix(dark, max(dark, 0.44 * run.b + 0.5 * run.g), red);
    // In pictures with strokes the wash is weaker, but not the red of a seal, which is stamped.
    dark *= mix(amounts.x, 1.0, red * red) * amounts.z;
    return clamp(dark, 0.0, MOST_INK) * (1.0 - mix(ink, seal, red));
}

vec3 strokes_at(vec3 here) {
    vec2 creep = (0.8 * here.yz + 0.4 * here.x) * 1.6 * wetness.w / size_px;
    vec4 gone_over = texture(strokes, gl_FragCoord.xy / size_px + creep);
    vec3 dark = gone_over.rgb * (1.0 + fibre_strength * (0.35 * here.z + 0.4 * here.y + 0.4 * here.x));
    // Where strokes cross they are darker.
    float highest = max(max(gone_over.r, gone_over.g), gone_over.b);
    dark *= 1.0 + 0.45 * max(gone_over.a - 0.5 * highest, 0.0);
    return clamp(dark * amounts.z, 0.0, MOST_INK);
}

void main() {
    vec2 at = paper_at(gl_FragCoord.xy);
    vec3 here = felt(at);
    // The paper's clouds of pulp at coarser scales: they make one part of an outline differ from the next.
    vec3 slow = vec3(felt(at * 0.53 + 0.17).x, felt(at * 0.41 + 0.59).x, felt(at * 0.71 + 0.83).x);
    vec3 washed = amounts.x > 0.0 ? wash_at(at, here, slow) : vec3(0.0);
    vec3 drawn = amounts.y > 0.0 ? amounts.y * strokes_at(here) : vec3(0.0);
    vec3 through = (1.0 - washed) * (1.0 - drawn);
    if (background.a > 0.0) {
        laid = vec4(linear_from_srgb(clamp(bare_paper(here) * through, 0.0, 1.0)), 1.0);
        return;
    }
    // Without paper: the ink alone, with straight alpha.
    vec3 taken = 1.0 - through;
    float most = max(max(taken.r, taken.g), taken.b);
    laid = vec4(linear_from_srgb(most > 0.0 ? 1.0 - taken / most : ink), most);
}
