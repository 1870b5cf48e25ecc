// Pass 2 of the source (the effect that `styles/sumi_e.rs` names): light from the direction `to_light`, put through the
// ramp of four tones.
#include "sumi_e/ramp.glsl"
#include "shared/cutout.glsl"
in vec3 normal_in_view;

uniform vec3 to_light;           // unit, in the eye's space

out vec4 tone;

void main() {
    cut_out();
    float diffuse = clamp(dot(normal_in_view, to_light), 0.0, 1.0);
    tone = vec4(vec3(tone_at(diffuse)), 1.0);
}
