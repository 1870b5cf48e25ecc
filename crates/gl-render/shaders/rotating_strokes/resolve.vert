// One stroke per vertex: finds its colour, its presence, and where it lies on its body. The paint pass reads these
// results, and so does `impasto strokes`.
#include "shared/lens.glsl"
#include "shared/oklab.glsl"
#include "reference/lighting.glsl"
#include "rotating_strokes/layers.glsl"
uniform float px_scale;          // output pixels per pixel of the scene's own size
uniform mat4 view_from_world;
const int kind = LAYER;          // the layer of paint that this program is for
layout(location = 0) in vec4 place;          // centre in px, depth, angle in radians
layout(location = 1) in vec4 size;           // length and width in px, facing fade, supply_ln (see `Stroke`)
layout(location = 2) in uvec4 marks;         // random bits, body id, albedo (sRGB bytes; A 0: unlit, 128: fixed), mark
layout(location = 3) in uvec2 bytes;         // paint, mixing
layout(location = 4) in vec4 normal_and_bow; // normal in world space; bow of the mark (see `Stroke`)
layout(location = 5) in vec4 reach;          // overrun in px, slow noise of hue and of edges, skew
#include "rotating_strokes/surroundings.glsl"
#include "rotating_strokes/mixing.glsl"

out vec4 resolved;               // colour, presence
out vec4 fitted;                 // centre in px, moved onto its body; lightness; turn added to the angle

const float FREE = 1e6;
const float MOST_FULL = 1.35;
// The least presence of a stroke that is painted. Drafts leave out faint strokes.
#ifdef DRAFT
const float LEAST = 0.25;
#else
const float LEAST = 0.004;
#endif

// From this `thinness` on (see `surroundings.glsl`), a stroke's colour is its own albedo, lit: single pixels of a thin
// body are light or dark by chance. The less thin it is, the more the picture's colour counts.
const float THIN = 0.6;

// Colours are averaged with a Gaussian. BLUR: its standard deviation across the stroke, in widths of the stroke, for
// each layer. It is at least 1.4 pixels of the picture, since single pixels change by chance. In pictures below the
// scene's own size this minimum shrinks down to LEAST_BLUR_PX.
const float LEAST_BLUR_PX = 1.1;
const float BLUR[8] = float[8](0.33, 0.20, 0.20, 0.22, 0.30, 0.60, 0.25, 0.25);

// How far highlights are spread over their body, pixels of the scene's own size. The same value as in
// `styles/rotating_strokes.rs`.
const float SPREAD_PX = 16.0;
// Strokes of a highlight gather round its peak. GATHERED: a stroke's distance from the peak, as a share of the distance
// of its particle (the point of the surface that carries it). A stroke fades as the highlight at its particle falls
// below NEAR_PEAK of the highlight at the peak. It also fades as its particle's distance from the peak grows from half
// of GATHER_PX to GATHER_PX (pixels of the scene's own size). So no stroke pops as its particle comes near or goes.
const float GATHERED = 0.3;
const float GATHER_PX = 60.0;
const float NEAR_PEAK = 0.7;

// How far from itself a contour stroke looks for the end of its body, pixels of the scene's own size.
const float OUTLINE_PX = 20.0;

// How far behind the stroke another body must lie to count as past the end of the stroke's own body, pixels of the
// scene's own size: in part from the first depth on, wholly from the second.
const vec2 BEHIND_PX = vec2(10.0, 50.0);

// A stroke that other bodies hide in part is wholly there while more than this share of it is visible.
const float WHOLE = 0.75;

// A leap of the depth within a body, as a share of the depth: from the first value on the body ends there in part, from
// the second wholly. The same values as in `detail.frag`.
const vec2 LEAP = vec2(0.01, 0.03);

// How far a place is hidden, 0..1, by what lies in front of the stroke's plane: the stroke's own body (`by_own`), or
// other bodies.
float hidden_at(vec2 offset_px, float bias, bool by_own) {
    vec2 tap_px = clamp(place.xy + offset_px, vec2(0.5), size_px - 0.5);
    vec2 there = surface_at(tap_px);
    if (there.y == 0.0 || (there.y == float(marks.y)) != by_own) return 0.0;
    return smoothstep(bias, 3.0 * bias, plane_depth(tap_px - place.xy) - there.x);
}

