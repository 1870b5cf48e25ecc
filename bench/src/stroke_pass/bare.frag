// The fragment shader of the bare draw that our stroke pass is timed beside: takes one sample of the brush (paint,
// height), and writes colour to one target, height to the other.
in vec2 mark_at;
flat in vec4 color;
flat in vec2 mark;
uniform sampler2DArray brush_marks;
layout(location = 0) out vec4 over;
layout(location = 1) out vec4 height;
void main() {
    vec4 texel = textureLod(brush_marks, vec3(mark_at, mark.x), mark.y);
    over = vec4(color.rgb, 1.0) * texel.r;
    height = vec4(texel.g * texel.r, 0.0, 0.0, texel.r);
}
