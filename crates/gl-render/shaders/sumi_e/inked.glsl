// Which bodies get ink.
uniform sampler2D inked;  // a texel for each body, row by row: 0 for a backdrop, which gets no ink, else 1

bool gets_ink(int body_id) {
    int row = textureSize(inked, 0).x;
    return texelFetch(inked, ivec2((body_id - 1) % row, (body_id - 1) / row), 0).r != 0.0;
}
