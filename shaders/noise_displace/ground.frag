// What is seen through a body where nothing is behind it.
uniform vec4 ground;

out vec4 color;

void main() {
    color = ground;
}
