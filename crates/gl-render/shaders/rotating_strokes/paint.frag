// Lays the colour and the height of a stroke, in the shape of its brush mark, on the stroke's own body and a little
// past it.
#ifdef SHAPED
#include "shared/stroke_shape.glsl"
#endif
in vec2 mark_at;
in vec2 from_center_px;
flat in vec4 paint;
flat in vec3 half_mixed;
flat in vec4 picked_up;
flat in vec4 mark;
flat in vec4 body;
flat in vec4 own;
flat in vec4 plane;
#ifdef LINE
in float run_dry;
in vec4 line;
#endif
#ifdef SHAPED
flat in vec4 form;
flat in float leaning;
#endif

uniform sampler2DArray brush_marks; // paint, height, tint
uniform sampler2D surface;       // x: depth; y: body id; its fraction: half the share of the pixel off that body
uniform float units_per_px_at_1; // world units per pixel at depth 1; at any depth if rays are parallel
uniform float orthographic;

layout(location = 0) out vec4 over;
#ifndef DRAFT
layout(location = 1) out vec4 height; // and how wet the paint is
#endif

#ifdef STORES
// Notes every fragment in three words: pixel (counted from the lower left), stroke and alpha, colour. `fragments.rs`
// reads them.
flat in uint number;
layout(std430, binding = 0) buffer Fragments {
    uint count;
    uint notes[];
};

void note(vec3 color, float alpha) {
    const float BRIGHTEST = 2.0;
    uint alpha_bits = uint(alpha * 1023.0 + 0.5);
    if (alpha_bits == 0u) return;
    uint slot = 3u * atomicAdd(count, 1u);
    if (slot + 2u >= uint(notes.length())) return;
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 root = sqrt(clamp(color / BRIGHTEST, 0.0, 1.0)) * vec3(2047.0, 2047.0, 1023.0) + 0.5;
    notes[slot] = uint(at.y * textureSize(surface, 0).x + at.x);
    notes[slot + 1u] = number << 10 | alpha_bits;
    notes[slot + 2u] = uint(root.r) | uint(root.g) << 11 | uint(root.b) << 22;
}
#endif

// FILL and HEIGHT_SCALE as in `impasto_core::brush`, FREE as in `Stroke::FREE`, STEEPNESS as in `paint.vert`.
const float FILL = 0.84;
const float HEIGHT_SCALE = 1.5;
const float FREE = 1e6;
const float STEEPNESS = 4.0;

// The depth of the stroke's centre; for a line, the depth of its middle beside this pixel.
float own_depth() {
#ifdef LINE
    return line.x;
#else
    return own.x;
#endif
}

// The body that the middle of a pixel shows.
float body_at(vec2 at_px) {
    ivec2 texel = clamp(ivec2(floor(at_px)), ivec2(0), textureSize(surface, 0) - 1);
    return floor(texelFetch(surface, texel, 0).y);
}

// How much paint lies in a pixel outside the stroke's own body. Paint reaches `reach_px` past that body. The reach
// varies from hair to hair with the mark's tint, so the edge is ragged.
float past_body(vec2 here, float reach_px) {
    float depth = own_depth();
    float bias = 2.0 * units_per_px_at_1 * mix(depth, 1.0, orthographic);
    float away_px = length(from_center_px);
    vec2 inward = -from_center_px / max(away_px, 1e-3);
    // Over a body in front of the stroke, only a soft edge is laid; over the background and bodies behind, more paint.
    if (here.y != 0.0 && here.x < depth - bias) reach_px = 0.35;
#ifdef DRAFT
    const int PLACES = 2;
#else
    const int PLACES = 4;
#endif
    float on_own = 0.0;
    for (int index = 0; index < PLACES; index++) {
        float back_px = clamp(reach_px + (float(index) - 0.5 * float(PLACES - 1)) * 0.7, 0.0, away_px);
        on_own += body_at(gl_FragCoord.xy + inward * back_px) == own.y ? 1.0 / float(PLACES) : 0.0;
    }
    return on_own;
}

