// Lights every pixel of the surfaces.
#include "shared/lens.glsl"
#include "reference/lighting.glsl"
uniform sampler2D albedo_and_lit;
uniform sampler2D normal;
uniform sampler2D depth_and_id;
uniform sampler2D openness;      // half the size

out vec4 color;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 here = texelFetch(depth_and_id, at, 0).xy;
    if (here.y == 0.0) {
        color = vec4(0.0);
        return;
    }
    vec4 surface = texelFetch(albedo_and_lit, at, 0);
    if (surface.a == 0.0) {
        color = vec4(surface.rgb, 1.0);
        return;
    }
    vec3 position = world_from_px(gl_FragCoord.xy, here.x);
    float open = texture(openness, gl_FragCoord.xy / size_px).r;
    color = vec4(lit(surface.rgb, position, normalize(texelFetch(normal, at, 0).xyz), open), 1.0);
}
