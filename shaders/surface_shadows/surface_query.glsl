// What of the light arrives at the point that a pixel shades. GLSL only; after a walk through a tree.
layout(binding = k_triangle_unit) uniform usampler2D triangle_plus_one;
layout(binding = k_surface_unit) uniform sampler2D surface_points;

vec3 light_at_surface(ivec2 pixel) {
  vec4 point_and_facing = texelFetch(surface_points, pixel, 0);
  vec3 arriving = vec3(0.0);
  bool is_seen = point_and_facing.w >= 0.0;
  if (is_seen) {
    uint seen = texelFetch(triangle_plus_one, pixel, 0).r - 1u;
    vec3 point = scale * point_and_facing.xyz;
    bool parts_eye_from_light = point_and_facing.w == 0.0;
    bool is_lit = !parts_eye_from_light;
    if (parts_eye_from_light) is_lit = glows(seen);
    if (is_lit) {
      arriving = light_at(point, plane_of(seen));
      if (parts_eye_from_light && !is_hidden) {
        pass_through(light_rays(), occluder(seen), texelFetch(attenuations, int(seen)), point);
        arriving = light_left();
      }
    }
  }
  return arriving;
}
