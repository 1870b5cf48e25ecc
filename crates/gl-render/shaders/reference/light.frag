// Lights every pixel of the surfaces. A style may ask for a part of the highlights apart from the colour.
#include "shared/lens.glsl"
#include "reference/lighting.glsl"
uniform sampler2D albedo_and_lit;
uniform sampler2D normal;        // rgb: normal in world space, a: gloss
uniform sampler2D depth_and_id;
uniform sampler2D openness;      // ambient occlusion: 0 enclosed .. 1 open; half the picture's size
uniform float highlight_in_color; // the share of the highlights that `color` has, 0..1

layout(location = 0) out vec4 color;
layout(location = 1) out vec4 glint;
layout(location = 2) out vec4 highlight; // what `color` leaves out, display-linear

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 here = texelFetch(depth_and_id, at, 0).xy;
    color = vec4(0.0);
    glint = vec4(0.0);
    highlight = vec4(0.0);
    if (here.y == 0.0) return;
    vec4 surface = texelFetch(albedo_and_lit, at, 0);
    if (surface.a == 0.0) {
        color = vec4(surface.rgb, 1.0);
        return;
    }
    vec4 normal_and_gloss = texelFetch(normal, at, 0);
    LitPoint point;
    point.position = world_from_px(gl_FragCoord.xy, here.x);
    point.normal = normalize(normal_and_gloss.xyz);
    point.towards_eye = towards_eye_from_px(gl_FragCoord.xy);
    point.openness = texture(openness, gl_FragCoord.xy / size_px).r;
    point.gloss = normal_and_gloss.w;
    Light light = light_on(point);
    vec3 matt = surface.rgb * light.diffuse;
    color = vec4(exposed(matt + highlight_in_color * light.highlight), 1.0);
    highlight.rgb = max(exposed(matt + light.highlight) - color.rgb, 0.0);
    glint.r = light.glint;
}
