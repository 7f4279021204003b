// Fragment shader of surfaces and ribbons.
void main() { colour_ground(); }
