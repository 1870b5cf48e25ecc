// The layers of paint, numbered as in `LayerKind`: in the order in which they are laid on, unless a scene states
// another order.
const int UNDERPAINTING = 0;
const int BODY = 1;
const int FORM = 2;
const int SCUMBLE = 3;
const int ACCENTS = 4;
const int CONTOUR = 5;
const int LIGHTS = 6;
const int TOUCHES = 7;
