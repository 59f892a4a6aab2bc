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
