// One stroke a vertex: its colour, and how much of it is there. What comes out is what is painted, and what
// `impasto strokes` reads back.
#include "shared/lens.glsl"
#include "reference/lighting.glsl"
layout(location = 0) in vec4 place;          // centre in px, depth, angle in radians
layout(location = 1) in vec3 size;           // length and width in px, presence
layout(location = 2) in uvec3 marks;         // random bits, body id, albedo (sRGB bytes, A 0 where unlit)
layout(location = 3) in vec3 normal_in_world;

uniform sampler2D reference_color;
uniform sampler2D depth_and_id;
uniform mat4 view_from_world;
uniform float underpainting;

out vec4 resolved;

vec2 surface_at(vec2 at_px) {
    ivec2 texel = clamp(ivec2(floor(at_px)), ivec2(0), textureSize(depth_and_id, 0) - 1);
    return texelFetch(depth_and_id, texel, 0).xy;
}

// How far the centre can be seen: taps round it, each compared with where the stroke's own plane would be there.
float seen(mat2 turn) {
    vec3 n = mat3(view_from_world) * normal_in_world;
    float unit = units_per_px(place.z);
    float slant = max(abs(n.z), 0.2);
    float radius_px = clamp(0.28 * sqrt(size.x * size.y), 2.0, 14.0);
    float bias = unit * (2.5 + 0.5 * radius_px / slant);
    float sum = 0.0;
    for (int index = 0; index < 9; index++) {
        float angle = float(index) * 0.78539816;
        vec2 offset_px = index == 8 ? vec2(0.0) : turn * vec2(cos(angle), sin(angle)) * radius_px;
        vec2 tap_px = clamp(place.xy + offset_px, vec2(0.5), size_px - 0.5);
        vec2 there = surface_at(tap_px);
        float own = place.z + dot(n.xy, tap_px - place.xy) * unit / (n.z < 0.0 ? -slant : slant);
        float hidden = there.y == 0.0 ? 0.0 : smoothstep(bias, 3.0 * bias, own - there.x);
        sum += 1.0 - hidden;
    }
    return sum / 9.0;
}

vec3 albedo_of(uint bytes) {
    vec3 encoded = vec3(bytes & 255u, (bytes >> 8) & 255u, (bytes >> 16) & 255u) / 255.0;
    vec3 high = pow((encoded + 0.055) / 1.055, vec3(2.4));
    return mix(high, encoded / 12.92, lessThanEqual(encoded, vec3(0.04045)));
}

void main() {
    mat2 turn = mat2(cos(place.w), sin(place.w), -sin(place.w), cos(place.w));
    float own_id = float(marks.y);
    // A box over the middle of the stroke, on its own body only; a wider one where the middle is behind something.
    vec2 step_px = size.xy * mix(0.16, 0.22, underpainting);
    vec3 sum = vec3(0.0);
    float weight = 0.0;
    for (int widening = 0; widening < 3 && weight == 0.0; widening++) {
        for (int y = -1; y <= 1; y++) {
            for (int x = -1; x <= 1; x++) {
                vec2 tap_px = place.xy + turn * (vec2(x, y) * step_px);
                ivec2 texel = clamp(ivec2(floor(tap_px)), ivec2(0), ivec2(size_px) - 1);
                if (surface_at(tap_px).y == own_id) {
                    sum += texelFetch(reference_color, texel, 0).rgb;
                    weight += 1.0;
                }
            }
        }
        step_px = vec2(max(step_px.x, step_px.y)) * 1.6;
    }
    vec3 color;
    if (weight > 0.0) {
        color = sum / weight;
    } else {
        vec3 albedo = albedo_of(marks.z);
        vec3 position = world_from_px(place.xy, place.z);
        color = (marks.z >> 24) == 0u ? albedo : lit(albedo, position, normalize(normal_in_world), 1.0);
    }
    resolved = vec4(color, size.z * seen(turn));
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
