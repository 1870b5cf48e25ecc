// From a pixel and a depth to a position, for perspective and orthographic lenses.
uniform mat4 world_from_view;
uniform vec2 size_px;
uniform vec2 gaze_px;            // where the gaze meets the picture: its middle, unless the lens is shifted
uniform float px_per_unit_at_1;  // focal length in pixels; pixels per world unit if rays are parallel
uniform float orthographic;      // 1 where rays are parallel

// World units per pixel at a depth.
float units_per_px(float depth) {
    return mix(depth, 1.0, orthographic) / px_per_unit_at_1;
}

vec3 view_from_px(vec2 at_px, float depth) {
    return vec3((at_px - gaze_px) * units_per_px(depth), -depth);
}

// How far a surface with this normal in view space faces the eye through a pixel; below 0 the surface shows its back.
// At another pixel, `offset_px` away, the surface's plane is deeper by dot(normal.xy, offset_px) * units_per_px(depth)
// divided by the result: in perspective only to first order.
float facing_at_px(vec3 normal_in_view, vec2 at_px) {
    vec2 gaze = (1.0 - orthographic) * (at_px - gaze_px) / px_per_unit_at_1;
    return normal_in_view.z - dot(normal_in_view.xy, gaze);
}

vec3 world_from_px(vec2 at_px, float depth) {
    return (world_from_view * vec4(view_from_px(at_px, depth), 1.0)).xyz;
}

// Unit vector in world space from what a pixel shows to the eye.
vec3 towards_eye_from_px(vec2 at_px) {
    vec3 gaze = mix(view_from_px(at_px, 1.0), vec3(0.0, 0.0, -1.0), orthographic);
    return -normalize(mat3(world_from_view) * gaze);
}
