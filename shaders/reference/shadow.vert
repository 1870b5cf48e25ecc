// A body's vertices as the sun sees them.
layout(location = 0) in vec3 position_in_model;

uniform mat4 world_from_model;
uniform mat4 shadow_from_world;

void main() {
    gl_Position = shadow_from_world * (world_from_model * vec4(position_in_model, 1.0));
}
