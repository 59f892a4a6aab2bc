// What a light textured by direction radiates. GLSL only.
#include "frame/light_texture.glsl"

// In the direction `d` from the light, relative to its intensity. Blended here: filtering by the GPU may round the weights to
// 1/256.
vec3 light_colour(sampler2D light_texture, vec3 d) {
  vec2 place = light_texture_place(angle_of(d.x, d.z), angle_of(d.y, length(d.xz)));
  TexelBlend blend = light_texture_blend(place, textureSize(light_texture, 0));
  vec3 upper = mix(texelFetch(light_texture, ivec2(blend.from.x, blend.from.y), 0).rgb,
                   texelFetch(light_texture, ivec2(blend.to.x, blend.from.y), 0).rgb, blend.weight.x);
  vec3 lower = mix(texelFetch(light_texture, ivec2(blend.from.x, blend.to.y), 0).rgb,
                   texelFetch(light_texture, ivec2(blend.to.x, blend.to.y), 0).rgb, blend.weight.x);
  return mix(upper, lower, blend.weight.y);
}
