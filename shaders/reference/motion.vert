// A body's vertices in this picture, and where they are in another.
#include "shared/body.glsl"

uniform mat4 world_from_model_then;
uniform float morph_then;
uniform mat4 view_from_world;
uniform mat4 view_from_world_then;
uniform mat4 clip_from_view;
uniform mat4 clip_from_view_then;
#ifdef NOISE_DISPLACE
uniform vec4 lookup_u_then;
uniform vec4 lookup_v_then;
#endif

out vec4 clip_now;
out vec4 clip_then;
out float depth_then;

void main() {
    vec3 now = body_vertex().position;
    BodyVertex then = morphed(morph_then);
#ifdef NOISE_DISPLACE
    then.position = displaced(then.position, then.normal, mat2x4(lookup_u_then, lookup_v_then));
#endif
    clip_now = clip_from_view * (view_from_world * (world_from_model * vec4(now, 1.0)));
    vec4 view_then = view_from_world_then * (world_from_model_then * vec4(then.position, 1.0));
    clip_then = clip_from_view_then * view_then;
    depth_then = -view_then.z;
    gl_Position = clip_now;
}
