// Places a body's vertices in this picture, and says where they are in another one.
#include "shared/body.glsl"
layout(location = 4) in vec3 position_then;      // model space

uniform mat4 world_from_model_then;
uniform mat4 view_from_world;
uniform mat4 view_from_world_then;
uniform mat4 clip_from_view;
uniform mat4 clip_from_view_then;

out vec4 clip_now;
out vec4 clip_then;
out float depth_then;

void main() {
    clip_now = clip_from_view * (view_from_world * body_position());
    vec4 view_then = view_from_world_then * (world_from_model_then * vec4(position_then, 1.0));
    clip_then = clip_from_view_then * view_then;
    depth_then = -view_then.z;
    gl_Position = clip_now;
}
