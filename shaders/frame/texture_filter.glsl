// How a texture of base colours is filtered: trilinear, with up to eight places along the longer axis of a pixel's footprint (after
// OpenGL's EXT_texture_filter_anisotropic, "Sample Anisotropic Texture Filtering"). All textures of a scene, with all of their levels,
// lie one after the other in one array of images, so that a pass reads any of them; the GPU's own filters know nothing of that.
#ifndef AIRLIGHT_TEXTURE_FILTER_GLSL
#define AIRLIGHT_TEXTURE_FILTER_GLSL
#include "frame/light_texture.glsl"

// Of an image of the array [texels]. Rows of the images follow one another, as do the images.
CONST uint k_store_side_bits = 12u;
CONST uint k_store_side = 4096u;

// scene::TextureWrap
CONST uint k_wrap_repeat = 0u;
CONST uint k_wrap_clamp = 1u;
CONST uint k_wrap_mirror = 2u;

CONST int k_most_probes = 8;

// A level of a texture.
struct TextureLevel {
  uint first;  // texel of the store
  ivec2 size;
};

// Each level has half the size of the one before it, rounded down, at least 1.
FUNCTION TextureLevel texture_level(uint first, IN(ivec2) size, int level) {
  TextureLevel result = TextureLevel(first, size);
  for (int i = 0; i < level; ++i) {
    result.first += uint(result.size.x) * uint(result.size.y);
    result.size = max(result.size / 2, ivec2(1));
  }
  return result;
}

// The last level, of one texel.
FUNCTION int last_level(IN(ivec2) size) {
  int level = 0;
  for (int side = max(size.x, size.y); side > 1; side /= 2) ++level;
  return level;
}

// What of an image is shown at a coordinate of any size, in [0, 1].
FUNCTION float fold(float place, uint wrap) {
  if (wrap == k_wrap_repeat) return place - floor(place);
  if (wrap == k_wrap_clamp) return clamp(place, 0.0f, 1.0f);
  float turn = place - 2.0f * floor(0.5f * place);
  return turn > 1.0f ? 2.0f - turn : turn;
}

// The texel of that number, from −1 to n.
FUNCTION int wrapped_texel(int texel, int n, uint wrap) {
  if (wrap == k_wrap_repeat) return texel < 0 ? n - 1 : texel >= n ? 0 : texel;
  return clamp(texel, 0, n - 1);  // a mirror shows the texels at an edge twice
}

// The four texels around a place.
FUNCTION TexelBlend texture_blend(IN(vec2) place, IN(ivec2) size, IN(uvec2) wrap) {
  float column = fold(place.x, wrap.x) * float(size.x) - 0.5f;
  float row = fold(place.y, wrap.y) * float(size.y) - 0.5f;
  int x = int(clamp(floor(column), -1.0f, float(size.x - 1)));
  int y = int(clamp(floor(row), -1.0f, float(size.y - 1)));
  TexelBlend blend;
  blend.weight = clamp(vec2(column - float(x), row - float(y)), vec2(0.0f), vec2(1.0f));
  blend.from = ivec2(wrapped_texel(x, size.x, wrap.x), wrapped_texel(y, size.y, wrap.y));
  blend.to = ivec2(wrapped_texel(x + 1, size.x, wrap.x), wrapped_texel(y + 1, size.y, wrap.y));
  return blend;
}

// Where a texel of a level lies in the store: column, row, image.
FUNCTION ivec3 store_place(uint first, int width, IN(ivec2) texel) {
  uint at = first + uint(texel.y) * uint(width) + uint(texel.x);
  return ivec3(int(at & (k_store_side - 1u)), int((at >> k_store_side_bits) & (k_store_side - 1u)),
               int(at >> (2u * k_store_side_bits)));
}

// What is averaged for a pixel.
struct TextureProbes {
  vec2 apart;   // from a place to the next; they lie about the pixel's own
  int count;
  float level;  // between two levels
};

// The probes of a footprint: what a texture's coordinates change by from a pixel to the next, along the image's rows and columns.
FUNCTION TextureProbes texture_probes(IN(vec2) along_row, IN(vec2) along_column, IN(ivec2) size) {
  float row = min(length(along_row * vec2(size)), 1e9f);  // [texels]
  float column = min(length(along_column * vec2(size)), 1e9f);
  // What is narrower than a texel is filtered as a texel. Sides that differ by rounding alone are alike.
  float longer = max(max(row, column), 1.0f);
  float shorter = max(min(row, column), 1.0f);
  TextureProbes probes;
  probes.count = int(clamp(ceil(longer / shorter - 0.01f), 1.0f, float(k_most_probes)));
  probes.apart = (row > column ? along_row : along_column) / float(probes.count);
  probes.level = clamp(log2(longer / float(probes.count)), 0.0f, float(last_level(size)));
  return probes;
}

#endif
