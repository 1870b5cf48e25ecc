// A body's vertices as the sun sees them.
#include "noise_displace/displace.glsl"
layout(location = 0) in vec3 position_in_model;
layout(location = 3) in vec3 target_position;

uniform mat4 world_from_model;
uniform float morph;             // how far the surface has turned into its target
uniform mat4 shadow_from_world;
#ifdef NOISE_DISPLACE
uniform vec4 lookup_u;           // rows: where in the noise a place looks
uniform vec4 lookup_v;
layout(location = 1) in vec3 normal_in_model;
layout(location = 4) in vec3 target_normal;
#endif

void main() {
    vec3 position = mix(position_in_model, target_position, morph);
#ifdef NOISE_DISPLACE
    vec3 normal = mix(normal_in_model, target_normal, morph);
    position = displaced(position, normal, mat2x4(lookup_u, lookup_v));
#endif
    gl_Position = shadow_from_world * (world_from_model * vec4(position, 1.0));
}
