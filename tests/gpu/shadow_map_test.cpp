#include "frame/shadow_map.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frame/blocks.h"
#include "reference/visibility.h"
#include "scene/error.h"
#include "support/frame_probe.h"
#include "support/scenes.h"

#include <epoxy/gl.h>

namespace airlight::frame {
namespace {

using tests::builtin;
using tests::look_into_frame;
using tests::view_of;

/// light_near / depth of every texel of the six faces, 0 where there is nothing.
std::vector<float> read_faces(const ShadowMap& map, int size) {
  std::vector<float> texels(static_cast<std::size_t>(6 * size * size));
  glGetTextureImage(map.depth().name(), 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                    static_cast<GLsizei>(4 * texels.size()), texels.data());
  return texels;
}

class ShadowMapOf : public testing::TestWithParam<const char*> {};

TEST_P(ShadowMapOf, HoldsTheDistancesOfRaysThroughItsTexels) {
  const scene::Scene& scene = builtin(GetParam());
  const scene::View view = view_of(scene, {16, 16});
  const int size = 96;
  look_into_frame(scene.geometry, view, size, [&](const FrameInputs& inputs) {
    const std::vector<float> texels = read_faces(inputs.shadow_map(), size);
    // Distances are stored as near / z, and near is in the light's block, which the frame keeps bound.
    GLint block = 0;
    glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, shaders::k_light_block, &block);
    shaders::LightBlock light;
    glGetNamedBufferSubData(static_cast<GLuint>(block), 0, sizeof light, &light);
    // Rays from the light: what is the light elsewhere is here any other point.
    const reference::Triangles triangles{scene.geometry.positions, scene.geometry.triangles};
    const reference::Visibility exact(triangles, view.camera.eye, view.lights[0].position);
    std::size_t at = 0, hits = 0, wrong = 0;
    for (int face = 0; face < 6; ++face) {
      for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x, ++at) {
          const glm::dvec3 along(
              shaders::cube_direction(face, shaders::cube_texel_centre({x, y}, static_cast<float>(size))));
          const double expected = exact.first_hit(glm::normalize(along)).distance;
          const double z = texels[at] > 0 ? static_cast<double>(light.near / texels[at]) : 0.0;
          const double distance = z * glm::length(along);
          hits += expected > 0;
          // Depth is interpolated in single precision, the more coarsely the farther a triangle reaches
          // beside the light.
          const bool same = std::abs(distance - expected) <= 2e-4 * expected;
          wrong += same ? 0 : 1;
        }
      }
    }
    RecordProperty("hits", static_cast<int>(hits));
    RecordProperty("wrong", static_cast<int>(wrong));
    EXPECT_GT(hits, 1000u);
    // A texel centre within 1/256 of a texel of an edge may fall on its other side.
    EXPECT_LE(wrong, texels.size() / 500);
  });
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShadowMapOf, testing::Values("cornell", "window", "sphere", "half-space"));

TEST(ShadowMap, OfAnEmptySceneHoldsNothing) {
  const scene::Scene& scene = builtin("empty");
  look_into_frame(scene.geometry, view_of(scene, {8, 8}), 16, [&](const FrameInputs& inputs) {
    for (float texel : read_faces(inputs.shadow_map(), 16)) EXPECT_EQ(texel, 0.0f);
  });
}

TEST(ShadowMap, OverTheDriversLimitIsAnErrorThatNamesIt) {
  const gpu::Context& context = tests::gpu_context();
  try {
    const ShadowMap map(context, context.limits().max_texture_size + 1);
    FAIL();
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, scene::ExitCode::driver);
    EXPECT_THAT(error.what(), testing::HasSubstr("GL_MAX_TEXTURE_SIZE"));
  }
}

}  // namespace
}  // namespace airlight::frame
