// Fetches triangles by number. GLSL only: it declares the buffers that frame/scene_buffers.h binds.
layout(binding = 8) uniform samplerBuffer positions;   // vec3, world space
layout(binding = 9) uniform usamplerBuffer triangles;  // uvec3, indices of positions

// Corners of a triangle, relative to the eye.
void triangle_corners(ViewBlock view, uint triangle, out vec3 a, out vec3 b, out vec3 c) {
  uvec3 corners = texelFetch(triangles, int(triangle)).xyz;
  a = eye_relative(view, texelFetch(positions, int(corners.x)).xyz);
  b = eye_relative(view, texelFetch(positions, int(corners.y)).xyz);
  c = eye_relative(view, texelFetch(positions, int(corners.z)).xyz);
}
