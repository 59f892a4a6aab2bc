// Reads the textures of materials. GLSL only.
#ifndef AIRLIGHT_TEXTURES_GLSL
#define AIRLIGHT_TEXTURES_GLSL
#include "bindings.glsl"
#include "frame/texture_filter.glsl"

// Two texels a material, of its colours and of its mask: the first texel of its finest level; width and height, 16 bits each, 0 without
// one; wraps, 4 bits each; of the mask the least alpha, a float's bits.
layout(binding = k_material_textures_unit) uniform usamplerBuffer material_textures;
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

// The finest level.
TextureLevel level_of(uvec4 info) {
  return TextureLevel(info.x, ivec2(int(info.y & 0xffffu), int(info.y >> 16u)));
}

uvec2 wrap_of(uvec4 info) { return uvec2(info.z & 15u, info.z >> 4u); }

#endif
