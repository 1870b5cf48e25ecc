// Writes depth only.
#include "shared/cutout.glsl"

void main() {
    cut_out();
}
