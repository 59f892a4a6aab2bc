#include <gtest/gtest.h>

#include "frame/blocks.h"
#include "support/random.h"

/// shaders/frame/shadow_cube.glsl.
namespace airlight::shaders {
namespace {

TEST(ShadowCube, EachFaceLooksAlongItsAxis) {
  const glm::vec3 axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (int face = 0; face < 6; ++face) {
    EXPECT_EQ(cube_direction(face, {0.0f, 0.0f}), axes[face]);
    const CubePoint point = cube_point(3.0f * axes[face]);
    EXPECT_EQ(point.face, face);
    EXPECT_EQ(point.uv, glm::vec2(0.0f));
    EXPECT_EQ(point.depth, 3.0f);
  }
}

TEST(ShadowCube, UAndVFollowTheAxesInCyclicOrder) {
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const glm::vec3 along_u = cube_direction(face, {1.0f, 0.0f}) - cube_direction(face, {0.0f, 0.0f});
    const glm::vec3 along_v = cube_direction(face, {0.0f, 1.0f}) - cube_direction(face, {0.0f, 0.0f});
    EXPECT_EQ(along_u[(axis + 1) % 3], 1.0f);
    EXPECT_EQ(along_v[(axis + 2) % 3], 1.0f);
  }
}

TEST(ShadowCube, PointAndDirectionAreInverse) {
  tests::Random random(14);
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 d(random.logarithmic(1e-3, 1e3) * random.direction());
    const CubePoint point = cube_point(d);
    ASSERT_GE(point.face, 0);
    ASSERT_LT(point.face, 6);
    EXPECT_LE(std::abs(point.uv.x), 1.0f);
    EXPECT_LE(std::abs(point.uv.y), 1.0f);
    EXPECT_LE(glm::length(point.depth * cube_direction(point.face, point.uv) - d), 2e-7f * glm::length(d));
  }
  for (int face = 0; face < 6; ++face) {
    for (int i = 0; i < 2000; ++i) {
      const glm::vec2 uv(random.uniform(-0.999, 0.999), random.uniform(-0.999, 0.999));
      const CubePoint point = cube_point(cube_direction(face, uv));
      EXPECT_EQ(point.face, face);
      EXPECT_EQ(point.uv, uv);
      EXPECT_EQ(point.depth, 1.0f);
    }
  }
}

TEST(ShadowCube, EdgesAndCornersBelongToSomeFace) {
  for (float x : {-1.0f, 1.0f}) {
    for (float y : {-1.0f, 1.0f}) {
      for (float z : {-1.0f, 0.0f, 1.0f}) {
        const CubePoint point = cube_point({x, y, z});
        EXPECT_EQ(point.depth, 1.0f);
        EXPECT_EQ(cube_direction(point.face, point.uv), glm::vec3(x, y, z));
      }
    }
  }
}

TEST(ShadowCube, TexelCentresLieInTheirTexels) {
  for (int size : {1, 7, 512, 4096}) {
    const auto n = static_cast<float>(size);
    for (int x : {0, size / 3, size - 1}) {
      for (int y : {0, size / 2, size - 1}) {
        EXPECT_EQ(cube_texel(cube_texel_centre({x, y}, n), n), glm::ivec2(x, y));
      }
    }
    EXPECT_EQ(cube_texel({-1.0f, 1.0f}, n), glm::ivec2(0, size - 1)) << "the face's own edge";
  }
}

}  // namespace
}  // namespace airlight::shaders
