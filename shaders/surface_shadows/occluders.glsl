// The triangles of a scene as the predicate wants them (frame/occlusion.glsl): relative to the light, scaled, corners turned. GLSL
// only; needs frame/uniforms.glsl.
#include "frame/occlusion.glsl"

// Three texels a triangle, a, b and c. In w of a: a length that the light is at least from it, −1 where it hides nothing.
layout(binding = k_occluders_unit) uniform samplerBuffer occluders;
layout(binding = k_triangle_planes_unit) uniform usamplerBuffer triangle_planes;  // in which plane of the scene each lies

LightRays light_rays() { return LightRays(-light.from_eye, light.is_near == 0.0); }

Occluder occluder(uint triangle) {
  int at = 3 * int(triangle);
  return Occluder(texelFetch(occluders, at).xyz, texelFetch(occluders, at + 1).xyz, texelFetch(occluders, at + 2).xyz);
}

// −1 where the triangle hides nothing.
float least_distance_of(uint triangle) { return texelFetch(occluders, 3 * int(triangle)).w; }

uint plane_of(uint triangle) { return texelFetch(triangle_planes, int(triangle)).r; }

// Whether a triangle hides a point of a surface from the light. What lies in the surface's own plane does not.
bool hides_surface(LightRays rays, uint triangle, vec3 point, uint own_plane) {
  return hides(rays, occluder(triangle), point) && plane_of(triangle) != own_plane;
}

// Whether any triangle does: each is asked, until one does.
bool any_hides_surface(LightRays rays, uint triangle_count, vec3 point, uint own_plane) {
  bool is_hidden = false;
  for (uint triangle = 0u; triangle < triangle_count && !is_hidden; ++triangle)
    if (least_distance_of(triangle) >= 0.0) is_hidden = hides_surface(rays, triangle, point, own_plane);
  return is_hidden;
}
