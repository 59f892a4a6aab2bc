#version 450
// Does nothing: see idle.comp.
layout(location = 0) out float nothing;

void main() { nothing = 0.0; }
