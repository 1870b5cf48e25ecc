// A body's vertices, with their normals in the eye's space: unit at the vertices, and not again in between, as in the source.
layout(location = 0) in vec3 position_in_model;
layout(location = 1) in vec3 normal_in_model;
layout(location = 3) in vec3 target_position;
layout(location = 4) in vec3 target_normal;

uniform mat4 world_from_model;
uniform float morph;             // how far the surface has turned into its target
uniform mat4 view_from_world;
uniform mat4 clip_from_view;

out vec3 normal_in_view;

void main() {
    vec4 world = world_from_model * vec4(mix(position_in_model, target_position, morph), 1.0);
    vec4 view = view_from_world * world;
    vec3 n = mat3(view_from_world) * (mat3(world_from_model) * mix(normal_in_model, target_normal, morph));
    float size = length(n);
    normal_in_view = size > 0.0 ? n / size : vec3(0.0);
    gl_Position = clip_from_view * view;
}
