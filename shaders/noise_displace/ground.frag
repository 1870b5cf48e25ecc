// What is seen through a body where nothing is behind it.
uniform vec4 ground;
uniform sampler2D depth_and_id;

out vec4 color;

void main() {
    if (texelFetch(depth_and_id, ivec2(gl_FragCoord.xy), 0).y == 0.0) discard;
    color = ground;
}
