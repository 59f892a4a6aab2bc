// What materials cut out of their triangles (scene::CutOut), as level 0 of a texture has it: GLSL only.
#include "frame/textures.glsl"

layout(binding = k_materials_unit) uniform usamplerBuffer material_of_triangle;

// Whether there is no surface at a place of a triangle's texture. The triangle is one of those that are cut out.
bool is_cut_away(uint triangle, vec2 place) {
  uvec4 info = texelFetch(material_textures, 2 * int(texelFetch(material_of_triangle, int(triangle)).r) + 1);
  return texture_at(level_of(info), wrap_of(info), place).a < uintBitsToFloat(info.w);
}
