// Lights every pixel of the surfaces. For styles that want it, a part of each strong highlight goes to an output of its
// own.
#include "shared/lens.glsl"
#ifndef DRAFT
#define SHADOW_OF_SAMPLES
#endif
#include "reference/lighting.glsl"
uniform sampler2D albedo_and_lit;
uniform sampler2D normal;        // rgb: normal in world space, a: gloss
uniform sampler2D depth_and_id;
uniform sampler2D openness;      // ambient occlusion: 0 enclosed .. 1 open; half the picture's size
#ifndef DRAFT
uniform sampler2D fine;          // depth and body id of every sample
uniform sampler2D root_albedo;   // square root of the colour of every sample, and `is_lit`
uniform int samples;             // per pixel along each axis; 1: the pixel itself is its only sample
#endif
uniform float highlight_in_color; // share of a strong highlight that stays in `color`, 0..1

layout(location = 0) out vec4 color;
layout(location = 1) out vec4 glint;     // how strong the highlight is, 0..1
layout(location = 2) out vec4 highlight; // what `color` leaves out, display-linear

// Values of `Light::glint`. Up to the first, a highlight is a faint sheen, as on plaster, and `color` has all of it.
// From the second on, it is strong.
const vec2 STRONG = vec2(0.15, 0.40);

#ifndef DRAFT
// The share of the shadow-casting light that arrives, 0..1. Where a surface is seen at a flat angle, a pixel covers
// more of it than a texel of the shadow map does, and a single point would be lit or not by chance. There the result is
// a mean over the samples that show the body.
float shadow_at(LitPoint at) {
    if (samples == 1) return shadow_of_point(at);
    float id = texelFetch(depth_and_id, ivec2(gl_FragCoord.xy), 0).y;
    float farthest = 0.0;
    vec3 places[16];
    int count = 0;
    for (int index = 0; index < samples * samples; index++) {
        ivec2 sample_at = ivec2(gl_FragCoord.xy) * samples + ivec2(index % samples, index / samples);
        vec2 there = texelFetch(fine, sample_at, 0).xy;
        if (there.y != id) continue;
        places[count] = world_from_px((vec2(sample_at) + 0.5) / float(samples), there.x);
        farthest = max(farthest, distance(places[count], at.position));
        count++;
    }
    float wide = smoothstep(0.5, 1.0, farthest / (shadow_texel * max(away_from_lamp(at.position), 1e-6)));
    if (wide == 0.0) return shadow_of_point(at);
    float mean = 0.0;
    for (int index = 0; index < count; index++) mean += sunlit(places[index], at.normal, 2, 1.5) / float(count);
    return wide < 1.0 ? mix(shadow_of_point(at), mean, wide) : mean;
}

// The colour of the body in this pixel: a mean over the samples that show the body. A single sample would make a border
// between two colours of a moving body leap from pixel to pixel.
vec3 mean_albedo(ivec2 at, vec4 surface, float id) {
    vec3 root = sqrt(surface.rgb);
    vec4 sum = vec4(0.0);
    for (int index = 0; index < samples * samples; index++) {
        ivec2 sample_at = at * samples + ivec2(index % samples, index / samples);
        vec4 there = texelFetch(root_albedo, sample_at, 0);
        if (texelFetch(fine, sample_at, 0).y != id || abs(there.a - surface.a) > 0.5) continue;
        // Samples have only 8 bits. Where a sample has the pixel's colour, the pixel's own value is more exact.
        bool same = all(lessThan(abs(there.rgb - min(root, 1.0)), vec3(0.006)));
        sum += vec4(same ? surface.rgb : there.rgb * there.rgb, 1.0);
    }
    return sum.a > 0.0 ? sum.rgb / sum.a : surface.rgb;
}
#endif

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 here = texelFetch(depth_and_id, at, 0).xy;
    color = vec4(0.0);
    glint = vec4(0.0);
    highlight = vec4(0.0);
    if (here.y == 0.0) return;
    vec4 surface = texelFetch(albedo_and_lit, at, 0);
#ifndef DRAFT
    if (samples > 1) surface.rgb = mean_albedo(at, surface, here.y);
#endif
    if (surface.a == 0.0) {
        color = vec4(surface.rgb, 1.0);
        return;
    }
    vec4 normal_and_gloss = texelFetch(normal, at, 0);
    LitPoint point;
    point.position = world_from_px(gl_FragCoord.xy, here.x);
    point.normal = normalize(normal_and_gloss.xyz);
    point.towards_eye = towards_eye_from_px(gl_FragCoord.xy);
    point.openness = texture(openness, gl_FragCoord.xy / size_px).r;
    point.gloss = normal_and_gloss.w;
    Light light = light_on(point);
    vec3 matt = surface.rgb * light.diffuse;
    glint.r = smoothstep(STRONG.x, STRONG.y, light.glint);
    float share = mix(1.0, highlight_in_color, glint.r);
    color = vec4(exposed(matt + share * light.highlight), 1.0);
    highlight.rgb = max(exposed(matt + light.highlight) - color.rgb, 0.0);
}
