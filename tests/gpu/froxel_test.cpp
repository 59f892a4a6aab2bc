// What `froxel` blends along a path with what the frame before found.

#include "media/froxel.h"

#include <vector>

#include <gtest/gtest.h>

#include "frame/none.h"
#include "support/render.h"
#include "support/scenes.h"

namespace airlight {
namespace {

using media::FroxelOptions;
using Images = std::vector<std::vector<glm::vec3>>;

constexpr int k_shadow_map = 256;

class FroxelHistory : public testing::Test {
 protected:
  /// The airlight of each view; as along a path, what rests is kept but in the first.
  Images play(frame::Airlight& airlight, const std::vector<scene::View>& views) {
    frame::NoShadow no_shadow;
    gpu::StageTimer off(nullptr);
    Images images;
    for (const scene::View& view : views) {
      frame_.render(view, no_shadow, airlight, off,
                    images.empty() ? frame::Resting::redrawn : frame::Resting::kept);
      images.push_back(frame_.read().airlight);
    }
    return images;
  }

  Images play(const FroxelOptions& options, const std::vector<scene::View>& views) {
    media::Froxel froxel(options);
    return play(froxel, views);
  }

  /// A slow flight, a part of a tile a frame.
  std::vector<scene::View> flight(int frames) const {
    std::vector<scene::View> views;
    for (int i = 0; i < frames; ++i) {
      scene::View view = view_;
      view.camera.eye += 0.01 * i * glm::dvec3(1.0, 0.3, -0.5);
      views.push_back(view);
    }
    return views;
  }

