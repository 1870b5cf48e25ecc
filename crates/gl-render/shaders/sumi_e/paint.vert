// Places the four corners of a stroke of ink: a quad flat on the screen (round a tapered or bent stroke, its box). Its
// size is in pixels.
#include "shared/stroke_shape.glsl"
layout(location = 0) in vec4 place;          // centre in px, depth, angle in radians
layout(location = 1) in vec4 size;           // length and width in px, facing fade, supply_ln (see `Stroke`)
layout(location = 2) in uvec4 marks;         // random bits, body id, albedo, mark
layout(location = 3) in uvec2 bytes;         // opacity, thickness, pickup, dryness (lowest byte first); mixing
layout(location = 4) in vec4 normal_and_bow; // normal in world space; bow of the mark (see `Stroke`)
layout(location = 5) in vec4 reach;          // overrun in px, slow noise of hue and of edges, skew
layout(location = 6) in vec4 resolved;       // display colour, presence
layout(location = 7) in vec4 fitted;         // centre in px, moved onto its body; how dark it is
layout(location = 8) in vec2 shape;          // taper, bend in radians

uniform vec2 size_px;
uniform float mark_rows;         // texels across a mark
uniform float dryness;           // of the scene

out vec2 mark_at;                // place on the mark, 0..1; on a shaped stroke, px along and across it
out vec2 from_center_px;
flat out vec4 ink;               // rgb: what it takes from white; a: paint value in the middle of the mark's soft edge
flat out vec4 mark;              // number of the mark, level of detail, half the width of its soft edge, bow
flat out vec4 body;              // opacity, how dry it ends, overrun in px, sign of the flip
flat out vec2 own;               // depth and id of the body
flat out vec4 form;              // see shared/stroke_shape.glsl
flat out float leaning;          // skew

const float MARGIN = 1.0 / 0.84;
const float BYTE = 1.0 / 255.0;

void main() {
    float there = resolved.a;
    if (there <= 0.004) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        return;
    }
    float dry = float(bytes.x >> 24) * BYTE;
    float share = 0.98 * (1.0 - dry) * there;
    // Half the width of the soft edge, as a share of full paint: the smaller the stroke, the softer its edge.
    float soft = clamp(2.0 * (size.x + size.y) / (size.x * size.y), 0.03, 0.22);
    ink = vec4((1.0 - resolved.rgb) * fitted.z, mix(1.0 + soft, soft + 0.02, share));
    vec2 along = vec2(cos(place.w), sin(place.w));
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    from_center_px =
        (along * corner.x * size.x + (vec2(-along.y, along.x) + along * reach.w) * corner.y * size.y)
        * 0.5 * MARGIN;
    mark_at = corner * 0.5 + 0.5;
    float level = log2(mark_rows / (1.05 * size.y * MARGIN));
    form = vec4(0.0);
    leaning = reach.w;
    if (shape != vec2(0.0)) {
        form = vec4(0.5 * MARGIN * size.xy, shape.x, shape.y / max(size.x, 1e-6));
        mark_at = corner_of_box(corner, form, leaning);
        from_center_px = along * mark_at.x + vec2(-along.y, along.x) * mark_at.y;
    } else {
        level = max(level, 0.0);
    }
    mark = vec4(float(marks.w & 65535u), level, soft, normal_and_bow.w);
    // Less than half of the strokes run dry towards their ends, each by a different amount.
    float runs_dry = float((marks.x >> 8) & 255u) * BYTE;
    body = vec4(float(bytes.x & 255u) * BYTE, dryness * smoothstep(0.55, 1.0, runs_dry), reach.x,
                (marks.w & 65536u) == 0u ? 1.0 : -1.0);
    own = vec2(place.z, float(marks.y));
    gl_Position = vec4((fitted.xy + from_center_px) / size_px * 2.0 - 1.0, 0.0, 1.0);
}
