// Cuts holes into a body by the alpha of a texture, in fragment shaders of programs with shared/body.glsl. Without
// CUTOUT it does nothing.
#ifdef CUTOUT
in vec2 cut_at;
uniform sampler2D cut_texture;
uniform float cutoff;

void cut_out() {
    if (texture(cut_texture, cut_at).a < cutoff) {
        discard;
    }
}
#else
void cut_out() {}
#endif
