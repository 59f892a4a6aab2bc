// The surface that a view ray hits, from the image of the triangles seen. GLSL only.
#include "frame/uniforms.glsl"

layout(binding = k_triangle_unit) uniform usampler2D triangle_plus_one;
layout(binding = k_positions_unit) uniform samplerBuffer positions;   // vec3, world space
layout(binding = k_triangles_unit) uniform usamplerBuffer triangles;  // uvec3, indices of positions

// Its normal, turned towards the eye, and the distance to its plane; 0 where none is. Interpolated depth would lose digits on large
// triangles that reach behind the eye. `pixel`: the one that sees the triangle, within the image.
vec4 seen_surface(ivec2 pixel, vec3 ray) {
  uint seen = texelFetch(triangle_plus_one, pixel, 0).r;
  vec4 surface = vec4(0.0);
  if (seen != 0u) {
    uvec3 corners = texelFetch(triangles, int(seen) - 1).xyz;
    vec3 a = eye_relative(camera, texelFetch(positions, int(corners.x)).xyz);
    vec3 b = eye_relative(camera, texelFetch(positions, int(corners.y)).xyz);
    vec3 c = eye_relative(camera, texelFetch(positions, int(corners.z)).xyz);
    // Three corners in line may be seen once they are rasterised.
    vec3 normal = unit_or(cross(b - a, c - a), -ray);
    surface.xyz = dot(normal, ray) > 0.0 ? -normal : normal;
    surface.w = max(ray_triangle_distance(ray, a, b, c), 1e-30);
  }
  return surface;
}
