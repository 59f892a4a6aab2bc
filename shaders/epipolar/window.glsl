// What one dispatch over the grid works on: a run of half-planes, whose bits are bound for writing, because storage buffers
// may be smaller than the grid. One uniform, so that it is in use where half of it is. GLSL only.
layout(location = 0) uniform uvec2 window;
#define window_first_plane window.x
#define window_planes window.y
