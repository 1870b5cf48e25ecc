// A Gaussian blur along one axis, clamped at the picture's edges.
uniform sampler2D picture;
uniform vec2 axis;               // from one tap to the next, as a share of the picture
uniform float deviation;         // in taps, > 0
uniform vec2 target_px;          // size of the target

out vec4 softened;

const int MOST = 24;

void main() {
    vec2 at = gl_FragCoord.xy / target_px;
    vec4 sum = textureLod(picture, at, 0.0);
    float weight = 1.0;
    int reach = min(int(ceil(2.6 * deviation)), MOST);
    for (int index = 1; index <= reach; index++) {
        float share = exp(-0.5 * float(index * index) / (deviation * deviation));
        sum += share * (textureLod(picture, at + axis * float(index), 0.0) + textureLod(picture, at - axis * float(index), 0.0));
        weight += 2.0 * share;
    }
    softened = sum / weight;
}
