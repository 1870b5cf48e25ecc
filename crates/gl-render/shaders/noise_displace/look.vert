// The vertices of a body that noise colours.
#include "shared/body.glsl"

uniform mat4 view_from_world;
uniform mat4 clip_from_view;

out vec2 texture_at;
out float depth_along_gaze;

void main() {
    vec4 view = view_from_world * body_position();
    texture_at = uv;
    depth_along_gaze = -view.z;
    gl_Position = clip_from_view * view;
}
