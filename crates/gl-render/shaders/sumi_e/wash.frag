// The ink on each pixel of the bodies before it is blurred: silhouette, interior, seal red; none on a backdrop.
#include "shared/lens.glsl"
#include "shared/oklab.glsl"
#include "sumi_e/ramp.glsl"
#include "sumi_e/inked.glsl"
uniform sampler2D normal;        // world space
uniform sampler2D depth_and_id;
uniform sampler2D albedo_and_lit;
uniform vec3 to_light;           // unit, world space
uniform vec2 silhouette;         // cosines between normal and eye: black at the first, no silhouette at the second
uniform float own_tone;          // how far a body's own lightness changes its ink
uniform vec4 seal;               // a red in Oklab; how far colours of its hue stay red
uniform float line_px;           // half the width of the line where a body ends

out vec4 wash;                   // silhouette, interior (0 paper .. 1 black), seal red, 1

// How much of the surroundings lies well behind this pixel or on no body: this gives bodies with sharp edges an outline
// too.
float ends(ivec2 at, vec2 here, float facing) {
    float step_back = units_per_px(here.x) * line_px * (3.0 + 2.0 / max(facing, 0.15));
    ivec2 last = textureSize(depth_and_id, 0) - 1;
    float sum = 0.0;
    for (int index = 0; index < 8; index++) {
        float angle = 0.78539816 * float(index);
        ivec2 tap = ivec2(floor(vec2(at) + 0.5 + vec2(cos(angle), sin(angle)) * line_px));
        vec2 there = texelFetch(depth_and_id, clamp(tap, ivec2(0), last), 0).xy;
        if (there.y == 0.0 || there.x > here.x + step_back) sum += 0.125;
    }
    return sum;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 here = texelFetch(depth_and_id, at, 0).xy;
    wash = vec4(0.0);
    if (here.y == 0.0 || !gets_ink(int(here.y))) return;
    vec3 towards = towards_eye_from_px(gl_FragCoord.xy);
    vec3 n = texelFetch(normal, at, 0).xyz;
    float size = length(n);
    n = size > 1e-6 ? n / size : towards;
    float facing = clamp(dot(n, towards), 0.0, 1.0);
    float t = clamp((facing - silhouette.x) / (silhouette.y - silhouette.x), 0.0, 1.0);
    float limb = 1.0 - t * t * (3.0 - 2.0 * t);
    float line = smoothstep(0.05, 0.45, ends(at, here, facing));

    vec4 surface = texelFetch(albedo_and_lit, at, 0);
    vec3 lab = oklab_from_linear(surface.rgb);
    float light = 0.5 + 0.5 * dot(n, to_light);
    light = surface.a > 0.0 ? light + own_tone * 1.7 * (lab.x - 0.68) : lab.x;
    float ink = 1.0 - tone_at(clamp(light, 0.0, 1.0));

    float chroma = length(lab.yz);
    float same_hue = dot(lab.yz, seal.yz) / max(chroma * length(seal.yz), 1e-6);
    float red = seal.w * smoothstep(0.07, 0.12, chroma) * smoothstep(0.90, 0.97, same_hue);
    wash = vec4(max(limb, line), ink, red, 1.0);
}
