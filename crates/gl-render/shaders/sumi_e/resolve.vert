// One stroke per vertex: finds its ink, its presence, and where it lies on its body.
#include "shared/lens.glsl"
#include "sumi_e/inked.glsl"
layout(location = 0) in vec4 place;          // centre in px, depth, angle in radians
layout(location = 1) in vec4 size;           // length and width in px, facing fade, supply_ln (see `Stroke`)
layout(location = 2) in uvec4 marks;         // random bits, body id, albedo, mark
layout(location = 3) in uvec2 bytes;         // paint, mixing
layout(location = 4) in vec4 normal_and_bow; // normal in world space; bow of the mark (see `Stroke`)
layout(location = 5) in vec4 reach;          // overrun in px, slow noise of hue and of edges, skew

uniform mat4 view_from_world;
uniform sampler2D depth_and_id;
uniform sampler2D soft;          // silhouette, interior, seal red, body
uniform sampler2D pigments;      // a row per palette: display values; w: how far strokes keep to them, 0 past the last
uniform vec3 ink;
uniform vec3 seal;
uniform int kind;                // layer of paint

out vec4 resolved;               // display colour, presence
out vec4 fitted;                 // centre in px, moved onto its body; how dark it is; unused

// The layers of paint that have ink strokes, numbered as in `LayerKind`.
const int BODY = 1;
const int FORM = 2;
const int SCUMBLE = 3;
const int ACCENTS = 4;

const uint ANY_COLOR = 255u;
const float FREE = 1e6;
const float LEAST = 0.004;

uint scramble(uint value) {
    uint state = value * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

// A random number with mean 0 and standard deviation 1, from four bytes of a hash.
float normal_from(uint bits, uint which) {
    uint hash = scramble(bits ^ scramble(which));
    float sum = float(hash & 255u) + float((hash >> 8) & 255u) + float((hash >> 16) & 255u) + float(hash >> 24);
    return (sum / 255.0 - 2.0) * 1.7320508;
}

vec2 surface_at(vec2 at_px) {
    ivec2 texel = clamp(ivec2(floor(at_px)), ivec2(0), textureSize(depth_and_id, 0) - 1);
    return texelFetch(depth_and_id, texel, 0).xy;
}

// How much of the centre is visible: taps around it, each compared with the depth of the stroke's own plane there.
float seen(mat2 turn) {
    vec3 n = mat3(view_from_world) * normal_and_bow.xyz;
    float unit = units_per_px(place.z);
    float facing = facing_at_px(n, place.xy);
    float slant = max(abs(facing), 0.2);
    float radius_px = max(0.28 * sqrt(size.x * size.y), 2.0);
    float bias = unit * (2.5 + 0.5 * radius_px / slant);
    float sum = 0.0;
    for (int index = 0; index < 13; index++) {
        float angle = 1.0471976 * (float(index) + (index < 6 ? 0.0 : 0.5));
        float ring_px = index < 6 ? radius_px : index < 12 ? 0.55 * radius_px : 0.0;
        vec2 tap_px = clamp(place.xy + turn * vec2(cos(angle), sin(angle)) * ring_px, vec2(0.5), size_px - 0.5);
        vec2 there = surface_at(tap_px);
        float own = place.z + dot(n.xy, tap_px - place.xy) * unit / (facing < 0.0 ? -slant : slant);
        float hidden = there.y == 0.0 ? 0.0 : smoothstep(bias, 3.0 * bias, own - there.x);
        sum += 1.0 - hidden;
    }
    return sum / 13.0;
}

// How much of the way from the stroke's centre to one of its ends lies on its body.
float share_on_body(vec2 to_end_px) {
    float on = 0.0;
    for (int index = 0; index < 12; index++) {
        vec2 there = surface_at(place.xy + to_end_px * (float(index) + 0.5) / 12.0);
        if (there.y == float(marks.y)) on += 1.0 / 12.0;
    }
    return on;
}

// Shift along the stroke that puts as much of it as possible on its body.
float shift(vec2 along) {
    if (reach.x >= FREE) return 0.0;
    vec2 half_px = along * (0.5 * size.x);
    float past = (reach.x + 0.2 * size.x) / (0.5 * size.x);
    float forward = min(share_on_body(half_px) + past, 1.0);
    float back = min(share_on_body(-half_px) + past, 1.0);
    return 0.25 * size.x * (forward - back);
}

// As in `impasto_core::presence`, times the facing fade.
float presence(float supply_ln) {
    return max(smoothstep(0.0, 1.0, 0.5333823 + supply_ln / 1.4) - 0.1, 0.0) / 0.9 * size.z;
}

// The mean ink along the stroke: silhouette, interior, seal red.
vec3 ink_round(vec2 along) {
    vec4 sum = vec4(0.0);
    for (int index = -2; index <= 2; index++) {
        vec2 tap_px = place.xy + along * (0.12 * size.x * float(index));
        sum += textureLod(soft, tap_px / size_px, 0.0) * (index == 0 ? 2.0 : 1.0);
    }
    return sum.rgb / max(sum.a, 1e-3);
}

vec3 pigment_of(float red) {
    uint palette = bytes.y >> 24;
    vec3 bare = mix(ink, seal, red);
    if (palette == ANY_COLOR) return bare;
    int count = 0;
    while (count < textureSize(pigments, 0).x && texelFetch(pigments, ivec2(count, int(palette)), 0).w > 0.0) count++;
    int chosen = int(scramble(marks.x ^ 77u) % uint(max(count, 1)));
    vec4 pigment = texelFetch(pigments, ivec2(chosen, int(palette)), 0);
    return count > 0 ? mix(bare, pigment.rgb, pigment.w) : ink;
}

void main() {
    vec2 along = vec2(cos(place.w), sin(place.w));
    mat2 turn = mat2(along, vec2(-along.y, along.x));
    resolved = vec4(0.0);
    fitted = vec4(place.xy, 0.0, 0.0);
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
    float there = presence(size.w);
    // Unlit surfaces have no strokes: only the wash shows them.
    if (there <= LEAST || (marks.z >> 24) == 0u) return;
    if (!gets_ink(int(marks.y))) return;

    vec3 found = ink_round(along);
    float rim = found.r, tone = found.g, red = clamp(found.b, 0.0, 1.0);
    float lost = clamp(0.62 + 0.45 * reach.z, 0.0, 1.0);
    float dark = 0.0;
    if (kind == BODY) {
        // The lightest tone is the paper itself.
        there *= max(smoothstep(0.10, 0.34, tone), red);
        dark = tone * (1.3 - 0.3 * tone);
    } else if (kind == FORM) {
        there *= smoothstep(0.45, 0.85, rim) * lost;
        dark = max(0.74, tone) + 0.22 * (rim - 0.5);
    } else if (kind == SCUMBLE) {
        there *= smoothstep(0.16, 0.42, tone) * smoothstep(0.3, 0.8, lost);
        dark = tone + 0.2;
    } else if (kind == ACCENTS) {
        there *= smoothstep(0.62, 0.85, max(tone, 0.9 * rim)) * lost;
        dark = 0.95;
    } else {
        return;
    }
    dark = mix(dark, max(dark, 0.58 + 0.4 * tone), red);
    if (there > LEAST) there *= seen(turn);
    if (there <= LEAST) return;
    dark = clamp(dark * (1.0 + 0.17 * normal_from(marks.x, 1u)), 0.0, 1.0);
    resolved = vec4(pigment_of(red), there);
    fitted = vec4(place.xy + along * shift(along), dark, 0.0);
}