// How much paint lies here on the stroke's own body: all of it near the stroke's plane, none far off the plane, as past
// a crease.
float on_plane(float depth) {
    float px_per_unit = 1.0 / (units_per_px_at_1 * mix(own_depth(), 1.0, orthographic));
    float off_px = (depth - own_depth()) * px_per_unit;
#ifdef LINE
    return 1.0 - smoothstep(line.w, 2.0 * line.w, abs(off_px - line.z));
#endif
    off_px -= plane.z + dot(plane.xy, from_center_px);
    return 1.0 - smoothstep(plane.w, 2.0 * plane.w, abs(off_px));
}

// How much paint lies in this pixel.
float laid(float tint) {
    vec2 here = texelFetch(surface, ivec2(gl_FragCoord.xy), 0).xy;
    float others = 2.0 * fract(here.y);
    float reach_px = body.z * (1.0 + 0.7 * tint);
    if (floor(here.y) != own.y) return past_body(vec2(here.x, floor(here.y)), reach_px);
    // Paint that reaches past the body also covers the part of the pixel that shows something else: a reach of 0.3
    // pixels covers 0.3 of that part, a reach of one pixel or more all of it.
    float whole = 1.0 - others * (1.0 - clamp(reach_px, 0.0, 1.0));
    return here.y == 0.0 ? whole : whole * on_plane(here.x);
}

void main() {
    vec2 quad_at = mark_at;
    float level = mark.y;
#ifdef SHAPED
    if (form.x > 0.0) {
        quad_at = on_mark(mark_at, form, leaning);
        if (any(lessThan(quad_at, vec2(0.0))) || any(greaterThan(quad_at, vec2(1.0)))) discard;
        level = level_where_narrow(level, quad_at.x, form.z);
    }
#endif
    float u = quad_at.x;
    vec2 at = vec2(u, 0.5 + (quad_at.y - 0.5) * body.w);
    at.y -= mark.w * ((u - 0.5) * (u - 0.5) - 0.06) * 0.5 * FILL;
#ifdef DRAFT
    // Reading one mipmap level is faster than reading two.
    level = floor(level + 0.5);
#endif
    vec3 texel = textureLod(brush_marks, vec3(at, mark.x), level).rgb;
    float past_end = max(abs(2.0 * u - 1.0) - own.z, 0.0);
    float least = paint.a;
#ifdef LINE
    // The nearer to edge-on the surface is seen, the less of its mark the brush leaves.
    least = mix(1.0 + mark.z, least + run_dry, smoothstep(0.0, 1.0, 2.0 * line.y));
#endif
    float alpha = smoothstep(least - mark.z, least + mark.z, texel.r - STEEPNESS * past_end);
#ifdef LINE
    alpha *= min(16.0 * line.y * line.y, 1.0);
#endif
    if (alpha <= 0.0) discard;
    float tint = texel.b * 2.0 - 1.0;
    if (body.z < FREE) alpha *= laid(tint);
    vec3 color = max(paint.rgb + half_mixed * tint, 0.0);
#ifdef DRAFT
    // Drafts have no lit relief: this imitates what light does to the bristle marks.
    color *= 1.0 + 0.30 * body.y * (texel.g - 0.42);
#else
    // The stroke carries wet paint from below with it, more towards its end.
    color = mix(color, picked_up.rgb, picked_up.a * (0.35 + 0.65 * u));
#endif
    // Thin edges are a little darker.
    color *= 1.0 - 0.10 * (1.0 - alpha);
    alpha *= body.x;
    over = vec4(color * alpha, alpha);
#ifdef STORES
    note(color, alpha);
#endif
#ifndef DRAFT
    height = vec4(texel.g * HEIGHT_SCALE * body.y, 0.8 * own.w, 0.0, 0.8) * alpha;
#endif
}
