// What rests from a frame to the next is not drawn anew, and no picture tells.

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "epipolar/surface_lookup.h"
#include "frame/frame.h"
#include "media/vsv.h"
#include "support/gpu_context.h"
#include "support/scenes.h"
#include "surface_shadows/shadow_map_lookup.h"

namespace airlight::frame {
namespace {

using tests::builtin;
using tests::gpu_context;
using Names = std::set<std::string>;

const Names k_both = {"shadow_map", "volume"}, k_map = {"shadow_map"}, k_volume = {"volume"}, k_none = {};

/// Draws the same frames twice: by who keeps what rests, and by who has nothing to keep.
class Resting : public testing::Test {
 protected:
  explicit Resting(const char* scene = "cornell", const media::VsvOptions& options = with({}))
      : scene_(builtin(scene)), view_(tests::view_of(scene_, {40, 32})), options_(options) {}

  static media::VsvOptions with(epipolar::VolumeOptions volume) {
    volume.resolution = {64, 128, 128};
    return {.volume = volume};
  }

  void expect_redrawn(const Names& expected, const char* what) {
    gpu::StageTimer off(nullptr);
    frame_.render(view_, lookup_, vsv_, off, frame::Resting::kept);
    const FrameImages images = frame_.read();
    EXPECT_EQ(frame_.redrawn(), expected) << what;

    Frame fresh(gpu_context(), scene_.geometry, 128);
    surface_shadows::ShadowMapLookup lookup;
    media::Vsv vsv(gpu_context(), options_);
    fresh.render(view_, lookup, vsv, off);
    const FrameImages anew = fresh.read();
    EXPECT_TRUE(images.radiance == anew.radiance) << what;
    EXPECT_TRUE(images.airlight == anew.airlight) << what;
    EXPECT_TRUE(images.visibility == anew.visibility) << what;
  }

  const scene::Scene& scene_;
  scene::View view_;
  media::VsvOptions options_;
  Frame frame_{gpu_context(), scene_.geometry, 128};
  surface_shadows::ShadowMapLookup lookup_;
  media::Vsv vsv_{gpu_context(), options_};
};

TEST_F(Resting, FramesDrawWhatHasChanged) {
  expect_redrawn(k_both, "the first frame");
  expect_redrawn(k_none, "nothing moves");
  view_.camera.eye += glm::dvec3(0.011, -0.007, 0.003);
  expect_redrawn(k_volume, "the eye moves");
  expect_redrawn(k_none, "it rests again");
  view_.camera.target.x += 0.05;
  expect_redrawn(k_volume, "the camera turns, and with it what it sees of the volume");
  view_.lights[0].position.x += 0.013;
  expect_redrawn(k_both, "the light moves");
  view_.lights[0].intensity *= 0.5f;
  expect_redrawn(k_none, "the light is dimmed");
  view_.camera.eye.x += 0.1;
  view_.lights[0].position.z += 0.1;
  expect_redrawn(k_both, "all moves");
  view_.medium.sigma_s *= 2.0f;
  expect_redrawn(k_volume, "the fog thickens, and moves the cells of φ");
  view_.size = {32, 40};
  expect_redrawn(k_volume, "another image");
}

TEST_F(Resting, MissingFacesAloneAreDrawn) {
  view_.camera.eye = {0.9, 1.0, 0.9};
  view_.camera.target = {0.9, 1.0, 4.0};
  view_.camera.vertical_fov_degrees = 30.0;
  expect_redrawn(k_both, "the first frame");
  view_.camera.target = {-4.0, 0.5, 0.9};
  expect_redrawn(k_both, "other faces are seen");
  view_.camera.target = {0.9, 1.0, 4.0};
  expect_redrawn(k_volume, "all of them are there");
}

TEST_F(Resting, FramesDrawAnewUnlessTheyAreToKeep) {
  expect_redrawn(k_both, "the first frame");
  gpu::StageTimer off(nullptr);
  frame_.render(view_, lookup_, vsv_, off);
  EXPECT_EQ(frame_.redrawn(), k_both);
  expect_redrawn(k_none, "what was drawn anew is kept");
}

TEST_F(Resting, EachLightOfSeveralIsDrawnInItsTurn) {
  view_.lights.push_back(scene::point_light("", {0.5, 1.4, 0.3}, {0.2f, 0.3f, 0.9f}));
  expect_redrawn(k_both, "the first frame");
  expect_redrawn(k_both, "one map and one volume serve the lights in turn");
}

TEST_F(Resting, AnotherLightIsNoRestingOne) {
  expect_redrawn(k_both, "a lamp");
  const scene::Light lamp = view_.lights[0];
  view_.lights[0] = scene::sun("", {0.3, 0.8, 0.4}, glm::vec3(2.0f));
  expect_redrawn(k_both, "a sun, whose map is on a plane");
  expect_redrawn(k_none, "it rests");
  view_.camera.target.x += 0.05;
  expect_redrawn(k_both, "the plane is fitted to what the camera sees");
  view_.lights[0] = lamp;
  expect_redrawn(k_volume, "the lamp, whose cube is still there");
}

class RestingFull : public Resting {
 protected:
  RestingFull()
      : Resting("cornell",
                with({.ranges = epipolar::Ranges::full, .theta_cells = epipolar::ThetaCells::equal})) {}
};

TEST_F(RestingFull, ATurningCameraLeavesTheWholeVolume) {
  expect_redrawn(k_both, "the first frame");
  view_.camera.target.x += 0.3;
  expect_redrawn(k_none, "all angles are in the volume");
  view_.camera.vertical_fov_degrees += 7.0;
  expect_redrawn(k_none, "all angles are in the volume");
  view_.camera.eye.x += 0.1;
  expect_redrawn(k_volume, "the eye moves");
}

class RestingScreenSpace : public Resting {
 protected:
  RestingScreenSpace() : Resting("sphere", with({.populate = epipolar::Populate::screen_space})) {}
};

TEST_F(RestingScreenSpace, AVolumeNeedsNoMapToRest) {
  expect_redrawn(k_both, "the first frame");
  expect_redrawn(k_none, "nothing moves");
  view_.camera.eye.x += 0.1;
  expect_redrawn(k_volume, "the eye moves");
}

class RestingBlocks : public Resting {
 protected:
  RestingBlocks() : Resting("cornell", with({.scan = epipolar::Scan::blocks})) {}
};

TEST_F(RestingBlocks, TwoVolumesOfAFrameAreKeptEachByItsMethod) {
  epipolar::SurfaceLookup surface(gpu_context(),
                                  {.resolution = {32, 64, 128}, .scan = epipolar::Scan::blocks});
  gpu::StageTimer off(nullptr);
  frame_.render(view_, surface, vsv_, off, frame::Resting::kept);
  const FrameImages first = frame_.read();
  frame_.render(view_, surface, vsv_, off, frame::Resting::kept);
  const FrameImages second = frame_.read();
  EXPECT_EQ(frame_.redrawn(), k_none);
  EXPECT_TRUE(first.radiance == second.radiance);
  EXPECT_TRUE(first.visibility == second.visibility);
}

}  // namespace
}  // namespace airlight::frame
