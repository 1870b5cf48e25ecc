// Draws paint over its ground as a solid surface in the light of a room: relief, canvas where paint is thin, furrows,
// varnish.
#include "shared/encode.glsl"
#ifndef DRAFT
#include "shared/lens.glsl"
uniform sampler2D normal;            // of the surface, world space, towards the eye; 0 where noise colours it
#endif
uniform sampler2D picture;           // premultiplied, display-linear
uniform sampler2D reference_color;   // alpha 1 where a body is, or less where noise colours it
#ifndef DRAFT
uniform sampler2D surface;           // x: depth; y: body id; its fraction: half the share of the pixel off that body
uniform sampler2D height;            // of the paint, in brush thicknesses, and how wet it is
uniform sampler2D soft_height;       // `height` averaged by `soften.frag`; half the picture's size
uniform sampler2D canvas;            // one tile: height, and its slope in x and in y, each stored around 0.5
uniform vec3 to_light;               // unit, in the picture's space
uniform vec4 canvas_axes;            // canvas tiles per pixel: along x, along y
uniform vec2 canvas_origin;          // canvas tiles at the picture's lower left corner
#endif
uniform vec4 background;             // premultiplied, display-linear
#ifndef DRAFT
uniform vec4 tone;                   // rgb: ground under the paint; a: how far it hides a wash of the body's colour
#endif
uniform float wash;                  // how far the toned ground under a body's paint hides the background, 0..1
uniform vec4 finish;                 // relief, weave, varnish, output pixels per pixel of the scene's own size

layout(location = 0) out vec4 finished;          // straight alpha, display-linear
#ifdef DATA
layout(location = 1) out vec4 flat_paint;        // before the light of the room; premultiplied
layout(location = 2) out vec4 normal_and_height; // of the paint, in the picture's space
layout(location = 3) out vec2 wet_and_border;    // how wet it is; whether neighbours were mixed in
layout(location = 4) out vec4 ground;            // premultiplied
#endif

const float THICKNESS_PX = 1.6;      // of paint of height 1, pixels of the scene's own size
const float WEAVE_PX = 0.09;
#ifndef DRAFT
// Wet paint of one colour runs together. MELT: how far, 0..1. MELT_PX: over which two distances, pixels of the scene's
// own size. SAME: the difference of colour (of square roots of linear values) at which a neighbour counts 1/e as much
// as one of the same colour. MELTED_RELIEF: how much relief is left where paint has run together.
const float MELT = 0.85;
const vec2 MELT_PX = vec2(2.2, 4.5);
const float SAME = 0.05;
const float MELTED_RELIEF = 0.45;
#endif
const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);

#ifndef DRAFT
// Cosines between the normal and the direction to the eye: from the second down to the first, strokes fade until few
// are left. On a round body such flat angles lie within less than a pixel of the outline. On ground that runs to the
// horizon they fill a wide strip.
const vec2 FLAT = vec2(0.015, 0.08);

// How flat the angle is at which a surface is seen: 0 where no strokes have faded, 1 where the surface's own colour
// must replace those that have.
float flatness(ivec2 at) {
    vec3 facing = texelFetch(normal, at, 0).rgb;
    if (facing == vec3(0.0)) return 0.0;
    return 1.0 - smoothstep(FLAT.x, FLAT.y, dot(normalize(facing), towards_eye_from_px(vec2(at) + 0.5)));
}
#endif

vec4 toned_ground(ivec2 at) {
    vec4 body = texelFetch(reference_color, at, 0);
#ifdef DRAFT
    // A draft's ground also replaces the underpainting and the faintest strokes, so it hides all that is below.
    vec3 under = mix(body.rgb, vec3(0.10, 0.08, 0.06), 0.25);
    float hides = wash > 0.0 ? 1.0 : 0.0;
#else
    vec3 under = mix(body.rgb * vec3(0.90, 0.85, 0.80), tone.rgb, tone.a);
    float flat_there = flatness(at);
    under = mix(under, body.rgb, flat_there);
    float hides = wash > 0.0 ? mix(wash, 1.0, flat_there) : 0.0;
#endif
    // Where the background is transparent, so is the ground.
    return vec4(mix(background.rgb, under, hides * body.a * background.a), background.a);
}

#ifndef DRAFT
// The paint of a pixel. At the border of a body it is a mean over 3 × 3 pixels: the layers of paint end at slightly
// different places and would leave steps there.
vec4 paint_at(ivec2 at, out bool is_border) {
    ivec2 last = textureSize(surface, 0) - 1;
    float id = texelFetch(surface, at, 0).y;
    float border = fract(id);
    for (int index = 0; index < 4; index++) {
        ivec2 offset = (index & 2) == 0 ? ivec2(2 * (index & 1) - 1, 0) : ivec2(0, 2 * (index & 1) - 1);
        border += abs(texelFetch(surface, clamp(at + offset, ivec2(0), last), 0).y - id);
    }
    is_border = border != 0.0;
    if (!is_border) return texelFetch(picture, at, 0);
    vec4 sum = vec4(0.0);
    for (int index = 0; index < 9; index++) {
        ivec2 offset = ivec2(index % 3, index / 3) - 1;
        ivec2 there = clamp(at + offset, ivec2(0), last);
        sum += texelFetch(picture, there, 0) * float((2 - abs(offset.x)) * (2 - abs(offset.y)));
    }
    return sum / 16.0;
}

