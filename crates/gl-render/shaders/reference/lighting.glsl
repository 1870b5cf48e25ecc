// Lighting by suns, point lights and ambient light from above and below, then a soft shoulder. The first sun casts
// shadows; without a sun, the brightest point light does.

// A column per light, made by `column` in lighting.rs. Row 0: direction to a sun (w 0) or place of a point light (w 1).
// Row 1: radiance; w: slope. Row 2: axis of the cone; w: offset. The cone lets (slope * cosine + offset)² through.
uniform sampler2D lights;
uniform int light_count;
uniform int shadowed_light;      // index of the light that casts shadows, or -1
uniform sampler2DShadow shadow_depth;
uniform mat4 shadow_from_world;
uniform float shadow_texel;      // side of a texel in world units; for a lamp, at a distance of 1 from it
uniform vec2 shadow_bias;        // x: constant depth; y: depth that is divided by the square of a lamp's distance
uniform vec3 ambient_above;
uniform vec3 ambient_below;

// The distance from a lamp, along the axis of its map; 1 for a sun.
float away_from_lamp(vec3 position) {
    return (shadow_from_world * vec4(position, 1.0)).w;
}

// The share of the shadow-casting light that arrives, 0..1: a mean over a grid of `side` x `side` places on the map, up
// to `spread` texels away.
float sunlit(vec3 position, vec3 normal, int side, float spread) {
    float away = away_from_lamp(position);
    if (away <= 0.0) return 1.0;
    // An offset along the normal keeps the surface from shadowing itself. Measured along the ray of the light, the
    // offset grows as the light becomes more slanted.
    vec3 from = position + normal * (2.5 * shadow_texel * away);
    vec4 clip = shadow_from_world * vec4(from, 1.0);
    vec3 at = clip.xyz / clip.w * 0.5 + 0.5;
    float bias = shadow_bias.x + shadow_bias.y / (away * away);
    if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
#ifdef DRAFT
    // Interpolates between four texels.
    return texture(shadow_depth, vec3(at.xy, at.z - bias));
#else
    vec2 reach = spread / vec2(textureSize(shadow_depth, 0));
    float sum = 0.0;
    for (int index = 0; index < side * side; index++) {
        vec2 step = 2.0 * vec2(index % side, index / side) / float(side - 1) - 1.0;
        sum += texture(shadow_depth, vec3(at.xy + step * reach, at.z - bias));
    }
    return sum / float(side * side);
#endif
}

// The soft shoulder: compresses bright light and keeps its hue.
vec3 exposed(vec3 light) {
    vec3 c = light * 0.62;
    float luminance = dot(c, vec3(0.2126, 0.7152, 0.0722));
    return c * (1.0 + luminance / 1.44) / (1.0 + luminance) * 1.25;
}

// A point of a surface, ready to be lit.
struct LitPoint {
    vec3 position;               // world space, like the normal
    vec3 normal;
    vec3 towards_eye;            // unit
    float openness;              // ambient occlusion: 0 enclosed .. 1 open
    float gloss;                 // 0 matt .. 1 glazed
};

struct Light {
    vec3 diffuse;                // what arrives from everywhere; a matt surface reflects this times its albedo
    vec3 highlight;              // what a glazed surface reflects in addition
    float glint;                 // how strong the highlight is: 0 none; near lights, or many, give more than 1
    float shadowed;              // share of the shadow-casting light that arrives, 0..1
};

float shadow_of_point(LitPoint at) {
    return sunlit(at.position, at.normal, 3, 1.9);
}

// The share of the shadow-casting light that arrives at a point. `light.frag` has its own version, a mean over the
// samples of the pixel.
#ifdef SHADOW_OF_SAMPLES
float shadow_at(LitPoint at);
#else
float shadow_at(LitPoint at) {
    return shadow_of_point(at);
}
#endif

Light light_on(LitPoint at) {
    vec3 light = mix(ambient_below, ambient_above, 0.5 + 0.5 * at.normal.y) * at.openness;
    vec3 highlight = vec3(0.0);
    float glint = 0.0;
    float shadowed = shadowed_light < 0 ? 1.0 : 0.0;
    float sharpness = mix(12.0, 220.0, at.gloss);
    for (int index = 0; index < light_count; index++) {
        vec4 place = texelFetch(lights, ivec2(index, 0), 0);
        vec4 radiance_and_slope = texelFetch(lights, ivec2(index, 1), 0);
        vec3 radiance = radiance_and_slope.rgb;
        vec4 cone = texelFetch(lights, ivec2(index, 2), 0);
        vec3 towards = place.xyz - at.position * place.w;
        float squared = place.w > 0.0 ? max(dot(towards, towards), 1e-6) : 1.0;
        vec3 direction = normalize(towards);
        float facing = max(dot(at.normal, direction), 0.0);
        if (facing <= 0.0) continue;
        float within = clamp(radiance_and_slope.w * dot(cone.xyz, -direction) + cone.w, 0.0, 1.0);
        float arriving = within * within / squared;
        if (index == shadowed_light) {
            shadowed = shadow_at(at);
            arriving *= shadowed;
        }
        // Enclosed places get a little less direct light too.
        light += radiance * facing * arriving * mix(0.7, 1.0, at.openness);
        if (at.gloss > 0.0) {
            vec3 halfway = normalize(direction + at.towards_eye);
            float lobe = pow(max(dot(at.normal, halfway), 0.0), sharpness) * smoothstep(0.0, 0.2, facing);
            float strength = 0.9 * at.gloss * lobe * arriving;
            highlight += strength * radiance;
            glint += strength * min(dot(radiance, vec3(0.2126, 0.7152, 0.0722)), 1.0);
        }
    }
    return Light(light, highlight, glint, shadowed);
}

// Display-linear colour.
vec3 lit(vec3 albedo, LitPoint at) {
    Light light = light_on(at);
    return exposed(albedo * light.diffuse + light.highlight);
}
