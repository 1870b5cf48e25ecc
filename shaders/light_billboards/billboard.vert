// A quad that faces the camera: four corners from uniforms, told apart by their number. No vertex is read from a buffer.
uniform vec3 corner_00;          // world space, at u = 0, v = 0
uniform vec3 corner_01;          // at u = 0, v = 1
uniform vec3 corner_10;
uniform vec3 corner_11;
uniform vec3 camera_right;       // unit, world space
uniform vec3 camera_up;
uniform mat4 clip_from_world;

out vec2 on_plane;               // place on the picture's plane
flat out vec4 first_two;         // the corners there
flat out vec4 last_two;

vec2 plane(vec3 position_in_world) {
    // From a corner, so that icons far from the world's middle lose no digits.
    vec3 off = position_in_world - corner_00;
    return vec2(dot(off, camera_right), dot(off, camera_up));
}

void main() {
    vec3 corner = gl_VertexID == 0 ? corner_00 : gl_VertexID == 1 ? corner_01 : gl_VertexID == 2 ? corner_10 : corner_11;
    on_plane = plane(corner);
    first_two = vec4(plane(corner_00), plane(corner_10));
    last_two = vec4(plane(corner_01), plane(corner_11));
    gl_Position = clip_from_world * vec4(corner, 1.0);
    // What stands far out is drawn too: depth is asked of the picture.
    gl_Position.z = 0.0;
}