// As `hidden_at`, interpolated between the four nearest pixels, so that something that moves in front hides the place
// gradually.
float hidden_between(vec2 offset_px, float bias, bool by_own) {
#ifdef DRAFT
    return hidden_at(offset_px, bias, by_own);
#endif
    vec2 at = place.xy + offset_px - 0.5;
    vec2 corner = floor(at);
    vec2 part = at - corner;
    float hidden = 0.0;
    for (int index = 0; index < 4; index++) {
        vec2 step = vec2(index & 1, index >> 1);
        vec2 near = mix(1.0 - part, part, step);
        hidden += near.x * near.y * hidden_at(corner + step + 0.5 - place.xy, bias, by_own);
    }
    return hidden;
}

// The share of the stroke that other bodies hide, by taps on a grid over `spread` times its length and width.
float hidden_by_others(mat2 turn, float bias, ivec2 grid, vec2 spread) {
    float hidden = 0.0;
    for (int tap = 0; tap < grid.x * grid.y; tap++) {
        vec2 share = (vec2(tap % grid.x, tap / grid.x) + 0.5) / vec2(grid) - 0.5;
        hidden += hidden_at(turn * (share * spread * size.xy), bias, false);
    }
    return hidden / float(grid.x * grid.y);
}

// How much of the stroke is there where bodies hide it, 0..1. Other bodies are tested over the whole stroke. They make
// it fade only when less than `WHOLE` of it shows, since the paint pass cuts off the parts that they cover. The
// stroke's own body, which may bend in front of it, is tested round the stroke's middle. For paint that is never cut
// off, other bodies are tested there, too.
float seen(mat2 turn) {
    float unit = units_per_px(place.z);
    float slant = max(abs(facing_at_px(mat3(view_from_world) * normal_and_bow.xyz, place.xy)), 0.2);
    float radius_px = clamp(0.28 * sqrt(size.x * size.y), max(3.0, 7.0 * px_scale), 14.0 * max(px_scale, 1.0));
    float bias = unit * (2.5 + 0.5 * radius_px / slant);
#ifdef DRAFT
    const int PLACES = 9;
    const ivec2 GRID = ivec2(3, 2);
#else
    const int PLACES = 17;
    const ivec2 GRID = ivec2(5, 3);
    const ivec2 FINE_GRID = ivec2(13, 5);
#endif
    float by_own = 0.0;
    for (int index = 0; index < PLACES; index++) {
        // On a spiral, so that an edge reaches one place after the other, whichever way it moves.
        float away_px = 1.1 * radius_px * sqrt((float(index) + 0.5) / float(PLACES));
        float angle = 2.39996323 * float(index);
        vec2 offset_px = turn * vec2(cos(angle), sin(angle)) * away_px;
        by_own += hidden_between(offset_px, bias, true);
        if (reach.x >= FREE) by_own += hidden_between(offset_px, bias, false);
    }
#ifdef DRAFT
    float by_others = hidden_by_others(turn, bias, GRID, vec2(1.0));
#else
    // While a stroke fades, each tap of the coarse grid would be a visible step, so the fine grid is used. Where all
    // coarse taps agree, those on the stroke's rim too, it is skipped: it would find only things narrower than half a
    // stroke.
    float by_others = hidden_by_others(turn, bias, GRID, vec2(GRID) / vec2(GRID - 1));
    if (by_others > 0.0 && by_others < 1.0) by_others = hidden_by_others(turn, bias, FINE_GRID, vec2(1.0));
#endif
    float visible = 1.0 - by_others;
    return (1.0 - by_own / float(PLACES)) * smoothstep(0.0, WHOLE, visible);
}

vec3 albedo_of(uint albedo_bytes) {
    vec3 encoded =
        vec3(albedo_bytes & 255u, (albedo_bytes >> 8) & 255u, (albedo_bytes >> 16) & 255u) / 255.0;
    vec3 high = pow((encoded + 0.055) / 1.055, vec3(2.4));
    return mix(high, encoded / 12.92, lessThanEqual(encoded, vec3(0.04045)));
}

// The colour of the stroke's own place: its albedo, lit.
vec3 color_of_own() {
    vec3 albedo = albedo_of(marks.z);
    if ((marks.z >> 24) == 0u) return albedo;
    LitPoint point;
    point.position = world_from_px(place.xy, place.z);
    point.normal = normalize(normal_and_bow.xyz);
    point.towards_eye = towards_eye_from_px(place.xy);
    point.openness = 1.0;
    point.gloss = 0.0;
    return lit(albedo, point);
}

// At a presence below 0.1 only a few scattered hairs would be left, so nothing is painted.
float without_last(float there) {
    return max(there - 0.1, 0.0) / 0.9;
}

// The stroke's presence by its supply, as in `impasto_core::presence`, times its facing fade.
float presence(float supply_ln) {
    return without_last(smoothstep(0.0, 1.0, 0.5333823 + supply_ln / 1.4)) * size.z;
}

