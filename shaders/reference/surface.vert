// A body's vertices into the picture.
#include "noise_displace/displace.glsl"
layout(location = 0) in vec3 position_in_model;
layout(location = 1) in vec3 normal_in_model;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec3 target_position;
layout(location = 4) in vec3 target_normal;

uniform mat4 world_from_model;
uniform float morph;             // how far the surface has turned into its target
uniform mat4 view_from_world;
uniform mat4 clip_from_view;
#ifdef NOISE_DISPLACE
uniform vec4 lookup_u;           // rows: where in the noise a place looks
uniform vec4 lookup_v;
uniform float moves_normals;
#endif

out vec3 position_in_world;
out vec3 normal_in_world;
out float depth_along_gaze;
out vec2 texture_at;

void main() {
    vec3 position = mix(position_in_model, target_position, morph);
    vec3 normal = mix(normal_in_model, target_normal, morph);
#ifdef NOISE_DISPLACE
    mat2x4 lookup = mat2x4(lookup_u, lookup_v);
    vec3 turned = displaced_normal(position, normal, lookup);
    position = displaced(position, normal, lookup);
    normal = mix(normal, turned, moves_normals);
#endif
    vec4 world = world_from_model * vec4(position, 1.0);
    vec4 view = view_from_world * world;
    position_in_world = world.xyz;
    normal_in_world = mat3(world_from_model) * normal;
    depth_along_gaze = -view.z;
    texture_at = uv;
    gl_Position = clip_from_view * view;
}
