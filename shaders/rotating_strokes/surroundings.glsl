// What a stroke sees round itself on the reference picture. Everything changes slowly with the place looked at, so that
// what is decided by it fades and never switches.
uniform sampler2D reference_color;
uniform sampler2D depth_and_id;
uniform sampler2D glint;

vec2 surface_at(vec2 at_px) {
    ivec2 texel = clamp(ivec2(floor(at_px)), ivec2(0), textureSize(depth_and_id, 0) - 1);
    return texelFetch(depth_and_id, texel, 0).xy;
}

vec3 color_at(vec2 at_px) {
    ivec2 texel = clamp(ivec2(floor(at_px)), ivec2(0), textureSize(reference_color, 0) - 1);
    return texelFetch(reference_color, texel, 0).rgb;
}

vec2 direction(int index, int count) {
    float angle = 6.2831853 * (float(index) + 0.5) / float(count);
    return vec2(cos(angle), sin(angle));
}

// Mean colour on the stroke's own body: a Gaussian of this deviation, on two rings and their middle; a wider one where
// the middle is behind something. W is 0 where nothing of the body was found.
vec4 own_color(vec2 center_px, float id, float sigma_px) {
    vec3 sum = vec3(0.0);
    float weight = 0.0;
    for (int widening = 0; widening < 3 && weight == 0.0; widening++) {
        if (surface_at(center_px).y == id) {
            sum += color_at(center_px);
            weight += 1.0;
        }
        for (int index = 0; index < 12; index++) {
            float radius = index < 6 ? 1.1 : 2.1;
            vec2 tap_px = center_px + direction(index, 6) * (radius * sigma_px);
            if (surface_at(tap_px).y == id) {
                float share = index < 6 ? 0.55 : 0.11;
                sum += color_at(tap_px) * share;
                weight += share;
            }
        }
        sigma_px = max(sigma_px * 2.2, 3.0);
    }
    return weight > 0.0 ? vec4(sum / weight, 1.0) : vec4(0.0);
}

// How much happens round the stroke on its own body, 0..1: change of colour from pixel to pixel of a picture 720 high, and
// difference of lightness from a wider mean. `change` is the former alone, Oklab per pixel; `wide` the wider mean.
float detail_at(vec2 center_px, float id, vec3 lab, out float change, out vec3 wide) {
    const float NEAR_PX = 4.0;
    const float WIDE_PX = 10.0;
    vec3 slope_x = vec3(0.0);
    vec3 slope_y = vec3(0.0);
    wide = vec3(0.0);
    for (int index = 0; index < 8; index++) {
        vec2 towards = direction(index, 8);
        vec2 near_px = center_px + towards * NEAR_PX * px_scale;
        vec3 near = surface_at(near_px).y == id ? oklab_from_linear(color_at(near_px)) : lab;
        slope_x += (near - lab) * towards.x;
        slope_y += (near - lab) * towards.y;
        vec2 wide_px = center_px + towards * WIDE_PX * px_scale;
        wide += surface_at(wide_px).y == id ? oklab_from_linear(color_at(wide_px)) : lab;
    }
    wide /= 8.0;
    change = sqrt(dot(slope_x, slope_x) + dot(slope_y, slope_y)) * (2.0 / (8.0 * NEAR_PX));
    return clamp(max((change - 0.008) / 0.030, (abs(lab.x - wide.x) - 0.015) / 0.06), 0.0, 1.0);
}

// How near the body's own outline is, 0..1; where something stands in front of it is no outline of its own.
float rim_at(vec2 center_px, float id, float depth) {
    const float REACH_PX = 10.0;
    float bias = 0.02 * depth;
    float beyond = 0.0;
    for (int index = 0; index < 16; index++) {
        float radius_px = REACH_PX * px_scale * (index < 8 ? 1.0 : 0.5);
        vec2 there = surface_at(center_px + direction(index, 8) * radius_px);
        if (there.y == id) continue;
        beyond += there.y == 0.0 ? 1.0 : smoothstep(-bias, bias, there.x - depth);
    }
    return smoothstep(0.0, 0.35, beyond / 16.0);
}

float glint_at(vec2 center_px, float id) {
    float sum = 0.0;
    for (int index = 0; index < 5; index++) {
        vec2 tap_px = center_px + (index < 4 ? direction(index, 4) * 1.5 * px_scale : vec2(0.0));
        ivec2 texel = clamp(ivec2(floor(tap_px)), ivec2(0), textureSize(glint, 0) - 1);
        if (surface_at(tap_px).y == id) sum += texelFetch(glint, texel, 0).r;
    }
    return sum / 5.0;
}

// How far the stroke's body reaches from its centre in this direction, at most `most_px`. What stands in front of the
// body does not end it.
float extent_px(vec2 center_px, vec2 towards, float most_px, vec2 own) {
    float bias = 0.02 * own.x;
    float inside_px = 0.0;
    float outside_px = -1.0;
    for (int index = 1; index <= 8; index++) {
        float at_px = most_px * float(index) / 8.0;
        vec2 there = surface_at(center_px + towards * at_px);
        if (there.y != own.y && (there.y == 0.0 || there.x > own.x - bias)) {
            outside_px = at_px;
            break;
        }
        inside_px = at_px;
    }
    if (outside_px < 0.0) return most_px;
    for (int halving = 0; halving < 4; halving++) {
        float at_px = 0.5 * (inside_px + outside_px);
        vec2 there = surface_at(center_px + towards * at_px);
        bool beyond = there.y != own.y && (there.y == 0.0 || there.x > own.x - bias);
        if (beyond) outside_px = at_px; else inside_px = at_px;
    }
    return 0.5 * (inside_px + outside_px);
}
