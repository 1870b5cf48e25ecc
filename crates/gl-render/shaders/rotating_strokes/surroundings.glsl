// What surrounds a stroke in the reference picture. Everything here changes slowly with position, so that what depends
// on it fades and never switches.
uniform sampler2D reference_color;
uniform sampler2D highlight;     // what highlights add to `reference_color`, display-linear; only for kind LIGHTS
uniform sampler2D depth_and_id;
uniform sampler2D normal;        // of the surface, world space, towards the eye; 0 where noise colours it
uniform sampler2D detail;        // per block: change of colour or turn, outline, highlight; a: body id; its fraction:
                                 // half the body's share of the block
uniform float block_px;          // side of a block

// The face of a stroke is the part of its body around it that has about the stroke's normal. AROUND_PX: how far from
// the stroke's centre the ends of the face are looked for, to tell how thin the face is. It is in pixels, for pictures
// of half the scene's size or less. In larger pictures it grows in proportion: to 16 pixels at the scene's size.
const float AROUND_PX = 8.0;

// Cosine of the angle between a pixel's normal and the stroke's: below the first the pixel shows another face of the
// body, from the second on the stroke's own.
const vec2 SAME_FACE = vec2(0.8, 0.97);

// How far in front of the stroke's plane its body must be to cover the stroke: from the first depth on in part, from
// the second wholly. Smaller depths are mere errors of coarse meshes. In pictures under half the scene's size both
// shrink with the picture, since grooves have fewer pixels of depth there.
const vec2 COVERS_PX = vec2(2.0, 6.0);

// The least radius of the ring of places that tells whether a stroke is covered, in pictures of half the scene's size
// or more. On a smaller ring, single pixels would decide by chance.
const float LEAST_RING_PX = 1.6;

// The stroke's centre. If the centre lies outside the picture: about where the stroke's middle line enters the picture.
// If such a stroke runs along the border: the point of the picture nearest to the centre, so that the result does not
// leap as the stroke turns.
vec2 center_in_picture() {
    vec2 first = vec2(0.5);
    vec2 last = vec2(textureSize(depth_and_id, 0)) - 0.5;
    vec2 missing_px = clamp(place.xy, first, last) - place.xy;
    if (missing_px == vec2(0.0)) return place.xy;
    vec2 along = vec2(cos(place.w), sin(place.w));
    float along_px = dot(missing_px, along / max(along * along, 0.06));
    return clamp(place.xy + along * clamp(along_px, -0.5 * size.x, 0.5 * size.x), first, last);
}

// Depth and body id of the pixel at a place.
vec2 surface_at(vec2 at_px) {
    ivec2 texel = clamp(ivec2(floor(at_px)), ivec2(0), textureSize(depth_and_id, 0) - 1);
    return texelFetch(depth_and_id, texel, 0).xy;
}

// The depth of the stroke's own plane this far from its centre.
float plane_depth(vec2 offset_px) {
    vec3 n = mat3(view_from_world) * normal_and_bow.xyz;
    float facing = facing_at_px(n, place.xy);
    float slant = max(abs(facing), 0.2);
    return place.z + dot(n.xy, offset_px) * units_per_px(place.z) / (facing < 0.0 ? -slant : slant);
}

