// Fetches triangles by number. GLSL only: it declares the buffers of frame/scene_buffers.h.
layout(std430, binding = 0) readonly buffer Positions { float positions[]; };
layout(std430, binding = 1) readonly buffer Indices { uint indices[]; };

vec3 world_position(uint vertex) {
  return vec3(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

// Corners of a triangle, relative to the eye.
void triangle_corners(ViewBlock view, uint triangle, out vec3 a, out vec3 b, out vec3 c) {
  a = eye_relative(view, world_position(indices[3u * triangle]));
  b = eye_relative(view, world_position(indices[3u * triangle + 1u]));
  c = eye_relative(view, world_position(indices[3u * triangle + 2u]));
}
