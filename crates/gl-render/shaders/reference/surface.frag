// The surface before it is lit: colour, normal, depth and body.
#include "shared/cutout.glsl"

in vec3 position_in_world;
in vec3 normal_in_world;
in float depth_along_gaze;
in vec2 texture_at;
in vec3 tint;                  // of the vertices, linear

uniform vec3 albedo;
uniform sampler2D albedo_texture;
uniform float is_lit;
uniform float body_id;
uniform float gloss;
uniform vec4 eye;              // w 1: position of the eye; w 0: direction to an eye infinitely far away

layout(location = 0) out vec4 albedo_and_lit;
layout(location = 1) out vec4 normal;           // and gloss
layout(location = 2) out vec2 depth_and_id;

void main() {
    cut_out();
    vec3 towards_eye = eye.xyz - position_in_world * eye.w;
    vec3 n = normalize(normal_in_world);
    albedo_and_lit = vec4(albedo * tint * texture(albedo_texture, texture_at).rgb, is_lit);
    normal = vec4(dot(n, towards_eye) < 0.0 ? -n : n, gloss);
    depth_and_id = vec2(depth_along_gaze, body_id);
}
