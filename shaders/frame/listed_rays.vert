#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/ray_list.glsl"
// The texels of listed rays, four vertices without attributes an instance: first the rows of squares that are full, then what is left.
void main() {
  uint squares = (rays.count + 15u) >> 4;
  uint in_row = rays.width >> 2;
  uint rows = squares / in_row;
  vec2 from = vec2(0.0, 0.0);
  vec2 to = vec2(rays.width, 4u * rows);
  if (gl_InstanceID == 1) {
    from = vec2(0.0, 4u * rows);
    to = vec2(4u * (squares - rows * in_row), 4u * rows + 4u);
  }
  vec2 corner = mix(from, to, vec2(gl_VertexID & 1, gl_VertexID >> 1));
  gl_Position = vec4(2.0 * corner / vec2(rays.width, rays.height) - 1.0, 0.0, 1.0);
}