// How far the stroke's centre is free of other parts of its own body, 0..1. Where it is free, only pixels of its own
// face count, so that a narrow face takes no colour from the wide one beside it, nor a leaf from the leaf behind it.
// Where it is covered, the stroke has the colour of what covers it.
//
// A leaf that passes in front of a single place would switch the colour. So seven places count: the centre, and six on
// a ring, whose radius is half the stroke's width but at least LEAST_RING_PX. The result is the share of them that is
// not covered. Places that show other bodies tell nothing and are left out; if more than half do, the stroke counts as
// less free.
float freedom(vec2 center_px, float id) {
    ivec2 last = textureSize(depth_and_id, 0) - 1;
    vec2 covers_px = COVERS_PX * min(2.0 * px_scale, 1.0);
#ifdef DRAFT
    const int PLACES = 1;
#else
    const int PLACES = 7;
#endif
    float ring_px = max(0.5 * size.y, LEAST_RING_PX * min(2.0 * px_scale, 1.0));
    float facing = max(abs(facing_at_px(mat3(view_from_world) * normal_and_bow.xyz, place.xy)), 0.05);
    // The flatter the gaze, the less the stroke's normal tells of the depth away from the centre. At the rim of a body,
    // where the near side covers the far one, only the centre counts.
    float doubt = 0.5 / facing;
    float believed = smoothstep(0.1, 0.35, facing);
#ifdef DRAFT
    const int SIDE = 2;
#else
    const int SIDE = 4;
#endif
    // The value of the centre is a mean over pixels up to this far away: in a gap one pixel wide between two leaves, a
    // single pixel would decide by chance.
    float center_wide_px = clamp(4.0 * px_scale, 1.0, 0.5 * float(SIDE));
    float covered = 0.0;
    float found = 0.0;
    for (int index = 0; index < SIDE * SIDE + 4 * (PLACES - 1); index++) {
        int on_ring = index - SIDE * SIDE;
        float angle = 1.0471976 * float(on_ring / 4);
        vec2 away_px = on_ring < 0 ? vec2(0.0) : vec2(cos(angle), sin(angle)) * ring_px;
        vec2 at = center_px + away_px - 0.5;
        ivec2 offset = on_ring < 0 ? ivec2(index % SIDE, index / SIDE) + 1 - SIDE / 2 : ivec2(on_ring & 1, (on_ring >> 1) & 1);
        ivec2 texel = ivec2(floor(at)) + offset;
        if (texel != clamp(texel, ivec2(0), last)) continue;
        vec2 there = texelFetch(depth_and_id, texel, 0).xy;
        if (there.y != id) continue;
        vec2 offset_px = vec2(texel) + 0.5 - place.xy;
        float before_px = (plane_depth(offset_px) - there.x) / units_per_px(place.z);
        before_px -= doubt * (on_ring < 0 ? max(length(vec2(texel) + 0.5 - center_px) - 1.0, 0.0) : ring_px);
        float wide_px = on_ring < 0 ? center_wide_px : 1.0;
        vec2 near = max(1.0 - abs(vec2(texel) - at) / wide_px, 0.0) / wide_px;
        float weight = near.x * near.y * (on_ring < 0 ? 1.0 : believed);
        found += weight;
        covered += weight * smoothstep(covers_px.x, covers_px.y, before_px);
    }
    // Where most places show other bodies, the few that are left must not switch the colour.
    return (found - covered) / max(found, 0.5 * (1.0 + float(PLACES - 1) * believed));
}

// How far a pixel of the stroke's own body shows another face than the stroke's, 0..1. A body that noise colours has no
// normals in the picture: all of it counts as one face.
float other_face(ivec2 texel) {
    vec3 shown = texelFetch(normal, texel, 0).xyz;
    if (dot(shown, shown) < 0.25) return 0.0;
    float cosine = dot(shown, normalize(normal_and_bow.xyz));
    return 1.0 - smoothstep(SAME_FACE.x, SAME_FACE.y, cosine);
}

bool is_in_picture(ivec2 texel) {
    return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, textureSize(reference_color, 0)));
}

vec3 color_of(ivec2 texel) {
    vec3 color = texelFetch(reference_color, texel, 0).rgb;
    return kind == LIGHTS ? color + texelFetch(highlight, texel, 0).rgb : color;
}

// The sum of the colours of the four nearest pixels, by bilinear weights; w is the sum of these weights. Only pixels of
// the body count, and pixels of its other faces count less, the more the stroke is `free`. The plain render has hard
// edges, at which a tap on a single pixel would jump. Pixels outside the picture do not count: if taps were clamped,
// the pixels at the border, taken again and again, would decide alone.
vec4 own_color_at(vec2 at_px, float id, float free) {
#ifdef DRAFT
    ivec2 nearest = ivec2(floor(at_px));
    bool is_own = is_in_picture(nearest) && texelFetch(depth_and_id, nearest, 0).y == id;
    return is_own ? vec4(color_of(nearest), 1.0) : vec4(0.0);
#endif
    vec2 at = at_px - 0.5;
    ivec2 corner = ivec2(floor(at));
    vec2 part = at - vec2(corner);
    vec4 sum = vec4(0.0);
    for (int index = 0; index < 4; index++) {
        ivec2 offset = ivec2(index & 1, index >> 1);
        ivec2 texel = corner + offset;
        if (!is_in_picture(texel) || texelFetch(depth_and_id, texel, 0).y != id) continue;
        vec2 near = mix(1.0 - part, part, vec2(offset));
        float weight = near.x * near.y * (1.0 - free * other_face(texel));
        sum += vec4(color_of(texel), 1.0) * weight;
    }
    return sum;
}

// Directions all around, relative to the stroke's own, so that a turned picture gives the same result.
vec2 direction(int index, int count) {
    float angle = place.w + 6.2831853 * (float(index) + 0.5) / float(count);
    return vec2(cos(angle), sin(angle));
}

// How far the stroke's own face has ended at a place, 0..1: wholly where its body has ended, or turns away as at an
// edge; not where something in front hides it.
float is_past(vec2 at_px, vec2 own, float free) {
    vec2 there = surface_at(at_px);
    if (there.y == own.y) return free * other_face(clamp(ivec2(at_px), ivec2(0), textureSize(normal, 0) - 1));
    return there.y == 0.0 || there.x > own.x ? 1.0 : 0.0;
}

