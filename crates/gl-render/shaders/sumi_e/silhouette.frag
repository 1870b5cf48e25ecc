// Pass 0 of the source (the effect that `styles/sumi_e.rs` names): light from the eye, with its range between the two
// cosines of `silhouette` stretched from black to white.
#include "shared/cutout.glsl"
in vec3 normal_in_view;

uniform vec2 silhouette;         // black at the first cosine, white at the second

out vec4 lit;

void main() {
    cut_out();
    // The source is left-handed: its eye lies along −Z, ours along +Z.
    float diffuse = clamp(dot(normal_in_view, vec3(0.0, 0.0, 1.0)), 0.0, 1.0);
    float t = clamp((diffuse - silhouette.x) / (silhouette.y - silhouette.x), 0.0, 1.0);
    lit = vec4(vec3(t * t * (3.0 - 2.0 * t)), 1.0);
}
