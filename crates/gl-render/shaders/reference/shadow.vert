// A body's vertices as the sun sees them.
#include "shared/body.glsl"

uniform mat4 shadow_from_world;

void main() {
    gl_Position = shadow_from_world * body_position();
}
