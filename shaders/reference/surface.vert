// A body's vertices into the picture.
#include "shared/body.glsl"

uniform mat4 view_from_world;
uniform mat4 clip_from_view;

out vec3 position_in_world;
out vec3 normal_in_world;
out float depth_along_gaze;
out vec2 texture_at;
out vec3 tint;

void main() {
    BodyVertex vertex = body_vertex();
    vec4 world = world_from_model * vec4(vertex.position, 1.0);
    vec4 view = view_from_world * world;
    position_in_world = world.xyz;
    normal_in_world = mat3(world_from_model) * vertex.normal;
    depth_along_gaze = -view.z;
    texture_at = uv;
    tint = 1.0 - shade;
    gl_Position = clip_from_view * view;
}
