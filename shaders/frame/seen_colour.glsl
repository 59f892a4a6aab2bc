// The base colour of what a pixel shows: its material's, or with its texture (frame/looks.frag). GLSL only.
#include "bindings.glsl"

layout(binding = k_albedos_unit) uniform samplerBuffer albedos;
layout(binding = k_materials_unit) uniform usamplerBuffer material_of_triangle;
layout(binding = k_base_colour_unit) uniform sampler2D base_colour_image;
layout(constant_id = 1) const uint k_has_textures = 0;

// `seen`: the number of its triangle + 1.
vec3 seen_colour(ivec2 pixel, uint seen) {
  return k_has_textures != 0u ? texelFetch(base_colour_image, pixel, 0).rgb
                              : texelFetch(albedos, int(texelFetch(material_of_triangle, int(seen) - 1).r)).rgb;
}
