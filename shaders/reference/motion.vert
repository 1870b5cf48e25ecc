// A body's vertices in this picture, with where they are in another.
#include "noise_displace/displace.glsl"
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
#ifdef NOISE_DISPLACE
uniform vec4 lookup_u;           // rows: where in the noise a place looks
uniform vec4 lookup_v;
uniform vec4 lookup_u_then;
uniform vec4 lookup_v_then;
layout(location = 1) in vec3 normal_in_model;
layout(location = 4) in vec3 target_normal;
#endif

out vec4 clip_now;
out vec4 clip_then;
out float depth_then;

void main() {
    vec4 now = vec4(mix(position_in_model, target_position, morph), 1.0);
    vec4 then = vec4(mix(position_in_model, target_position, morph_then), 1.0);
#ifdef NOISE_DISPLACE
    vec3 normal = mix(normal_in_model, target_normal, morph);
    vec3 normal_then = mix(normal_in_model, target_normal, morph_then);
    now.xyz = displaced(now.xyz, normal, mat2x4(lookup_u, lookup_v));
    then.xyz = displaced(then.xyz, normal_then, mat2x4(lookup_u_then, lookup_v_then));
#endif
    clip_now = clip_from_view * (view_from_world * (world_from_model * now));
    vec4 view_then = view_from_world_then * (world_from_model_then * then);
    clip_then = clip_from_view_then * view_then;
    depth_then = -view_then.z;
    gl_Position = clip_now;
}
