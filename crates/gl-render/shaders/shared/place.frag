// Depth and body of a surface. Only the nearest surface is kept, so that a translucent body is blended once per pixel.
#include "shared/cutout.glsl"

in float depth_along_gaze;

uniform float body_id;

out vec2 depth_and_id;

void main() {
    cut_out();
    depth_and_id = vec2(depth_along_gaze, body_id);
}
