// The shape of strokes that taper and bend. The vec4 `form` (`of` in the first function) holds half the quad's length
// in px (0 for a stroke that does neither), half its width in px, the taper, and the bend in radians per px.
#include "shared/inverse_bilinear.glsl"

// A corner of the box around a tapered and bent stroke, px along and across from its centre.
vec2 corner_of_box(vec2 corner, vec4 of, float skew) {
    float wide = of.y * (1.0 + abs(of.z));
    float reach = of.x + abs(skew) * wide;
    float per_px = abs(of.w);
    if (per_px < 1e-6) return corner * vec2(reach, wide);
    float half_angle = min(per_px * reach, 3.14159265);
    float radius = 1.0 / per_px;
    float along = (radius + wide) * (half_angle < 1.57079633 ? sin(half_angle) : 1.0);
    float rise = sin(0.5 * half_angle);
    float inward = max(2.0 * radius * rise * rise + wide * abs(cos(half_angle)), wide);
    float across = of.w > 0.0 ? mix(-wide, inward, corner.y * 0.5 + 0.5) : mix(-inward, wide, corner.y * 0.5 + 0.5);
    return vec2(corner.x * along, across);
}

// From a place on a bent stroke to px along the stroke and px off its middle line, which is an arc.
vec2 straightened(vec2 at_px, float per_px) {
    if (abs(per_px) < 1e-6) return at_px;
    vec2 from_middle = vec2(per_px * at_px.x, 1.0 - per_px * at_px.y);
    float off_px = (2.0 * at_px.y - per_px * dot(at_px, at_px)) / (1.0 + length(from_middle));
    return vec2(atan(from_middle.x, from_middle.y) / per_px, off_px);
}

// Where a pixel lies on the mark. Straightened, a bent stroke is a trapezoid, and the mark is stretched between its
// sides.
vec2 on_mark(vec2 at_px, vec4 form, float leaning) {
    vec2 start = vec2(leaning, 1.0) * form.y * (1.0 + form.z);
    vec2 end = vec2(leaning, 1.0) * form.y * (1.0 - form.z);
    vec2 half_along = vec2(form.x, 0.0);
    return inverse_bilinear(straightened(at_px, form.w), -half_along - start, half_along - end, -half_along + start, half_along + end);
}

// The mipmap level for a part of a tapered stroke: finer where it is wider than its middle, coarser where narrower.
float level_where_narrow(float level, float along, float taper) {
    return max(level - log2(max(1.0 + taper * (1.0 - 2.0 * along), 0.01)), 0.0);
}
