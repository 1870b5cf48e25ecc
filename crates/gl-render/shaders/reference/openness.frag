// Ambient occlusion at half the picture's size: 1 where the surroundings are open, less where things touch. The pattern
// of taps is symmetric under quarter turns and never random, so nothing shimmers.
#include "shared/lens.glsl"
uniform sampler2D normal;
uniform sampler2D depth_and_id;
uniform mat4 view_from_world;

out vec4 openness;

const float RADIUS = 0.055;     // share of the picture's height

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy) * 2;
    ivec2 last = ivec2(size_px) - 1;
    at = min(at, last);
    vec2 here = texelFetch(depth_and_id, at, 0).xy;
    if (here.y == 0.0) {
        openness = vec4(1.0);
        return;
    }
    vec3 p = view_from_px(vec2(at) + 0.5, here.x);
    vec3 n = mat3(view_from_world) * texelFetch(normal, at, 0).xyz;
    float radius_px = RADIUS * size_px.y;
    float radius = radius_px * units_per_px(here.x);
    float closed = 0.0;
    for (int index = 0; index < 16; index++) {
        float ring = index < 8 ? 0.32 : 0.9;
        float angle = (float(index & 7) + (index < 8 ? 0.0 : 0.5)) * 0.78539816;
        vec2 offset_px = vec2(cos(angle), sin(angle)) * ring * radius_px;
        ivec2 tap = clamp(ivec2(floor(vec2(at) + 0.5 + offset_px)), ivec2(0), last);
        vec2 there = texelFetch(depth_and_id, tap, 0).xy;
        if (there.y == 0.0) continue;
        vec3 towards = view_from_px(vec2(tap) + 0.5, there.x) - p;
        float distance = length(towards);
        float rise = dot(n, towards) / max(distance, 1e-6);
        closed += max(rise - 0.12, 0.0) * clamp(1.6 - 1.2 * distance / radius, 0.0, 1.0);
    }
    openness = vec4(clamp(1.0 - 3.2 * closed / 16.0, 0.0, 1.0));
}
