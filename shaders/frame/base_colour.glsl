// The base colour of a material's texture. GLSL only.
#include "bindings.glsl"
#include "frame/texture_filter.glsl"

layout(binding = k_material_textures_unit) uniform usamplerBuffer material_textures;  // first texel, width, height, wraps
layout(binding = k_texels_unit) uniform sampler2DArray texels;                        // frame/looks.h; decoded to linear

// A level at a place, blended here: filtering by the GPU may round the weights to 1/256.
vec4 texture_at(TextureLevel level, uvec2 wrap, vec2 place) {
  TexelBlend blend = texture_blend(place, level.size, wrap);
  vec4 upper = mix(texelFetch(texels, store_place(level.first, level.size.x, ivec2(blend.from.x, blend.from.y)), 0),
                   texelFetch(texels, store_place(level.first, level.size.x, ivec2(blend.to.x, blend.from.y)), 0), blend.weight.x);
  vec4 lower = mix(texelFetch(texels, store_place(level.first, level.size.x, ivec2(blend.from.x, blend.to.y)), 0),
                   texelFetch(texels, store_place(level.first, level.size.x, ivec2(blend.to.x, blend.to.y)), 0), blend.weight.x);
  return mix(upper, lower, blend.weight.y);
}

// 1 of a material without a texture. `along_row` and `along_column`: see texture_probes.
vec4 base_texture(int material, vec2 place, vec2 along_row, vec2 along_column) {
  uvec4 info = texelFetch(material_textures, material);
  vec4 sum = vec4(1.0);
  if (info.y != 0u) {
    ivec2 size = ivec2(info.yz);
    uvec2 wrap = uvec2(info.w & 15u, info.w >> 4u);
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
