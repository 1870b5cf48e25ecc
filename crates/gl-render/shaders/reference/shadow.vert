// A body's vertices as the light that casts shadows sees them.
#include "shared/body.glsl"

uniform mat4 shadow_from_world;

void main() {
    gl_Position = shadow_from_world * body_position();
}
