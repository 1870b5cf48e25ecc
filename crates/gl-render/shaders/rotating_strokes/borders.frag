// For each pixel, the body in its middle, and how much of the pixel shows something else.
uniform sampler2D depth_and_id;
#include "rotating_strokes/surface.glsl"

out vec2 surface;                // x: depth; y: body id; its fraction: 0.499 × the share of the pixel off that body

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    surface = texelFetch(depth_and_id, at, 0).xy;
    float others = 0.0;
    for (int index = 0; index < samples * samples; index++) {
        ivec2 sample_at = at * samples + ivec2(index % samples, index / samples);
        others += texelFetch(fine, sample_at, 0).y == surface.y ? 0.0 : 1.0;
    }
    surface.y += 0.499 * others / float(samples * samples);
}
