#include "frame/shadow_map.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frame/blocks.h"
#include "media/vsv.h"
#include "reference/visibility.h"
#include "scene/error.h"
#include "support/frame_probe.h"
#include "support/random.h"
#include "support/scenes.h"
#include "surface_shadows/shadow_map_lookup.h"

#include <epoxy/gl.h>

namespace airlight::frame {
namespace {

using tests::builtin;
using tests::look_into_frame;
using tests::view_of;

/// light_near / depth of every texel of the six faces, 0 where there is nothing.
std::vector<float> read_faces(const gpu::Texture& map, int size) {
  std::vector<float> texels(static_cast<std::size_t>(6 * size * size));
  glGetTextureImage(map.name(), 0, GL_DEPTH_COMPONENT, GL_FLOAT, static_cast<GLsizei>(4 * texels.size()),
                    texels.data());
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
    const reference::Triangles triangles(scene.geometry);
    const reference::Visibility exact(triangles, view.camera.eye, view.lights[0].position);
    std::size_t at = 0, hits = 0, wrong = 0;
    std::vector<double> differences;
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
          if (!same) differences.push_back(distance / expected - 1);
        }
      }
    }
    RecordProperty("hits", static_cast<int>(hits));
    RecordProperty("wrong", static_cast<int>(wrong));
    EXPECT_GT(hits, 1000u);
    // A texel centre within 1/256 of a texel of an edge may fall on its other side.
    std::sort(differences.begin(), differences.end());
    EXPECT_LE(wrong, texels.size() / 500) << "off by " << differences.front() << " to " << differences.back()
                                          << ", half by " << differences[differences.size() / 2];
  });
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShadowMapOf, testing::Values("cornell", "window", "sphere", "half-space"));

TEST(ShadowMap, OfAnEmptySceneHoldsNothing) {
  const scene::Scene& scene = builtin("empty");
  look_into_frame(scene.geometry, view_of(scene, {8, 8}), 16, [&](const FrameInputs& inputs) {
    for (float texel : read_faces(inputs.shadow_map(), 16)) EXPECT_EQ(texel, 0.0f);
  });
}

TEST(ShadowMap, HoldsTheFacesAskedForAndNothingElsewhere) {
  scene::Geometry room;
  tests::add_box(room, {-1, -1, -1}, {1, 1, 1});
  scene::View view;
  view.camera.eye = {0, 0, 0};
  view.camera.target = {0, 0, -1};
  view.lights[0].position = {0.0, 0.1, 0.5};
  view.size = {16, 16};
  const int size = 32;
  std::vector<float> all;
  Frame frame(tests::gpu_context(), room, size);
  NoShadow no_shadow;
  gpu::StageTimer timer(nullptr);
  tests::FrameProbe all_faces(
      [&](const FrameInputs& inputs) { all = read_faces(inputs.shadow_map(), size); });
  frame.render(view, no_shadow, all_faces, timer);
  tests::FrameProbe some_faces([&](const FrameInputs& inputs) {
    const CubeFaces needed =
        needed_faces(scene::camera_frame(view.camera, view.size), view.lights[0].position, 0.0);
    EXPECT_LT(needed.count(), 6u);
    const std::vector<float> some = read_faces(inputs.shadow_map(0.0), size);
    for (std::size_t at = 0; at < all.size(); ++at) {
      const std::size_t face = at / static_cast<std::size_t>(size * size);
      ASSERT_EQ(some[at], needed[face] ? all[at] : 0.0f) << "face " << face;
    }
    EXPECT_NE(some, all) << "the room is on all sides of the light";
    EXPECT_EQ(read_faces(inputs.shadow_map(), size), all) << "the rest is drawn when it is asked for";
  });
  frame.render(view, no_shadow, some_faces, timer);
}

/// Draws all faces before its look-up asks for those that it needs.
class LookUpInAllFaces : public surface_shadows::ShadowMapLookup {
 public:
  void query(const FrameInputs& inputs, const gpu::Texture& visibility) override {
    const scene::CameraFrame camera = scene::camera_frame(inputs.view.camera, inputs.view.size);
    some_are_enough =
        !inputs.shadow_map_is_plane() && !needed_faces(camera, inputs.light().position, 0.0).all();
    inputs.shadow_map();
    ShadowMapLookup::query(inputs, visibility);
  }
  bool some_are_enough = false;
};

TEST(ShadowMap, FacesThatAreLeftOutChangeNoPicture) {
  tests::Random random(1);
  scene::Geometry shards;
  for (int i = 0; i < 400; ++i) {
    const auto shard = glm::vec3(random.in_box(2.0));
    tests::add_triangle(shards, shard, shard + glm::vec3(random.in_box(0.3)),
                        shard + glm::vec3(random.in_box(0.3)));
  }
  Frame frame(tests::gpu_context(), shards, 64);
  surface_shadows::ShadowMapLookup lookup;
  LookUpInAllFaces lookup_in_all_faces;
  gpu::StageTimer timer(nullptr);
  for (const epipolar::Resolution& resolution : {epipolar::Resolution{32, 16, 128}, {32, 512, 512}}) {
    media::Vsv vsv(tests::gpu_context(), {.volume = {.resolution = resolution}});
    int views_by_some_faces = 0;
    for (int i = 0; i < 60; ++i) {
      scene::View view;
      view.size = {32, 32};
      view.camera.eye = random.in_box(1.0);
      if (i < 30) {
        view.camera.target = view.camera.eye + random.direction();
        view.lights[0].position = random.in_box(2.0);
      } else {
        // The image's sides lie just inside the sides of a face, as far as light rays reach beside pixels.
        view.camera.target = view.camera.eye + glm::dvec3(0, 0, -1);
        view.camera.vertical_fov_degrees = random.uniform(80.0, 90.0);
        view.lights[0].position = view.camera.eye + glm::dvec3(0, 0, 0.3) + random.in_box(0.01);
      }
      frame.render(view, lookup, vsv, timer);
      const FrameImages images = frame.read();
      frame.render(view, lookup_in_all_faces, vsv, timer);
      const FrameImages expected = frame.read();
      EXPECT_TRUE(images.visibility == expected.visibility) << i;
      EXPECT_TRUE(images.airlight == expected.airlight) << i;
      views_by_some_faces += lookup_in_all_faces.some_are_enough;
    }
    EXPECT_GT(views_by_some_faces, 20);
  }
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
