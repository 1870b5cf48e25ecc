// The paper: a tile that repeats, which slides and turns with the picture or with what the camera looks at.
uniform sampler2D fibres;        // clouds of pulp, fibres, tooth; each around its middle value
uniform vec3 paper;              // display values
uniform float fibre_strength;    // 0 none, 1 as made
uniform vec4 paper_axes;         // tiles per pixel: along x, along y
uniform vec2 paper_origin;       // tiles at the picture's lower left corner

vec2 paper_at(vec2 px) {
    return paper_origin + paper_axes.xy * px.x + paper_axes.zw * px.y;
}

vec3 felt(vec2 at) {
    return texture(fibres, at).rgb - 128.0 / 255.0;
}

vec3 bare_paper(vec3 felt) {
    float tone = 0.045 * felt.x + 0.15 * felt.y + 0.06 * felt.z;
    // Where pulp lies thick the paper is a little warmer.
    vec3 warmth = vec3(0.0, -0.004, -0.018) * felt.x;
    return clamp(paper * (1.0 + fibre_strength * (tone + warmth)), 0.0, 1.0);
}
