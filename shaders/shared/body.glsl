// The vertices of a body, as its morph and its noise put them. Every vertex shader that draws bodies takes them from here;
// `body_program.rs` sets the uniforms. With NOISE_DISPLACE the noise takes part;
// with CUTOUT a texture cuts holes.
#include "noise_displace/displace.glsl"
layout(location = 0) in vec3 position_in_model;
layout(location = 1) in vec3 normal_in_model;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec3 target_position;   // where the whole morph takes the vertex
layout(location = 4) in vec3 target_normal;
layout(location = 5) in vec3 shade;              // what the vertex takes away of each channel, linear

uniform mat4 world_from_model;
uniform float morph;             // how far the surface has turned into its target
#ifdef NOISE_DISPLACE
uniform vec4 lookup_u;           // rows: where in the noise a place looks
uniform vec4 lookup_v;
uniform float moves_normals;     // 1: normals turn with the displaced surface; 0: they stay
#endif
#ifdef CUTOUT
out vec2 cut_at;                 // for shared/cutout.glsl
#endif

// Model space.
struct BodyVertex {
    vec3 position;
    vec3 normal;
};

// The vertex at this share of the morph, without noise.
BodyVertex morphed(float share) {
    return BodyVertex(mix(position_in_model, target_position, share), mix(normal_in_model, target_normal, share));
}

// The vertex as it is in this picture.
BodyVertex body_vertex() {
    BodyVertex vertex = morphed(morph);
#ifdef CUTOUT
    cut_at = uv;
#endif
#ifdef NOISE_DISPLACE
    mat2x4 lookup = mat2x4(lookup_u, lookup_v);
    vec3 turned = displaced_normal(vertex.position, vertex.normal, lookup);
    vertex.position = displaced(vertex.position, vertex.normal, lookup);
    vertex.normal = mix(vertex.normal, turned, moves_normals);
#endif
    return vertex;
}
