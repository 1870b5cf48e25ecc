// Noise that moves vertices, as in `core::noise_displace`. It interpolates between four texels itself, because drivers differ
// in their precision.
uniform sampler2D vertex_noise;  // repeats, bottom row first
uniform float noise_scale;       // from the least noise to the greatest, model units
uniform float along_normal;      // 1: along the normal by the first channel; 0: each axis by a channel

vec3 noise_about_0(vec2 at) {
    ivec2 size = textureSize(vertex_noise, 0);
    vec2 texel = (at - floor(at)) * vec2(size) - 0.5;
    vec2 corner = floor(texel);
    vec2 part = texel - corner;
    ivec2 low = (ivec2(corner) + size) % size;
    ivec2 high = (low + 1) % size;
    vec3 a = texelFetch(vertex_noise, low, 0).rgb;
    vec3 b = texelFetch(vertex_noise, ivec2(high.x, low.y), 0).rgb;
    vec3 c = texelFetch(vertex_noise, ivec2(low.x, high.y), 0).rgb;
    vec3 d = texelFetch(vertex_noise, high, 0).rgb;
    return clamp(mix(mix(a, b, part.x), mix(c, d, part.x), part.y), 0.0, 1.0) - 0.5;
}

vec2 looked_up(vec3 position, mat2x4 lookup) {
    return vec4(position, 1.0) * lookup;
}

vec3 displaced(vec3 position, vec3 normal, mat2x4 lookup) {
    vec3 noise = noise_about_0(looked_up(position, lookup));
    return position + mix(noise, normalize(normal) * noise.x, along_normal) * noise_scale;
}

// The cofactor matrix of the displacement's derivative turns the normal.
vec3 displaced_normal(vec3 position, vec3 normal, mat2x4 lookup) {
    vec2 at = looked_up(position, lookup);
    vec2 texel = 1.0 / vec2(textureSize(vertex_noise, 0));
    vec3 n = normalize(normal);
    vec2 u = vec2(texel.x, 0.0);
    vec2 v = vec2(0.0, texel.y);
    vec3 along_u = (noise_about_0(at + u) - noise_about_0(at - u)) * (noise_scale / (2.0 * texel.x));
    vec3 along_v = (noise_about_0(at + v) - noise_about_0(at - v)) * (noise_scale / (2.0 * texel.y));
    along_u = mix(along_u, n * along_u.x, along_normal);
    along_v = mix(along_v, n * along_v.x, along_normal);
    mat3 moved = mat3(1.0) + outerProduct(along_u, lookup[0].xyz) + outerProduct(along_v, lookup[1].xyz);
    mat3 cofactor = mat3(cross(moved[1], moved[2]), cross(moved[2], moved[0]), cross(moved[0], moved[1]));
    return normalize(cofactor * n);
}