// How far the stroke's own face has ended both at `offset_px` from the centre and on the opposite side.
float is_past_both(vec2 center_px, vec2 offset_px, vec2 own, float free) {
    float past = is_past(center_px + offset_px, own, free);
    return past == 0.0 ? 0.0 : past * is_past(center_px - offset_px, own, free);
}

// The largest distance at which `thinness` looks whether the face has ended, as a multiple of the distance it tries
// first.
const float FURTHER = 1.2;

// How thin the stroke's own face is, 0..1: the share of directions in which the face ends nearby on both sides. Another
// face one pixel wide, such as the side of a shutter, is no end. So a direction counts only if the face has also ended
// at a second distance, nearer or further than the first. If it has not at the nearer one, the direction counts half.
float thinness(vec2 center_px, vec2 own, float free) {
    float around_px = AROUND_PX * max(2.0 * px_scale, 1.0);
    // Nothing is known beyond the picture. Near its border, taps go less far, and what they find counts less.
    vec2 room_px = max(min(center_px, vec2(textureSize(depth_and_id, 0)) - center_px), 0.0) / FURTHER;
#ifdef DRAFT
    const int DIRECTIONS = 6;
#else
    const int DIRECTIONS = 12;
#endif
    float sum = 0.0;
    for (int index = 0; index < DIRECTIONS; index++) {
        float angle = 3.14159265 / float(DIRECTIONS) * float(index);
        vec2 offset_px = vec2(cos(angle), sin(angle)) * around_px;
        vec2 shares = room_px / max(abs(offset_px), 1e-3);
        float fits = min(min(shares.x, shares.y), 1.0);
        offset_px *= fits;
        float past = is_past_both(center_px, offset_px, own, free);
        if (past == 0.0) continue;
        float nearer = is_past_both(center_px, 0.55 * offset_px, own, free);
#ifdef DRAFT
        float further = 0.0;
#else
        float further = nearer < past ? is_past_both(center_px, FURTHER * offset_px, own, free) : 0.0;
#endif
        sum += fits * (min(past, nearer) + min(past, max(nearer, further)));
    }
    return sum / float(2 * DIRECTIONS);
}

// The sum of the colours on a ring round the stroke's centre, of `count` taps. `first` is the angle of the first tap in
// the stroke's frame.
vec4 own_colors_on_ring(vec2 center_px, float id, mat2 ring_px, float free, int count, float first) {
    vec4 sum = vec4(0.0);
    for (int index = 0; index < count; index++) {
        float angle = first + 6.2831853 * float(index) / float(count);
        sum += own_color_at(center_px + ring_px * vec2(cos(angle), sin(angle)), id, free);
    }
    return sum;
}

// Mean colour on the stroke's own body: a Gaussian with this standard deviation, on rings and the centre. It is longer
// along the stroke, so that a shadow that sweeps over it takes several frames. The less of the body is found there, the
// more a wider surrounding counts. Two further rings count for broad strokes, since something narrow, such as a leg,
// could pass unseen between the other taps. They also count where only scraps of the body are seen, because it covers
// itself (the stroke is less `free`) or others hide it: no single tap may decide there. w is how much of the colour is
// known, 0..1.
vec4 own_color(vec2 center_px, float id, mat2 sigma_px, float free) {
    const float CENTER = 0.7;
    const vec2 RINGS = vec2(0.60, 0.17);
    const vec2 FURTHER_RINGS = vec2(0.43, 0.17);
    vec4 sum = vec4(0.0);
    float need = 1.0;
    float enough = 1.0;
    for (int widening = 0; widening < 3 && need > 0.0; widening++) {
        vec4 found = CENTER * own_color_at(center_px, id, free);
        found += RINGS.x * own_colors_on_ring(center_px, id, sigma_px, free, 6, 0.0);
        // The weight if all taps find the body; a quarter of it is enough.
        float full = CENTER + 6.0 * RINGS.x;
#ifndef DRAFT
        found += RINGS.y * own_colors_on_ring(center_px, id, 1.9 * sigma_px, free, 6, 0.52359878);
        full += 6.0 * RINGS.y;
        float further = max(max(1.0 - free, 2.0 - 2.0 * found.a / full), smoothstep(1.5, 4.0, length(sigma_px[1])));
        if (further > 0.0) {
            further = min(further, 1.0);
            found += further * FURTHER_RINGS.x * own_colors_on_ring(center_px, id, 0.55 * sigma_px, free, 12, 0.26179939);
            found += further * FURTHER_RINGS.y * own_colors_on_ring(center_px, id, 1.45 * sigma_px, free, 12, 0.0);
            full += further * 12.0 * (FURTHER_RINGS.x + FURTHER_RINGS.y);
        }
#endif
        if (widening == 0) enough = 0.25 * full;
        sum += found * need;
        need = clamp(1.0 - sum.a / enough, 0.0, 1.0);
        sigma_px = sigma_px * 2.2;
    }
    return vec4(sum.rgb / max(sum.a, 1e-4), clamp(sum.a / (0.2 * enough), 0.0, 1.0));
}

