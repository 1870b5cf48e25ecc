// Which body is here, and how far: what shows of it is all in front, so that it is seen through once.
in float depth_along_gaze;

uniform float body_id;

out vec2 depth_and_id;

void main() {
    depth_and_id = vec2(depth_along_gaze, body_id);
}
