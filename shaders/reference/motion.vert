// A body's vertices in this picture, with where they are in another.
layout(location = 0) in vec3 position_in_model;
layout(location = 3) in vec3 target_position;

uniform mat4 world_from_model;
uniform mat4 world_from_model_then;
uniform float morph;             // how far the surface has turned into its target
uniform float morph_then;
uniform mat4 view_from_world;
uniform mat4 view_from_world_then;
uniform mat4 clip_from_view;
uniform mat4 clip_from_view_then;

out vec4 clip_now;
out vec4 clip_then;
out float depth_then;

void main() {
    vec4 now = vec4(mix(position_in_model, target_position, morph), 1.0);
    vec4 then = vec4(mix(position_in_model, target_position, morph_then), 1.0);
    clip_now = clip_from_view * (view_from_world * (world_from_model * now));
    vec4 view_then = view_from_world_then * (world_from_model_then * then);
    clip_then = clip_from_view_then * view_then;
    depth_then = -view_then.z;
    gl_Position = clip_now;
}
