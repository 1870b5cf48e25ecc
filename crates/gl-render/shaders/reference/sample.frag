// A sample of a surface: depth, body and colour.
#include "shared/cutout.glsl"

in float depth_along_gaze;
in vec2 texture_at;
in vec3 tint;                  // of the vertices, linear

uniform vec3 albedo;
uniform sampler2D albedo_texture;
uniform float is_lit;
uniform float body_id;

layout(location = 0) out vec2 depth_and_id;
// The square root of the colour, so that 8 bits are enough for darks too.
layout(location = 1) out vec4 root_albedo;  // dropped if there is no target for it

void main() {
    cut_out();
    depth_and_id = vec2(depth_along_gaze, body_id);
    root_albedo = vec4(sqrt(albedo * tint * texture(albedo_texture, texture_at).rgb), is_lit);
}
