#include <vector>

#include <gtest/gtest.h>

#include "frame/blocks.h"

namespace airlight::shaders {
#include "frame/footprint.glsl"
#include "frame/octahedron.glsl"
#include "frame/texture_filter.glsl"

/// shaders/frame/texture_filter.glsl, footprint.glsl and octahedron.glsl.
namespace {

TEST(TextureLevel, FollowsTheOneBeforeIt) {
  // 5×3, 2×1, 1×1.
  EXPECT_EQ(last_level({5, 3}), 2);
  EXPECT_EQ(last_level({1, 1}), 0);
  EXPECT_EQ(last_level({1, 8}), 3);
  EXPECT_EQ(last_level({16384, 2}), 14);
  const TextureLevel first = texture_level(100, {5, 3}, 0), second = texture_level(100, {5, 3}, 1),
                     third = texture_level(100, {5, 3}, 2);
  EXPECT_EQ(first.first, 100u);
  EXPECT_EQ(first.size, ivec2(5, 3));
  EXPECT_EQ(second.first, 115u);
  EXPECT_EQ(second.size, ivec2(2, 1));
  EXPECT_EQ(third.first, 117u);
  EXPECT_EQ(third.size, ivec2(1, 1));
}

TEST(Fold, ShowsWhatEachWrapSays) {
  const struct {
    float place, repeated, clamped, mirrored;
  } cases[] = {{0.25f, 0.25f, 0.25f, 0.25f},
               {1.25f, 0.25f, 1.0f, 0.75f},
               {2.25f, 0.25f, 1.0f, 0.25f},
               {-0.25f, 0.75f, 0.0f, 0.25f},
               {-1.25f, 0.75f, 0.0f, 0.75f}};
  for (const auto& c : cases) {
    EXPECT_FLOAT_EQ(fold(c.place, k_wrap_repeat), c.repeated) << c.place;
    EXPECT_FLOAT_EQ(fold(c.place, k_wrap_clamp), c.clamped) << c.place;
    EXPECT_FLOAT_EQ(fold(c.place, k_wrap_mirror), c.mirrored) << c.place;
  }
}

TEST(TextureBlend, TakesTheTexelsAroundAPlace) {
  // Half-way between the centres of texels 1 and 2, and of rows 0 and 1.
  const TexelBlend blend = texture_blend({0.5f, 0.5f}, {4, 2}, {k_wrap_repeat, k_wrap_repeat});
  EXPECT_EQ(blend.from, ivec2(1, 0));
  EXPECT_EQ(blend.to, ivec2(2, 1));
  EXPECT_FLOAT_EQ(blend.weight.x, 0.5f);
  EXPECT_FLOAT_EQ(blend.weight.y, 0.5f);
}

TEST(TextureBlend, AtAnEdgeGoesWhereTheWrapSays) {
  const auto across = [](uint wrap, float place) {
    return texture_blend({place, 0.5f}, {4, 1}, {wrap, wrap});
  };
  for (const float edge : {0.0f, 1.0f, -3.0f}) {
    EXPECT_EQ(across(k_wrap_repeat, edge).from.x, 3) << edge;
    EXPECT_EQ(across(k_wrap_repeat, edge).to.x, 0) << edge;
  }
  EXPECT_EQ(across(k_wrap_clamp, -0.3f).from.x, 0);
  EXPECT_EQ(across(k_wrap_clamp, -0.3f).to.x, 0);
  EXPECT_EQ(across(k_wrap_clamp, 1.3f).from.x, 3);
  EXPECT_EQ(across(k_wrap_clamp, 1.3f).to.x, 3);
  EXPECT_EQ(across(k_wrap_mirror, 1.0f).from.x, 3);
  EXPECT_EQ(across(k_wrap_mirror, 1.0f).to.x, 3);
  EXPECT_EQ(across(k_wrap_mirror, 1.25f).to.x, 3);  // 0.75: between texels 2 and 3
  EXPECT_EQ(across(k_wrap_mirror, 1.25f).from.x, 2);
}

TEST(TextureBlend, StaysInTheTextureWhateverThePlace) {
  for (const uint wrap : {k_wrap_repeat, k_wrap_clamp, k_wrap_mirror}) {
    for (const float place : {-1e18f, -1e-30f, -0.99999994f, 0.99999994f, 1.00000012f, 3e7f, 1e18f}) {
      const TexelBlend blend = texture_blend({place, place}, {3, 1}, {wrap, wrap});
      for (const ivec2 texel : {blend.from, blend.to}) {
        EXPECT_TRUE(texel.x >= 0 && texel.x < 3 && texel.y == 0) << place;
      }
      EXPECT_TRUE(blend.weight.x >= 0.0f && blend.weight.x <= 1.0f) << place;
    }
  }
}

TEST(StorePlace, FillsRowsThenImages) {
  EXPECT_EQ(store_place(10, 7, {3, 2}), ivec3(27, 0, 0));
  EXPECT_EQ(store_place(4095, 7, {1, 0}), ivec3(0, 1, 0));
  EXPECT_EQ(store_place(4096 * 4096 - 1, 7, {0, 0}), ivec3(4095, 4095, 0));
  EXPECT_EQ(store_place(4096u * 4096u * 3u, 5, {2, 0}), ivec3(2, 0, 3));
}

TEST(TextureProbes, TakeALevelPerOctaveAndPlacesAlongTheLongerSide) {
  const ivec2 size(256, 256);
  const float texel = 1.0f / 256.0f;
  const auto probes = [&](vec2 row, vec2 column) {
    return texture_probes(row * texel, column * texel, size);
  };
  EXPECT_EQ(probes({0.5f, 0}, {0, 0.5f}).level, 0.0f);  // magnified
  EXPECT_EQ(probes({0.5f, 0}, {0, 0.5f}).count, 1);
  EXPECT_FLOAT_EQ(probes({4, 0}, {0, 4}).level, 2.0f);
  // 16 texels by 4: four places, each as one of 4.
  const TextureProbes longer = probes({0, 4}, {16, 0});
  EXPECT_EQ(longer.count, 4);
  EXPECT_FLOAT_EQ(longer.level, 2.0f);
  EXPECT_FLOAT_EQ(longer.apart.x, 4 * texel);
  EXPECT_FLOAT_EQ(longer.apart.y, 0.0f);
  // At most eight: 64 texels by 1 are eight of 8.
  EXPECT_EQ(probes({64, 0}, {0, 1}).count, 8);
  EXPECT_FLOAT_EQ(probes({64, 0}, {0, 1}).level, 3.0f);
  // No level after the last.
  EXPECT_FLOAT_EQ(probes({1e30f, 0}, {0, 1e30f}).level, 8.0f);
  EXPECT_EQ(probes({0, 0}, {0, 0}).count, 1);
}

TEST(WeightsPerTurn, AreTheDifferenceOfNeighboursWeights) {
  const vec3 a(-3, -2, -9), b(4, -1, -12), c(0.5f, 3, -7);
  const vec3 ray = normalize(vec3(0.05f, 0.1f, -1)), turned = normalize(vec3(0.051f, 0.1f, -1));
  const vec3 expected = surface_weights(turned, a, b, c) - surface_weights(ray, a, b, c);
  const vec3 weights = weights_per_turn(ray, turned - ray, a, b, c);
  // Of the first order: the turn is 1e-3.
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(weights[i], expected[i], 3e-3f * length(expected));
}

TEST(WeightsPerTurn, AreFiniteOfATriangleSeenEdgeOn) {
  const vec3 weights = weights_per_turn({0, 0, -1}, {0, 1e-3f, 0}, {-1, 0, -5}, {1, 0, -5}, {0, 0, -9});
  for (int i = 0; i < 3; ++i) EXPECT_LT(std::abs(weights[i]), 1e6f);
  EXPECT_EQ(weights_per_turn({0, 0, -1}, {0, 1e-3f, 0}, {0, 0, -5}, {0, 0, -6}, {0, 0, -7}), vec3(0));
}

TEST(Octahedron, KeepsUnitVectorsToItsBits) {
  for (const vec3 v : {vec3(1, 0, 0), vec3(0, 0, 1), vec3(0, 0, -1), vec3(-1, 0, 0), vec3(0.3f, -0.5f, 0.8f),
                       vec3(-0.3f, 0.5f, -0.8f), vec3(1, 1, -1e-6f), vec3(-1, -1, -1)}) {
    const vec3 unit = normalize(v);
    // Half a step of 2/65534 in each of two numbers, both of them in the third, of a vector at least 1/√3
    // long: 6.5e-5.
    EXPECT_LT(length(of_octahedron(octahedron_of(unit)) - unit), 7e-5f) << v.x << " " << v.y << " " << v.z;
  }
}

}  // namespace
}  // namespace airlight::shaders
