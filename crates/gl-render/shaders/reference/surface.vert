// Projects a body's vertices into the picture.
#include "shared/body.glsl"

uniform mat3 world_from_normal;
uniform mat4 view_from_world;
uniform mat4 clip_from_view;

out vec3 position_in_world;
out vec3 normal_in_world;
out float depth_along_gaze;
out vec2 texture_at;
out vec3 tint;

void main() {
    vec4 world = body_position();
    vec4 view = view_from_world * world;
    position_in_world = world.xyz;
    normal_in_world = world_from_normal * normal_in_model;
    depth_along_gaze = -view.z;
    texture_at = uv;
    tint = 1.0 - shade;
    gl_Position = clip_from_view * view;
}