// A factor on the coverage of the body layer: thin in the darks, full in the lights.
float fullness(float lightness, float grading) {
    return mix(1.0, mix(0.62, MOST_FULL, smoothstep(0.15, 0.85, lightness)), grading);
}

// How much a layer of small strokes is wanted here, 0..1.
float wanted(vec3 detail) {
    // Reaches 1 early, so that a highlight that grows as it runs over a bump gets no stronger strokes than before.
    if (kind == LIGHTS) return smoothstep(0.0, 0.14, detail.b);
    // Outlines ask for strokes, except here and there, by slow noise.
    float rim = min(1.4 * detail.g, 1.0) * clamp(0.55 * (0.6 + 0.5 * reach.z), 0.0, 1.0);
    float inside = kind == FORM ? detail.r - 0.05 : 0.6 * detail.r - 0.2;
    return clamp(max(inside, 0.0) + rim, 0.0, 1.0);
}

// The peak of the highlight that this place belongs to, found by climbing the blurred highlights of the body. On a
// single Gaussian spot, one whole step would lead to the peak. The steps are shorter, so as not to leap off a narrow
// body, such as a leaf.
vec2 peak_px(float id) {
    vec2 at_px = place.xy;
    float reach_px = SPREAD_PX * px_scale;
    for (int step = 0; step < 6; step++) {
        vec4 glints = vec4(
            detail_at(at_px + vec2(block_px, 0.0), id).b, detail_at(at_px - vec2(block_px, 0.0), id).b,
            detail_at(at_px + vec2(0.0, block_px), id).b, detail_at(at_px - vec2(0.0, block_px), id).b
        );
        vec4 logs = log(max(glints, 1e-4));
        vec2 up = vec2(logs.x - logs.y, logs.z - logs.w) * (reach_px * reach_px / (2.0 * block_px));
        at_px += up * min(0.7, 0.5 * reach_px / max(length(up), 1e-4));
    }
    return at_px;
}

// By how much `even_depth` changes per pixel along the stroke's own plane. `facing` counts as at least 0.1 in size.
vec2 plane_slope() {
    vec3 n = mat3(view_from_world) * normal_and_bow.xyz;
    float facing = facing_at_px(n, place.xy);
    vec2 slope = (facing < 0.0 ? -n.xy : n.xy) / (px_per_unit_at_1 * max(abs(facing), 0.1));
    return mix(-slope, slope / place.z, orthographic);
}

// A depth in a form that changes linearly over the picture along a plane; 1 at the stroke's own depth.
float even_depth(float depth) {
    return mix(place.z / depth, depth / place.z, orthographic);
}

// Whether the depth leaps between the stroke's centre and a place on its body, 0..1. `there` is the `even_depth` of the
// place. Along a plane, `even_depth` halfway to the place is the mean of 1 and `there`. Only a difference from this
// mean counts as a leap, so a floor that recedes has none.
float broken(vec2 halfway_px, float there, vec2 own) {
    // Nothing is known of what lies outside the picture.
    if (any(lessThan(halfway_px, vec2(0.0))) || any(greaterThan(halfway_px, size_px))) return 0.0;
    vec2 at = halfway_px - 0.5;
    vec2 part = fract(at);
    vec2 middle = vec2(0.0);
    float in_front = 0.0;
    for (int corner = 0; corner < 4; corner++) {
        ivec2 step = ivec2(corner & 1, corner >> 1);
        vec2 near = mix(1.0 - part, part, vec2(step));
        vec2 surface = surface_at(floor(at) + vec2(step) + 0.5);
        if (surface.y == own.y) middle += near.x * near.y * vec2(even_depth(surface.x), 1.0);
        else if (surface.y != 0.0 && surface.x < own.x) in_front += near.x * near.y;
    }
    // Pixels of something in front tell nothing of where the body ends; pixels of something behind lie past its end.
    float uneven = abs(1.0 - 2.0 * middle.x / max(middle.y, 1e-4) + there);
    return middle.y * smoothstep(0.5 * LEAP.x, LEAP.y, uneven) + (1.0 - middle.y - in_front);
}

