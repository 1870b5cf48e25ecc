// A body's vertices as the sun sees them.
layout(location = 0) in vec3 position_in_model;
layout(location = 3) in vec3 target_position;

uniform mat4 world_from_model;
uniform float morph;             // how far the surface has turned into its target
uniform mat4 shadow_from_world;

void main() {
    vec3 position = mix(position_in_model, target_position, morph);
    gl_Position = shadow_from_world * (world_from_model * vec4(position, 1.0));
}
