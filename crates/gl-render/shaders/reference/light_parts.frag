// The light on every pixel of the surfaces, without their colours.
#include "shared/lens.glsl"
#include "reference/lighting.glsl"
uniform sampler2D albedo_and_lit;
uniform sampler2D normal;        // and gloss
uniform sampler2D depth_and_id;
uniform sampler2D openness;      // ambient occlusion: 0 enclosed .. 1 open; half the picture's size

layout(location = 0) out vec4 light_and_shadow;  // rgb: arriving light; a: arriving share of the shadow-casting light
layout(location = 1) out vec4 open;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 here = texelFetch(depth_and_id, at, 0).xy;
    light_and_shadow = vec4(0.0);
    open = vec4(1.0);
    if (here.y == 0.0) return;
    light_and_shadow = vec4(1.0);
    if (texelFetch(albedo_and_lit, at, 0).a == 0.0) return;
    vec4 normal_and_gloss = texelFetch(normal, at, 0);
    // A surface without a normal is coloured by noise. It counts as unlit: all values stay 1.
    if (dot(normal_and_gloss.xyz, normal_and_gloss.xyz) < 0.25) return;
    LitPoint point;
    point.position = world_from_px(gl_FragCoord.xy, here.x);
    point.normal = normalize(normal_and_gloss.xyz);
    point.towards_eye = towards_eye_from_px(gl_FragCoord.xy);
    point.openness = texture(openness, gl_FragCoord.xy / size_px).r;
    point.gloss = normal_and_gloss.w;
    Light light = light_on(point);
    light_and_shadow = vec4(light.diffuse, light.shadowed);
    open = vec4(point.openness);
}