  const scene::Scene& scene_ = tests::builtin("window");
  scene::View view_ = tests::view_of(scene_, {50, 34});
  frame::Frame frame_{tests::gpu_context(), scene_.geometry, k_shadow_map};
};

TEST_F(FroxelHistory, ComesNearerToManyLookUps) {
  const std::vector<scene::View> views = flight(20);
  const auto truth = play({.samples = 64}, views), off = play({}, views), on = play({.history = true}, views);
  const auto rrmse = [&](const Images& images, std::size_t i) {
    return tests::error_of(images[i], truth[i]).rrmse;
  };
  RecordProperty("off", std::to_string(rrmse(off, 19)));
  RecordProperty("on", std::to_string(rrmse(on, 19)));
  EXPECT_LT(rrmse(on, 19), 0.5 * rrmse(off, 19));
  // What changes between two frames, and not with those look-ups, is less too, though each brings its own.
  double change_off = 0.0, change_on = 0.0;
  for (std::size_t i = 10; i < 20; ++i) {
    const auto change = [&](const Images& images) {
      const std::vector<float> seen(images[i].size(), 1.0f);
      const auto error = [&](std::size_t j) {
        return quality::error_image(quality::channels_of(images[j]), seen, quality::channels_of(truth[j]),
                                    seen);
      };
      return quality::flicker(error(i - 1), error(i));
    };
    change_off += change(off);
    change_on += change(on);
  }
  EXPECT_LT(change_on, 0.9 * change_off);
}

TEST_F(FroxelHistory, OfARestingViewIsTheMeanOfLookUps) {
  // 16 frames of one look-up are, weighted alike, a frame of 16.
  const std::vector<scene::View> views(16, view_);
  const auto on = play({.history = true}, views);
  const auto many = play({.samples = 16}, {view_});
  // A look-up elsewhere in a froxel is there multiplied with what that place scatters, here with the
  // middle's.
  EXPECT_LT(tests::error_of(on[15], many[0]).rrmse, 0.02);
  EXPECT_GT(tests::error_of(on[0], many[0]).rrmse, 0.05);
}

TEST_F(FroxelHistory, BeginsAsWithout) {
  for (const int samples : {1, 4})
    EXPECT_EQ(play({.samples = samples, .history = true}, {view_}), play({.samples = samples}, {view_}))
        << samples;
}

TEST_F(FroxelHistory, BeginsAnewWhereAFrameDrawsAllOfItsOwn) {
  // A path is the same however often it is played, and whatever was seen before.
  media::Froxel froxel({.history = true});
  scene::View elsewhere = view_;
  elsewhere.camera.eye.x += 0.5;
  play(froxel, {elsewhere, elsewhere});
  const Images first = play(froxel, flight(4));
  EXPECT_EQ(first, play({.history = true}, flight(4)));
  EXPECT_EQ(first, play(froxel, flight(4)));
  EXPECT_EQ(play(froxel, {view_}), play({}, {view_})) << "an image that stands alone";
}

TEST_F(FroxelHistory, BeginsAnewForAnotherImageOrLight) {
  const std::vector<scene::View> before(3, view_);
  const auto follow = [&](const scene::View& view) {
    std::vector<scene::View> views = before;
    views.push_back(view);
    return play({.history = true}, views)[3];
  };
  scene::View other = view_;
  other.size = {66, 34};
  EXPECT_EQ(follow(other), play({}, {other})[0]);
  other = view_;
  other.lights[0] = scene::sun("", {0.3, 0.8, 0.4}, glm::vec3(2.0f));
  EXPECT_EQ(follow(other), play({}, {other})[0]);
  other = view_;
  other.lights[0].name = "another";
  EXPECT_EQ(follow(other), play({}, {other})[0]);
  EXPECT_NE(follow(view_), play({}, {view_})[0]);
}

TEST_F(FroxelHistory, LeavesOutWhatTheFrameBeforeDidNotSee) {
  // An about-face: the frame before saw nothing of it.
  scene::View behind = view_;
  behind.camera.target = 2.0 * behind.camera.eye - behind.camera.target;
  const auto turned = play({.history = true}, {behind, view_})[1];
  const auto truth = play({.samples = 64}, {view_})[0], off = play({}, {view_})[0];
  // Its look-ups do not lie in froxels' middles, as those of a first frame do.
  EXPECT_LT(tests::error_of(turned, truth).rrmse, 1.5 * tests::error_of(off, truth).rrmse);
}

TEST_F(FroxelHistory, KnowsNeitherMediumNorBrightness) {
  // What is kept is what is lit: all else is the frame's own.
  scene::View bright = view_;
  bright.lights[0].intensity *= 8.0f;
  bright.medium.sigma_s *= 0.5f;
  const std::vector<scene::View> views(8, view_), brights(8, bright);
  std::vector<scene::View> changed = views;
  changed.back() = bright;
  const auto follow = play({.history = true}, changed), always = play({.history = true}, brights);
  // Slices end elsewhere where the fog is thinner: what was found is interpolated.
  EXPECT_LT(tests::error_of(follow[7], always[7]).rrmse, 0.05);
}

TEST_F(FroxelHistory, OfEachLightIsItsOwnAndCounted) {
  scene::View two = view_;
  two.lights.push_back(
      scene::point_light("other", two.lights[0].position + glm::dvec3(0.5, -0.5, 0.3), {1, 2, 3}));
  const std::vector<scene::View> views(6, two);
  media::Froxel froxel({.history = true});
  const auto both = play(froxel, views);
  const std::int64_t froxels = 7 * 5 * 64;
  EXPECT_EQ(froxel.bytes(),
            (std::map<std::string, std::int64_t>{{"froxels", froxels * 16}, {"history", 3 * froxels * 4}}));
  std::vector<glm::vec3> sum(both[5].size(), glm::vec3(0.0f));
  for (const scene::Light& light : two.lights) {
    scene::View alone = view_;
    alone.lights = {light};
    const auto of_light = play({.history = true}, std::vector<scene::View>(6, alone));
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += of_light[5][i];
  }
  EXPECT_LT(tests::error_of(both[5], sum).max, 1e-5);  // of single precision's sums
}

}  // namespace
}  // namespace airlight
