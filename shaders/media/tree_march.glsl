// By asking the tree of a method of surface shadow, which knows triangles, not texels. GLSL only; after the walk through a tree.
#include "frame/ray_place.glsl"
#include "media/march.glsl"

layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(location = 0) out vec4 airlight;

vec3 light_along(MediumRay ray, float t, float phi) {
  return light_at(scale * (t * ray.direction - light.is_near * light.from_eye), k_in_air);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec2 place = ray_place(texel);
  airlight = march_airlight(medium_ray(place, texelFetch(surface_image, texel, 0).w), ivec2(place));
}
