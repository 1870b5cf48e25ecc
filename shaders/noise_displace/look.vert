// A body that noise colours, and may displace.
#include "noise_displace/displace.glsl"
layout(location = 0) in vec3 position_in_model;
layout(location = 1) in vec3 normal_in_model;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec3 target_position;
layout(location = 4) in vec3 target_normal;

uniform vec4 lookup_u;           // rows: where in the noise a place looks
uniform vec4 lookup_v;
uniform mat4 world_from_model;
uniform float morph;             // how far the surface has turned into its target
uniform mat4 view_from_world;
uniform mat4 clip_from_view;

out vec2 texture_at;
out float depth_along_gaze;

void main() {
    vec3 position = mix(position_in_model, target_position, morph);
    vec3 normal = mix(normal_in_model, target_normal, morph);
    position = displaced(position, normal, mat2x4(lookup_u, lookup_v));
    vec4 view = view_from_world * (world_from_model * vec4(position, 1.0));
    texture_at = uv;
    depth_along_gaze = -view.z;
    gl_Position = clip_from_view * view;
}