// Wet paint runs together with neighbours of nearly the same colour; edges between other colours stay. A speck runs
// into its surroundings. Returns rgb, and how much of the surroundings has the same colour, 0..1.
vec4 melted(vec3 color, float wet) {
    // Square roots stand in for encoded values.
    vec3 own = sqrt(max(color, 0.0));
    vec3 same_sum = own;
    vec3 sum = vec3(0.0);
    vec2 weights = vec2(1.0, 1e-4);
    vec2 texel = 1.0 / vec2(textureSize(picture, 0));
    for (int index = 0; index < 8; index++) {
        float angle = 1.57079633 * (float(index & 3) + 0.5 * float(index >> 2)) + 0.4;
        vec2 offset = vec2(cos(angle), sin(angle)) * finish.w * (index < 4 ? MELT_PX.x : MELT_PX.y);
        vec4 there = textureLod(picture, (gl_FragCoord.xy + offset) * texel, 0.0);
        vec3 root = sqrt(max(there.rgb, 0.0) / max(there.a, 1e-4));
        vec3 away = (root - own) / SAME;
        float same = there.a * exp(-dot(away, away));
        same_sum += same * root;
        sum += there.a * root;
        weights += vec2(same, there.a);
    }
    float same = (weights.x - 1.0) / 8.0;
    float alone = (1.0 - smoothstep(0.04, 0.16, same)) * weights.y / 8.0;
    vec3 mixed = mix(same_sum / weights.x, sum / weights.y, alone);
    vec3 root = mix(own, mixed, MELT * wet);
    return vec4(root * root, same);
}

// The surface of the paint: its normal, and how deep a furrow it has here.
vec4 surface_of_paint(float relief) {
    vec2 texel = 1.0 / vec2(textureSize(height, 0));
    vec2 at = gl_FragCoord.xy * texel;
    float step_px = max(0.6 * finish.w, 0.5);
    vec2 offset = step_px * texel;
    float right_above = textureLod(height, at + offset, 0.0).r;
    float left_below = textureLod(height, at - offset, 0.0).r;
    float left_above = textureLod(height, at + vec2(-offset.x, offset.y), 0.0).r;
    float right_below = textureLod(height, at + vec2(offset.x, -offset.y), 0.0).r;
    float mean = 0.25 * (right_above + left_below + left_above + right_below);
    float wide = textureLod(soft_height, at, 0.0).r;
    vec2 slope = vec2(right_above + right_below - left_above - left_below,
                      right_above + left_above - right_below - left_below) / (4.0 * step_px) * finish.w;
    slope *= THICKNESS_PX * relief;
    vec2 tile = canvas_origin + canvas_axes.xy * gl_FragCoord.x + canvas_axes.zw * gl_FragCoord.y;
    vec3 weave = texture(canvas, tile).rgb - 0.5;
    // Thick paint fills the weave.
    float bare = 0.10 + 0.90 * exp(-wide / 0.35);
    slope += weave.yz * (4.0 * WEAVE_PX * bare * finish.y);

    const float STRENGTH = 2.2;
    float furrow = clamp(THICKNESS_PX * (wide - mean), 0.0, 1.0) * min(relief, 1.0);
    return vec4(normalize(vec3(-STRENGTH * slope, 1.0)), furrow);
}

// How the light of the room falls on the paint's surface.
vec3 in_room_light(vec3 color, vec4 surface_here, float relief) {
    vec3 n = surface_here.xyz;
    float shade = clamp(dot(n, to_light) / to_light.z, 0.25, 1.9);
    vec3 halfway = normalize(to_light + vec3(0.0, 0.0, 1.0));
    float shine = max(pow(max(dot(n, halfway), 0.0), 42.0) - pow(halfway.z, 42.0), 0.0);
    color *= (1.0 + 0.62 * (shade - 1.0)) * (1.0 - 0.28 * surface_here.w);
    float value = clamp(dot(color, LUMINANCE), 0.0, 1.0);
    return color + 0.09 * min(relief, 2.0) * shine * (0.35 + 0.65 * sqrt(value));
}
#endif

// Varnish: deeper darks, fuller colour, a little warmer. Works on encoded values, which are nearly uniform to the eye.
vec3 varnished(vec3 color) {
    float value = dot(color, LUMINANCE);
    float contrast = 0.035 * sin(6.2831853 * (clamp(value, 0.0, 1.0) - 0.5));
    vec3 chroma = (color - value) * (1.0 + 0.07 * finish.z);
    return value + contrast * finish.z + chroma + vec3(0.004, 0.001, -0.005) * finish.z;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
#ifdef DRAFT
    vec4 laid = texelFetch(picture, at, 0);
#else
    bool is_border;
    vec4 laid = paint_at(at, is_border);
#endif
    vec4 below = toned_ground(at);
    vec4 both = laid + (1.0 - laid.a) * below;
    vec3 straight = both.rgb / max(both.a, 1e-6);
#ifndef DRAFT
    float relief = finish.x;
    float wet = texelFetch(height, at, 0).g;
    if (wet > 0.02) {
        vec4 mixed = melted(straight, wet);
        straight = mixed.rgb;
        relief *= mix(1.0, MELTED_RELIEF, wet * smoothstep(0.3, 0.9, mixed.a));
    }
    vec4 surface_here = finish.x > 0.0 || finish.y > 0.0 ? surface_of_paint(relief) : vec4(0.0, 0.0, 1.0, 0.0);
#ifdef DATA
    flat_paint = vec4(straight * both.a, both.a);
    normal_and_height = vec4(surface_here.xyz, texelFetch(height, at, 0).r);
    wet_and_border = vec2(wet, float(is_border));
    ground = below;
#endif
    if (finish.x > 0.0 || finish.y > 0.0) straight = in_room_light(straight, surface_here, relief);
#endif
    if (finish.z > 0.0) {
        vec3 encoded = varnished(srgb_from_linear(clamp(straight, 0.0, 1.0)));
        straight = linear_from_srgb(clamp(encoded, 0.0, 1.0));
    }
    finished = vec4(straight, both.a);
}
