// Lights every pixel of the surfaces. A style may ask for a part of the strong highlights apart from the colour.
#include "shared/lens.glsl"
#include "reference/lighting.glsl"
uniform sampler2D albedo_and_lit;
uniform sampler2D normal;        // rgb: normal in world space, a: gloss
uniform sampler2D depth_and_id;
uniform sampler2D openness;      // ambient occlusion: 0 enclosed .. 1 open; half the picture's size
uniform float highlight_in_color; // the share of a strong highlight that `color` has, 0..1

layout(location = 0) out vec4 color;
layout(location = 1) out vec4 glint;
layout(location = 2) out vec4 highlight; // what `color` leaves out, display-linear

// By how much luminance a highlight makes the surface lighter: from the first on it is in part a strong one, from the second
// wholly. `color` has all of a faint sheen.
const vec2 STRONG = vec2(0.10, 0.28);

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
    vec3 whole = exposed(matt + light.highlight);
    float lighter = dot(whole - exposed(matt), vec3(0.2126, 0.7152, 0.0722));
    float share = mix(1.0, highlight_in_color, smoothstep(STRONG.x, STRONG.y, lighter));
    color = vec4(exposed(matt + share * light.highlight), 1.0);
    highlight.rgb = max(whole - color.rgb, 0.0);
    glint.r = light.glint;
}
