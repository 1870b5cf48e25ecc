// Four corners of a stroke: a billboard of constant size on the screen, turned in pixels.
layout(location = 0) in vec4 place;          // centre in px, depth, angle in radians
layout(location = 1) in vec3 size;           // length and width in px, presence
layout(location = 2) in uvec3 marks;         // random bits, body id, albedo
layout(location = 4) in vec4 resolved;       // colour and how much is there

uniform vec2 size_px;
uniform float tip_rows;          // texels across a tip
uniform float tip_count;
uniform float underpainting;

out vec2 tip_at;
out vec2 from_center_px;
flat out vec4 paint;             // colour and the height at which the mark is cut off
flat out vec3 tip;               // tip number, level of detail, sign of the flip
flat out vec2 own;               // depth and id of the body

const float MARGIN = 1.0 / 0.84;

// Half the width of a mark's soft edge, in height. Heights are spread evenly over the mark, so this is a share of it.
const float SOFT = 0.08;

void main() {
    float there = resolved.a;
    if (there <= 0.004) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        return;
    }
    uint bits = marks.x;
    float dry = float((bits >> 8) & 255u) / 255.0;
    // A drier brush leaves less of its mark; as the stroke goes away, what is left of it erodes to its last hairs.
    float share = mix(0.98, 0.80, dry * dry) * there;
    paint = vec4(resolved.rgb, mix(1.0 + SOFT, SOFT + 0.02, share));
    if (underpainting > 0.5) {
        // Thin, earthy, a little quieter than what goes over it.
        float grey = dot(paint.rgb, vec3(0.2126, 0.7152, 0.0722));
        paint.rgb = mix(vec3(grey), paint.rgb, 0.88) * vec3(0.93, 0.88, 0.82);
    }
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    vec2 along = vec2(cos(place.w), sin(place.w));
    from_center_px = (along * corner.x * size.x + vec2(-along.y, along.x) * corner.y * size.y) * 0.5 * MARGIN;
    tip_at = corner * 0.5 + 0.5;
    // A constant level keeps the mark the same at every angle.
    tip = vec3(
        mod(float(bits & 255u), tip_count),
        max(log2(tip_rows / (size.y * MARGIN)), 0.0),
        (bits & 65536u) == 0u ? 1.0 : -1.0
    );
    own = vec2(place.z, float(marks.y));
    gl_Position = vec4((place.xy + from_center_px) / size_px * 2.0 - 1.0, 0.0, 1.0);
}
