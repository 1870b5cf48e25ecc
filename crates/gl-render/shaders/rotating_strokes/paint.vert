// Places one corner of a stroke, a quad flat on the screen and measured in pixels. With LINE, places a vertex of a line
// that was painted by hand (layer `Touches`), drawn as a strip of triangles.
#include "shared/oklab.glsl"
#include "rotating_strokes/layers.glsl"
#ifdef SHAPED
#include "shared/stroke_shape.glsl"
#endif
layout(location = 0) in vec4 place;          // centre in px, depth, angle in radians
layout(location = 1) in vec4 size;           // length and width in px, facing fade, supply_ln (see `Stroke`)
layout(location = 2) in uvec4 marks;         // random bits, body id, albedo, mark
layout(location = 3) in uvec2 bytes;         // paint, mixing
layout(location = 4) in vec4 normal_and_bow; // normal in world space; bow of the mark (see `Stroke`)
layout(location = 5) in vec4 reach;          // overrun in px, slow noise of hue and of edges, skew
layout(location = 6) in vec4 resolved;       // colour, presence
layout(location = 7) in vec4 fitted;         // centre in px, moved onto its body; lightness; turn added to the angle
#ifdef SHAPED
layout(location = 8) in vec2 shape;          // taper, bend in radians
#endif
#ifdef LINE
layout(location = 9) in vec4 corner_of_line; // corner in px; its place along and across the mark
layout(location = 10) in vec4 middle_of_line; // px from the line's middle to the corner; depth, presence of the middle
// x: depth of the plane under the vertex minus that of the line's middle, px; y: how far paint may lie off the plane,
// px; z: how dry the brush has run.
layout(location = 11) in vec3 lean;
#endif

#include "shared/lens.glsl"
#ifndef LINE
uniform mat4 view_from_world;
uniform int kind;                // layer of paint
#endif
uniform float mark_rows;         // texels across a mark
uniform sampler2D mark_bounds;   // a row per mark: per threshold of paint, the box around all that lies above it
#ifndef DRAFT
uniform sampler2D below;         // the picture before this layer, premultiplied
uniform sampler2D depth_and_id;
#endif

#ifdef STORES
uniform int first_stroke;        // number, within the picture, of the first stroke of this draw
flat out uint number;
#endif

out vec2 mark_at;                // place on the mark, 0..1; on a shaped stroke, px along and across it
out vec2 from_center_px;
flat out vec4 paint;             // rgb: colour; a: the paint value of the mark in the middle of its soft edge
flat out vec3 half_mixed;        // other paint in the brush: added to the colour, times the mark's tint
flat out vec4 picked_up;         // colour from below and how much of it
flat out vec4 mark;              // number of the mark, level of detail, half the width of its soft edge, bow
flat out vec4 body;              // opacity, thickness, overrun in px, sign of the flip
flat out vec4 own;               // depth, id of the body, share of the stroke's length that shows, how wet its paint is
flat out vec4 plane;             // the stroke's plane, in px: slope of its depth along x and along y, its depth at the
                                 // middle of the quad minus the stroke's depth, how far paint may lie off it
#ifdef LINE
out float run_dry;               // how much more paint the mark needs to show
out vec4 line;                   // depth of the line's middle; presence; depth of the plane minus that of the middle,
                                 // px; how far paint may lie off the plane, px
#endif
#ifdef SHAPED
flat out vec4 form;              // half the quad's length (0: no shape) and width in px, taper, bend per px
flat out float leaning;          // skew
#endif

const float MARGIN = 1.0 / 0.84;
// How much more paint the mark needs past the ends of a fading stroke, per half length; as in the fragment shader.
const float STEEPNESS = 4.0;
// Paint that picks up this much from below, or more, runs together with its neighbours as far as it can.
const float WET_PICKUP = 0.25;
const float BYTE = 1.0 / 255.0;

