// A body's vertices, with their normals in view space. As in the source, normals are unit at the vertices, and are not
// normalised again after interpolation.
#include "shared/body.glsl"

uniform mat3 world_from_normal;
uniform mat4 view_from_world;
uniform mat4 clip_from_view;

out vec3 normal_in_view;

void main() {
    vec4 view = view_from_world * body_position();
    vec3 n = mat3(view_from_world) * (world_from_normal * normal_in_model);
    float size = length(n);
    normal_in_view = size > 0.0 ? n / size : vec3(0.0);
    gl_Position = clip_from_view * view;
}