// Where the body ends nearby. xy: towards the end. z: the share of the surroundings that lies past the end, 0..1. w:
// the share that something in front hides, which is no end of the body, 0..1.
vec4 outline_near(vec2 own) {
    float bias = 0.02 * own.x;
    vec2 slope = plane_slope();
    vec2 behind = BEHIND_PX * (units_per_px(own.x) * px_scale / own.x);
    float deeper = mix(-1.0, 1.0, orthographic);
    vec4 sum = vec4(0.0);
    for (int index = 0; index < 48; index++) {
        float angle = 0.39269908 * (float(index & 15) + 0.5 * float((index >> 4) & 1));
        vec2 offset = vec2(cos(angle), sin(angle));
        vec2 away_px = offset * (OUTLINE_PX * px_scale * (0.4 + 0.3 * float(index >> 4)));
        vec2 at = place.xy + away_px - 0.5;
        vec2 part = fract(at);
        float past = 0.0;
        float hidden = 0.0;
        float leaps = 0.0;
        vec2 on_body = vec2(0.0);
        for (int corner = 0; corner < 4; corner++) {
            ivec2 step = ivec2(corner & 1, corner >> 1);
            vec2 near = mix(1.0 - part, part, vec2(step));
            vec2 there_px = clamp(floor(at) + vec2(step) + 0.5, vec2(0.5), size_px - 0.5);
            vec2 there = surface_at(there_px);
            // Where bodies touch, neither ends: a floor has no line at the foot of what stands on it.
            vec2 offset_px = there_px - place.xy;
            float even = even_depth(there.x);
            float past_plane = deeper * (even - 1.0 - dot(slope, offset_px));
            float past_own = (there.x - own.x) / own.x;
            float farther = there.y == 0.0 ? 1.0 : smoothstep(behind.x, behind.y, min(past_plane, past_own));
            // One part of the body may stand in front of another.
            float leap = (there.x - max(plane_depth(offset_px), own.x)) / own.x;
            if (there.y == own.y) {
                leaps += near.x * near.y * smoothstep(LEAP.x, LEAP.y, leap);
                on_body += near.x * near.y * vec2(even, 1.0);
            } else {
                past += near.x * near.y * farther;
            }
            hidden += near.x * near.y * smoothstep(bias, 3.0 * bias, there.y == 0.0 ? 0.0 : own.x - there.x);
        }
        if (leaps > 0.0) past += leaps * broken(place.xy + 0.5 * away_px, on_body.x / on_body.y, own);
        sum += vec4(vec3(offset, 1.0) * past, hidden);
    }
    return sum / 48.0;
}

// How much a contour line is wanted, 0..1: near the end of the body, here and there by slow noise, less in the light,
// and less where something in front hides the surroundings.
float line_wanted(vec4 outline, float lightness) {
    float at_end = smoothstep(0.02, 0.46, outline.z) * (1.0 - smoothstep(0.55, 0.95, outline.z));
    float found = smoothstep(-0.9, 0.5, reach.z);
    float in_view = 1.0 - smoothstep(0.1, 0.8, outline.w);
    return 0.85 * in_view * at_end * found * mix(1.0, 0.30, smoothstep(0.30, 0.95, lightness));
}

// From the stroke's centre to where it lies just inside the end of its body. The distance to the end follows from the
// share of the surroundings past it, as if the end were straight.
vec2 to_end_px(vec4 outline) {
    if (dot(outline.xy, outline.xy) < 1e-8) return vec2(0.0);
    return normalize(outline.xy) * (OUTLINE_PX * px_scale * (1.0 - 2.0 * outline.z) - 0.4 * size.y);
}

// The turn that lays a stroke along the end of its body, the shorter way round.
float turn_along(vec4 outline) {
    if (dot(outline.xy, outline.xy) < 1e-8) return 0.0;
    float turn = atan(outline.y, outline.x) + 1.57079633 - place.w;
    return turn - 3.14159265 * round(turn / 3.14159265);
}

// Shift along the stroke that puts as much of it as possible on its body. Its size stays.
float shift(mat2 turn, vec2 own) {
    if (reach.x >= FREE) return 0.0;
    vec2 half_along_px = turn[0] * (0.5 * size.x);
    vec2 across_px = turn[1] * (0.3 * size.y);
    // An end may lie a little past the body.
    float past = (reach.x + 0.2 * size.x) / (0.5 * size.x);
    float forward = min(share_on_body(place.xy, half_along_px, across_px, own) + past, 1.0);
    float back = min(share_on_body(place.xy, -half_along_px, across_px, own) + past, 1.0);
    return 0.25 * size.x * (forward - back);
}