#ifndef DRAFT
// rgb: mean colour (not premultiplied) at twenty places below the first 40 % of the stroke. a: how much of it is picked
// up. Only places on the stroke's own body count, since paint past its border belongs to what lies beside it. The fewer
// places count, the less is picked up; where hardly any paint lies, nothing. The places are far apart, so that a body
// that passes in front of the stroke covers them one after the other, over many frames.
vec4 paint_below(vec2 center_px, mat2 turn) {
    const int PLACES = 20;
    vec4 sum = vec4(0.0);
    float share = 0.0;
    for (int index = 0; index < PLACES; index++) {
        vec2 place_at = vec2(-0.3, 0.0) + (fract(float(index + 1) * vec2(0.75487767, 0.56984029)) - 0.5) * vec2(0.4, 0.8);
        ivec2 texel = clamp(ivec2(floor(center_px + turn * (place_at * size.xy))), ivec2(0), ivec2(size_px) - 1);
        if (texelFetch(depth_and_id, texel, 0).y != float(marks.y)) continue;
        sum += texelFetch(below, texel, 0);
        share += 1.0 / float(PLACES);
    }
    float covered = sum.a / max(share * float(PLACES), 1e-4);
    return vec4(sum.rgb / max(sum.a, 1e-4), share * smoothstep(0.3, 0.9, covered));
}
#endif

// As in `impasto_core::brush` and `marks::bounds`.
const vec2 MARK_SIZE = vec2(256.0, 96.0);
const float FILL = 0.84;
const int STEPS = 32;
// The last mipmap level whose sides are exactly half those of the level before; the next one rounds.
const float COARSEST = 5.0;

// The part of the quad that holds all of the mark's paint above `least` at this level: the range along the mark, then
// the range across it.
vec4 painted_part(float least, float level, float bow, float flip) {
    int amount = int(floor(least * float(STEPS) - 0.05));
    float coarser = floor(level) + 1.0;
    if (amount < 0 || coarser > COARSEST) return vec4(0.0, 1.0, 0.0, 1.0);
    vec4 part = texelFetch(mark_bounds, ivec2(min(amount, STEPS - 1), int(marks.w & 65535u)), 0);
    // Grown by 1.5 texels of the coarser level, as far as its filtering spreads paint. A box that reaches the border
    // goes on past it, as the texels of the border do (clamp to edge).
    vec2 reach = (1.5 * exp2(coarser) - 0.8) / MARK_SIZE;
    part += vec4(-reach.x, reach.x, -reach.y, reach.y);
    if (part.z <= 0.0) part.z = -9.0;
    if (part.w >= 1.0) part.w = 9.0;
    // The bow shifts the mark across.
    vec2 from_middle = part.xy - 0.5;
    vec2 square = vec2(part.x < 0.5 && part.y > 0.5 ? 0.0 : min(from_middle.x * from_middle.x, from_middle.y * from_middle.y),
        max(from_middle.x * from_middle.x, from_middle.y * from_middle.y));
    vec2 shift = bow * (square - 0.06) * 0.5 * FILL;
    vec2 across = part.zw + vec2(min(shift.x, shift.y), max(shift.x, shift.y));
    if (flip < 0.0) across = 1.0 - across.yx;
    return clamp(vec4(part.xy, across), 0.0, 1.0);
}

#ifndef LINE
// The plane that the stroke lies on. Paint ends where the surface leaves this plane, as past a crease. The exceptions
// are the underpainting, which covers all, and contour lines, which follow the border.
vec4 plane_of_stroke(vec2 center_px) {
    vec3 n = mat3(view_from_world) * normal_and_bow.xyz;
    float facing = facing_at_px(n, place.xy);
    float slant = max(abs(facing), 0.05);
    vec2 slope = n.xy / (facing < 0.0 ? -slant : slant);
    bool goes_on = kind == UNDERPAINTING || kind == CONTOUR;
    // At a slant, a small bend of the surface is a large difference of depth, so more is allowed.
    float may_leave_px = goes_on ? 1e9 : (0.07 * size.x + 2.5) * max(0.7 / slant, 1.0);
    return vec4(slope, dot(slope, center_px - place.xy), may_leave_px);
}
#endif