// The mean colour of the wider surroundings on the stroke's own body, Oklab.
vec3 wide_mean(vec2 center_px, float id, vec3 lab, float free) {
    const float REACH_PX = 10.0;
    vec3 sum = vec3(0.0);
    for (int index = 0; index < 8; index++) {
        vec2 tap_px = center_px + direction(index, 8) * (REACH_PX * px_scale);
        vec4 found = own_color_at(tap_px, id, free);
        sum += found.a > 1e-3 ? mix(lab, oklab_from_linear(found.rgb / found.a), found.a) : lab;
    }
    return sum / 8.0;
}

// How much detail the stroke's own body has around it: change of colour or turn 0..1.6, outline 0..1, highlight 0..1. A
// smooth mean of the body's blocks, so that the blocks of a thin body, which come and go, hardly show.
vec3 detail_at(vec2 center_px, float id) {
    vec2 at = center_px / block_px - 0.5;
    ivec2 last = textureSize(detail, 0) - 1;
    ivec2 corner = ivec2(floor(at)) - 1;
    vec3 sum = vec3(0.0);
    float weight = 0.0;
    for (int index = 0; index < 16; index++) {
        ivec2 texel_at = corner + ivec2(index & 3, index >> 2);
        vec4 texel = texelFetch(detail, clamp(texel_at, ivec2(0), last), 0);
        vec2 near = max(1.0 - 0.5 * abs(at - vec2(texel_at)), 0.0);
        float share = floor(texel.a) == id ? 2.0 * fract(texel.a) * near.x * near.x * near.y * near.y : 0.0;
        sum += texel.rgb * share;
        weight += share;
    }
    return sum / max(weight, 0.7);
}

// From a place to the middle of what is seen of the stroke's own body around it. Without this, a stroke beside a part
// that is two or three pixels wide would lie on the part in one frame and miss it in the next. Each tap lies between
// four pixels, so that the middle does not leap either.
vec2 to_spine_px(vec2 center_px, vec2 own) {
    float step_px = 2.0 * px_scale;
    vec3 sum = vec3(0.0);
    for (int index = 0; index < 4 * 49; index++) {
        int tap = index >> 2;
        vec2 offset = vec2(tap % 7, tap / 7) - 3.0;
        float near_center = max(1.0 - 0.0625 * dot(offset, offset), 0.0);
        vec2 at = center_px + offset * step_px - 0.5;
        vec2 corner = vec2(index & 1, (index >> 1) & 1);
        if (surface_at(floor(at) + corner + 0.5).y != own.y) continue;
        vec2 near = mix(1.0 - fract(at), fract(at), corner);
        sum += vec3(offset * step_px, 1.0) * (near_center * near_center * near.x * near.y);
    }
    return sum.xy / max(sum.z, 1e-3);
}

// How much of the way from the stroke's centre to one of its ends lies on its body, 0..1: taps on two lines, so that
// it changes slowly even where the stroke runs along the body's border. The body does not end where something stands in
// front.
float share_on_body(vec2 center_px, vec2 to_end_px, vec2 across_px, vec2 own) {
    float bias = 0.02 * own.x;
    float beyond = 0.0;
#ifdef DRAFT
    for (int index = 1; index < 24; index += 3) {
        float along = (float(index / 3) + 0.5) / 8.0;
        vec2 there = surface_at(center_px + to_end_px * along);
        if (there.y == own.y) continue;
        beyond += there.y == 0.0 ? 3.0 : 3.0 * smoothstep(-bias, bias, there.x - own.x);
    }
    return 1.0 - beyond / 24.0;
#endif
    // Each tap lies between four pixels, or the stroke would leap along a body that is two or three pixels wide.
    for (int index = 0; index < 48; index++) {
        int tap = index >> 2;
        float along = (float(tap >> 1) + 0.25 + 0.5 * float(tap & 1)) / 6.0;
        vec2 at = center_px + to_end_px * along + across_px * (float(tap & 1) - 0.5) * 1.5 - 0.5;
        ivec2 offset = ivec2(index & 1, (index >> 1) & 1);
        vec2 there = surface_at(floor(at) + vec2(offset) + 0.5);
        if (there.y == own.y) continue;
        vec2 near = mix(1.0 - fract(at), fract(at), vec2(offset));
        beyond += near.x * near.y * (there.y == 0.0 ? 1.0 : smoothstep(-bias, bias, there.x - own.x));
    }
    return 1.0 - beyond / 12.0;
}
