// Places the four corners of a stroke and picks its level of detail: the least that drawing billboards takes.
layout(location = 0) in vec4 place;          // centre in px, depth, angle in radians
layout(location = 1) in vec4 size;           // length and width in px; z, w: unused
layout(location = 2) in uvec4 marks;         // w: mark; the rest: unused
layout(location = 6) in vec4 resolved;       // colour, alpha
layout(location = 7) in vec4 fitted;         // centre in px, moved along the stroke onto its body
uniform vec2 size_px;
uniform float mark_rows;
out vec2 mark_at;
flat out vec4 color;
flat out vec2 mark;                          // number of the mark, level of detail
const float MARGIN = 1.0 / 0.84;
void main() {
    if (resolved.a <= 0.004) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        return;
    }
    vec2 along = vec2(cos(place.w), sin(place.w));
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    vec2 from_center_px = (along * corner.x * size.x + vec2(-along.y, along.x) * corner.y * size.y) * 0.5 * MARGIN;
    mark_at = corner * 0.5 + 0.5;
    color = resolved;
    mark = vec2(float(marks.w & 65535u), max(log2(mark_rows / (1.05 * size.y * MARGIN)), 0.0));
    gl_Position = vec4((fitted.xy + from_center_px) / size_px * 2.0 - 1.0, 0.0, 1.0);
}
