// Lays the background under bodies that noise colours. It shows through them where no other body is behind.
uniform vec4 background;
uniform sampler2D depth_and_id;

out vec4 color;

void main() {
    if (texelFetch(depth_and_id, ivec2(gl_FragCoord.xy), 0).y == 0.0) discard;
    color = background;
}
