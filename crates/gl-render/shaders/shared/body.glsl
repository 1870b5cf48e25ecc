// The vertices of a body, which are uploaded already bent into the shape that the body has in this picture. Every
// vertex shader that draws bodies includes this file; `body_program.rs` sets the uniforms. With CUTOUT, a texture cuts
// holes.
layout(location = 0) in vec3 position_in_model;
layout(location = 1) in vec3 normal_in_model;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec3 shade;              // 1 minus the vertex's colour, linear

uniform mat4 world_from_model;
#ifdef CUTOUT
out vec2 cut_at;                 // for shared/cutout.glsl
#endif

// World space.
vec4 body_position() {
#ifdef CUTOUT
    cut_at = uv;
#endif
    return world_from_model * vec4(position_in_model, 1.0);
}