void main() {
#ifdef STORES
    number = uint(first_stroke + gl_InstanceID);
#endif
    float there = resolved.a;
    if (there <= 0.004) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        return;
    }
    float opacity = float(bytes.x & 255u) * BYTE * min(16.0 * there * there, 1.0);
    float thickness = float((bytes.x >> 8) & 255u) / 50.0;
    float pickup = float((bytes.x >> 16) & 255u) * BYTE;
    float dryness = float(bytes.x >> 24) * BYTE;
    // A drier brush leaves less of its mark, and so does a fading stroke.
    float share = 0.98 * (1.0 - dryness) * mix(0.5, 1.0, there);
    // A fading stroke shrinks from its ends to a quarter of its length, then fades as a whole.
    float extent = max(there, 0.25);
    // Half the width of the soft edge, in values of the mark's paint, so that the whole edge is about a pixel wide.
    float soft = clamp(1.2 * (size.x + size.y) / (size.x * size.y), 0.02, 0.14);
    paint = vec4(resolved.rgb, mix(1.0 + soft, soft + 0.02, share));
#ifdef DRAFT
    half_mixed = resolved.rgb * vec3(0.26, 0.25, 0.20) + 0.004;
#else
    vec3 lab = oklab_from_linear(resolved.rgb);
    half_mixed = linear_from_oklab(lab + vec3(0.055, 0.0, 0.014)) - resolved.rgb;
#endif

    float angle = place.w + fitted.w;
    vec2 along = vec2(cos(angle), sin(angle));
    vec2 center_px = fitted.xy;
#ifdef DRAFT
    picked_up = vec4(0.0);
#else
    vec4 under = pickup > 0.0 ? paint_below(center_px, mat2(along, -along.y, along.x)) : vec4(0.0);
    picked_up = vec4(under.rgb, pickup * under.a);
#endif

    // A constant level keeps the mark the same at every angle.
    float level = max(log2(mark_rows / (1.05 * size.y * MARGIN)), 0.0);
    float flip = (marks.w & 65536u) == 0u ? 1.0 : -1.0;
    vec4 part = painted_part(paint.a - soft, level, normal_and_bow.w, flip);
    // As in the fragment shader: past the ends the mark needs more paint to show.
    float half_extent = 0.5 * extent + 0.5 / STEEPNESS;
    part.xy = clamp(part.xy, 0.5 - half_extent, 0.5 + half_extent);
    if (part.x >= part.y || part.z >= part.w) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        return;
    }
    mark_at = vec2((gl_VertexID & 1) == 0 ? part.x : part.y, gl_VertexID < 2 ? part.z : part.w);
    vec2 corner = mark_at * 2.0 - 1.0;
    from_center_px =
        (along * corner.x * size.x + (vec2(-along.y, along.x) + along * reach.w) * corner.y * size.y)
        * 0.5 * MARGIN;
#ifdef SHAPED
    vec4 own_form = vec4(0.0);
    if (shape != vec2(0.0)) {
        corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
        own_form = vec4(0.5 * MARGIN * size.xy, shape.x, shape.y / max(size.x, 1e-6));
        mark_at = corner_of_box(corner, own_form, reach.w);
        from_center_px = along * mark_at.x + vec2(-along.y, along.x) * mark_at.y;
        // May be below 0 here: the level changes along the stroke, and the fragment shader clamps it.
        level = log2(mark_rows / (1.05 * size.y * MARGIN));
    }
    form = own_form;
    leaning = reach.w;
#endif
#ifdef LINE
    mark_at = corner_of_line.zw;
    from_center_px = middle_of_line.xy;
    line = vec4(middle_of_line.zw, lean.xy);
    run_dry = lean.z;
    level = max(log2(mark_rows / (1.05 * size.y * MARGIN)), 0.0);
#endif
    mark = vec4(float(marks.w & 65535u), level, soft, normal_and_bow.w);
    float fat = 0.55 + 0.75 * clamp(fitted.z, 0.0, 1.0) / 0.7;
    body = vec4(opacity, thickness * fat, reach.x, flip);
#ifdef LINE
    plane = vec4(0.0);
#else
    plane = plane_of_stroke(center_px);
#endif
    own = vec4(place.z, float(marks.y), extent, min(pickup / WET_PICKUP, 1.0));
#ifdef LINE
    gl_Position = vec4(corner_of_line.xy / size_px * 2.0 - 1.0, 0.0, 1.0);
#else
    gl_Position = vec4((center_px + from_center_px) / size_px * 2.0 - 1.0, 0.0, 1.0);
#endif
}
