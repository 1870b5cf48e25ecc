// The studio: suns (the first casts shadows), point lights, light from above and below; then a soft shoulder.
uniform sampler2D lights;        // row 0: direction to a sun (w 0) or a point light's place (w 1); row 1: radiance
uniform int light_count;
uniform int shadowed_light;      // index of the light that casts shadows, or -1
uniform sampler2DShadow shadow_depth;
uniform mat4 shadow_from_world;
uniform float shadow_texel;      // world units
uniform vec3 ambient_above;
uniform vec3 ambient_below;

float sunlit(vec3 position, vec3 normal) {
    // Stepping off the surface keeps it from shading itself; more where the map sees it at a slant.
    vec3 from = position + normal * (2.5 * shadow_texel);
    vec3 at = (shadow_from_world * vec4(from, 1.0)).xyz * 0.5 + 0.5;
    if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
    vec2 texel = 1.9 / vec2(textureSize(shadow_depth, 0));
    float sum = 0.0;
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++)
            sum += texture(shadow_depth, vec3(at.xy + vec2(x, y) * texel, at.z - 0.0006));
    return sum / 9.0;
}

// Keeps hue, lets bright light roll off to white paper.
vec3 exposed(vec3 light) {
    vec3 c = light * 0.62;
    float luminance = dot(c, vec3(0.2126, 0.7152, 0.0722));
    return c * (1.0 + luminance / 1.44) / (1.0 + luminance) * 1.25;
}

vec3 lit(vec3 albedo, vec3 position, vec3 normal, float openness) {
    vec3 light = mix(ambient_below, ambient_above, 0.5 + 0.5 * normal.y) * openness;
    for (int index = 0; index < light_count; index++) {
        vec4 place = texelFetch(lights, ivec2(index, 0), 0);
        vec3 towards = place.xyz - position * place.w;
        float squared = place.w > 0.0 ? max(dot(towards, towards), 1e-6) : 1.0;
        float facing = max(dot(normal, normalize(towards)), 0.0) / squared;
        if (facing <= 0.0) continue;
        if (index == shadowed_light) facing *= sunlit(position, normal);
        // What is crowded in gets a little less of the direct light too.
        light += texelFetch(lights, ivec2(index, 1), 0).rgb * facing * mix(0.7, 1.0, openness);
    }
    return exposed(albedo * light);
}
