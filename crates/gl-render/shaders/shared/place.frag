// Depth and body of a surface. Only the nearest surface is kept, so that a translucent body is blended once per pixel.
#include "shared/cutout.glsl"

in float depth_along_gaze;

uniform float body_id;

layout(location = 0) out vec2 depth_and_id;
layout(location = 1) out vec4 normal;       // 0: this body is coloured by noise

void main() {
    cut_out();
    depth_and_id = vec2(depth_along_gaze, body_id);
    normal = vec4(0.0);
}