void main() {
    mat2 turn = mat2(cos(place.w), sin(place.w), -sin(place.w), cos(place.w));
    vec2 own = vec2(place.z, float(marks.y));
    resolved = vec4(0.0);
    fitted = vec4(place.xy, 0.0, 0.0);
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
    // Most strokes turn out absent: the cheap tests come first, and the rest is then skipped.
    bool small = kind == FORM || kind == ACCENTS || kind == LIGHTS;
    vec4 outline = vec4(0.0);
    float turned = 0.0;
    vec2 moved = vec2(0.0);
    float there = presence(size.w + (kind == BODY ? log(MOST_FULL) : 0.0));
    if (kind == LIGHTS && there > LEAST) {
        vec2 to_peak = peak_px(own.y) - place.xy;
        moved = to_peak * (1.0 - GATHERED);
        float gather_px = GATHER_PX * px_scale;
        there *= 1.0 - smoothstep(0.5 * gather_px, gather_px, length(to_peak));
        vec3 at_peak = detail_at(place.xy + to_peak, own.y);
        there *= smoothstep(0.0, NEAR_PEAK, detail_at(place.xy, own.y).b / max(at_peak.b, 1e-4));
        there = without_last(there * wanted(at_peak));
    } else if (small && there > LEAST) there = without_last(there * wanted(detail_at(place.xy, own.y)));
    if (kind == CONTOUR && there > LEAST) {
#ifdef DRAFT
        if (detail_at(place.xy, own.y).g <= 0.002) return;
#endif
        outline = outline_near(own);
        if (outline.z <= 0.03) return;
        turned = turn_along(outline);
        moved = to_end_px(outline);
        turn = mat2(cos(turned), sin(turned), -sin(turned), cos(turned)) * turn;
    }
    // What hides a touch (a line painted by hand) is found pixel by pixel, in the paint pass; what hides a contour
    // line, in `outline_near`.
    if (there > LEAST && kind != CONTOUR && kind != TOUCHES) there *= seen(turn);
    if (there <= LEAST) return;

    float across_px = max(BLUR[kind] * size.y, clamp(1.4 * px_scale, LEAST_BLUR_PX, 1.4));
    mat2 blur_px = mat2(clamp(0.16 * size.x, across_px, 2.5 * across_px), 0.0, 0.0, across_px);
    if (kind == TOUCHES) blur_px = mat2(across_px, 0.0, 0.0, across_px);
    vec2 at_px = kind == LIGHTS ? place.xy + moved : center_in_picture();
    float free = kind == LIGHTS ? 0.0 : freedom(at_px, own.y);
    // What covers a stroke, as leaves do, changes as the view moves. So a covered stroke takes its colour from a wider
    // surrounding.
    blur_px *= kind == LIGHTS ? 1.0 : 1.0 + 1.5 * (1.0 - free);
    vec4 found = own_color(at_px, own.y, turn * blur_px, free);
    // Highlights are in the picture only, not in the stroke's own lit albedo. On thin parts single pixels glint by
    // chance, so these strokes fade there.
    if (kind == LIGHTS) there *= found.w * (1.0 - smoothstep(0.0, THIN, thinness(place.xy, own, 1.0)));
    float thin = kind == LIGHTS ? 0.0 : smoothstep(0.0, THIN, thinness(at_px, own, free));
    float known = kind == LIGHTS ? 1.0 : found.w * (1.0 - thin);
    vec3 color = known == 1.0 ? found.rgb : mix(color_of_own(), found.rgb, known);
    vec3 lab = oklab_from_linear(color);
    Mixing mixing = mixing_of(bytes.y);
    if (kind == BODY) {
        there *= presence(size.w + log(fullness(lab.x, mixing.grading))) / presence(size.w + log(MOST_FULL));
    }
    if (kind == CONTOUR) there = without_last(there * line_wanted(outline, lab.x));
    vec2 center_px = place.xy + moved + turn[0] * shift(turn, own);
#ifndef DRAFT
    bool may_move = kind != CONTOUR && kind != TOUCHES && reach.x < FREE;
    if (thin > 0.0 && may_move) center_px += thin * to_spine_px(center_px, own);
#endif
    fitted = vec4(center_px, lab.x, turned);
    // A fixed colour: that of a touch, or of a picture that shows a measure instead of the scene.
    if ((marks.z >> 24) == 128u) {
        resolved = vec4(albedo_of(marks.z), there);
        if (kind == TOUCHES) fitted.z = oklab_from_linear(resolved.rgb).x;
        return;
    }
    vec3 wide = kind == ACCENTS ? mix(lab, wide_mean(at_px, own.y, lab, free), known) : lab;
    lab = mixed(lab, wide, kind, mixing, uvec2(marks.x, floatBitsToUint(reach.y)));
#ifdef DRAFT
    there = max(there - LEAST, 0.0) / (1.0 - LEAST);
#endif
    resolved = vec4(linear_from_oklab(lab), there);
    fitted.z = lab.x;
}
