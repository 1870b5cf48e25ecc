// For each pixel, where its surface point is in another picture: offset in px (Y up), depth along the gaze there, body.
// Both positions are interpolated in the same way, so they are equal for a body that stands still.
#include "shared/cutout.glsl"

in vec4 clip_now;
in vec4 clip_then;
in float depth_then;

uniform vec2 size_px;
uniform float body_id;

layout(location = 0) out vec4 motion;

void main() {
    cut_out();
    // A point behind the eye of a perspective lens has no place in the picture: its depth is 0.
    bool in_front = clip_then.w > 0.0;
    // Without this check, a body that stands still would get a tiny offset: graphics cards fuse one of the two
    // quotients with the subtraction, and so round the two differently.
    bool stands_still = clip_then == clip_now;
    vec2 offset = stands_still ? vec2(0.0) : clip_then.xy / clip_then.w - clip_now.xy / clip_now.w;
    motion = vec4(in_front ? offset * 0.5 * size_px : vec2(0.0), in_front ? depth_then : 0.0, body_id);
}
