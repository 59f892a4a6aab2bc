// The base colour of a material's texture. GLSL only.
#include "frame/textures.glsl"

// 1 of a material without a texture. `along_row` and `along_column`: see texture_probes.
vec4 base_texture(int material, vec2 place, vec2 along_row, vec2 along_column) {
  uvec4 info = texelFetch(material_textures, 2 * material);
  vec4 sum = vec4(1.0);
  if (info.y != 0u) {
    ivec2 size = level_of(info).size;
    uvec2 wrap = wrap_of(info);
    TextureProbes probes = texture_probes(along_row, along_column, size);
    int finer = int(probes.level);
    float coarser_part = probes.level - float(finer);
    TextureLevel level = texture_level(info.x, size, finer);
    TextureLevel coarser = texture_level(info.x, size, min(finer + 1, last_level(size)));
    sum = vec4(0.0);
    for (int i = 0; i < probes.count; ++i) {
      vec2 probe = place + (float(i) - 0.5 * float(probes.count - 1)) * probes.apart;
      vec4 colour = texture_at(level, wrap, probe);
      if (coarser_part > 0.0) colour = mix(colour, texture_at(coarser, wrap, probe), coarser_part);
      sum += colour;
    }
    sum /= float(probes.count);
  }
  return sum;
}
