// Depth and body at several samples in each pixel, so that borders of bodies are found within pixels.
uniform sampler2D fine;          // depth and body id of every sample
uniform int samples;             // per pixel along each axis

// Depth and body id of the sample at a place.
vec2 surface_at(vec2 at_px) {
    ivec2 texel = clamp(ivec2(floor(at_px * float(samples))), ivec2(0), textureSize(fine, 0) - 1);
    return texelFetch(fine, texel, 0).xy;
}
