#version 450
layout(local_size_x = 1) in;

// Does nothing: what no longer is bound is let go of by drivers that look at bindings only when something runs.
void main() {}
