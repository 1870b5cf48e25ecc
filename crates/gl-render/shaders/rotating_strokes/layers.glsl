// The layers of paint, numbered as in `LayerKind`. They are laid in this order, unless a scene states another.
const int UNDERPAINTING = 0;
const int BODY = 1;
const int FORM = 2;
const int SCUMBLE = 3;
const int ACCENTS = 4;
const int CONTOUR = 5;
const int LIGHTS = 6;
const int TOUCHES = 7;
