// A quad that faces the camera. The number of the vertex picks one of four corners in uniforms; there is no vertex
// buffer.
uniform vec3 corner_00;          // world space, at u = 0, v = 0
uniform vec3 corner_01;          // at u = 0, v = 1
uniform vec3 corner_10;
uniform vec3 corner_11;
uniform vec3 camera_right;       // unit, world space
uniform vec3 camera_up;
uniform mat4 clip_from_world;
uniform float icon;              // layer of the icon texture; below 0: a ring
uniform float px;                // a pixel as a share of half the quad's side
uniform float pieces;            // how many straight pieces make the ring

out vec2 on_plane;               // place on the quad's plane, world units right and up from corner_00
flat out vec4 first_two;         // the corners on that plane
flat out vec4 last_two;

vec2 plane(vec3 position_in_world) {
    // Relative to a corner, so that icons far from the world's origin lose no precision.
    vec3 off = position_in_world - corner_00;
    return vec2(dot(off, camera_right), dot(off, camera_up));
}

// A corner of one piece of a ring. A ring is mostly empty, so only its line is drawn.
vec3 corner_of_ring() {
    float angle = 6.2831853 * (float(gl_InstanceID) + float(gl_VertexID & 1)) / pieces;
    // A piece is straight, so its outer side has to enclose the arc.
    float radius = gl_VertexID < 2 ? 1.0 - 6.0 * px : (1.0 + 2.0 * px) / cos(3.14159265 / pieces);
    vec3 right = 0.5 * (corner_10 - corner_00) * cos(angle);
    vec3 up = 0.5 * (corner_01 - corner_00) * sin(angle);
    return 0.5 * (corner_00 + corner_11) + (right + up) * max(radius, 0.0);
}

void main() {
    vec3 corner = icon < 0.0 ? corner_of_ring() : gl_VertexID == 0 ? corner_00 : gl_VertexID == 1 ? corner_01 : gl_VertexID == 2 ? corner_10 : corner_11;
    on_plane = plane(corner);
    first_two = vec4(plane(corner_00), plane(corner_10));
    last_two = vec4(plane(corner_01), plane(corner_11));
    gl_Position = clip_from_world * vec4(corner, 1.0);
    // Icons beyond the far plane are drawn too: the fragment shader compares depth itself.
    gl_Position.z = 0.0;
}
