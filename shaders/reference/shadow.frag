// Depth is all that is kept.
void main() {}
