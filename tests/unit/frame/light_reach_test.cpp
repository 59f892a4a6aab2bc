#include "frame/light_reach.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "frame/blocks.h"
#include "support/random.h"
#include "support/view_rays.h"

namespace airlight::frame {
namespace {

using std::numbers::pi;
using tests::Random;

/// A view of clear air.
scene::View view_of(const scene::Light& light) {
  scene::View view;
  view.lights = {light};
  view.medium.sigma_s = glm::vec3(1e-9f);
  view.size = {40, 30};
  return view;
}

bool may_reach(const scene::View& view) {
  return frame::may_reach(view, view.lights[0]);
}

/// Whether light arrives at some point that is seen, of very many.
bool is_seen_to_reach(Random& random, const scene::View& view) {
  const scene::Light& light = view.lights[0];
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  const double distance = glm::distance(light.position, camera.eye);
  for (int i = 0; i < 4000; ++i) {
    // As often on the image's border as inside it.
    const auto coordinate = [&] { return std::clamp(random.uniform(-1.5, 1.5), -1.0, 1.0); };
    const double x = coordinate(), y = coordinate();
    const glm::dvec3 point =
        camera.eye + distance * random.logarithmic(1e-3, 1e3) * tests::view_ray(camera, x, y);
    const glm::dvec3 way = point - light.position;
    const bool in_cone =
        !light.cone || std::acos(glm::dot(glm::normalize(way), light.cone->axis)) < light.cone->outer;
    if (in_cone && (!light.range || glm::length(way) < *light.range)) return true;
  }
  return false;
}

TEST(MayReach, IsNeverWronglyDeniedAndSeldomWronglyGranted) {
  Random random(11);
  for (const bool has_cone : {false, true}) {
    for (const bool has_range : {false, true}) {
      int reaching = 0, denied = 0, missed = 0, idle = 0;
      for (int i = 0; i < 400; ++i) {
        scene::Light light =
            scene::point_light("", 3.0 * random.direction() * random.uniform(), glm::vec3(1.0f));
        if (has_cone)
          light.cone =
              scene::Cone{.axis = random.direction(), .inner = 0.0, .outer = 0.5 * pi * random.uniform()};
        if (has_range) light.range = random.logarithmic(0.1, 10.0);
        scene::View view = view_of(light);
        view.camera.target = random.direction();
        view.camera.up = random.direction();
        view.camera.vertical_fov_degrees = random.uniform(5.0, 130.0);
        const bool reaches = is_seen_to_reach(random, view);
        const bool is_granted = may_reach(view);
        reaching += reaches;
        denied += !is_granted;
        missed += reaches && !is_granted;
        idle += !reaches && is_granted;
      }
      EXPECT_EQ(missed, 0) << has_cone << has_range;
      if (!has_cone && !has_range) {
        EXPECT_EQ(denied, 0);
        continue;
      }
      EXPECT_GT(reaching, 40) << has_cone << has_range;
      EXPECT_GT(denied, 40) << has_cone << has_range;
      // Cone and range are asked about one by one; samples miss narrow crossings.
      EXPECT_LT(idle, (has_cone && has_range ? 0.25 : 0.04) * (denied + idle)) << has_cone << has_range;
    }
  }
}

TEST(MayReach, KnowsWhereARangeTouchesWhatIsSeen) {
  // Looking along −z with 90° across: the right side is the plane x = −z.
  scene::View view = view_of(scene::point_light("", {3, 0, -1}, glm::vec3(1.0f)));
  view.camera.vertical_fov_degrees = 90;
  view.size = {10, 10};
  for (const double side : {0.99, 1.01}) {
    view.lights[0].position = {3, 0, -1};
    view.lights[0].range = side * std::sqrt(2.0);
    EXPECT_EQ(may_reach(view), side > 1.0) << "a side";
    view.lights[0].position = {0, 0, 2};
    view.lights[0].range = side * 2.0;
    EXPECT_EQ(may_reach(view), side > 1.0) << "the eye";
    view.lights[0].position = {3, 3, -1};  // nearest to (7, 7, −7) / 3
    view.lights[0].range = side * std::sqrt(8.0 / 3.0);
    EXPECT_EQ(may_reach(view), side > 1.0) << "an edge";
  }
}

TEST(MayReach, KnowsWhereASpotTurnsAway) {
  scene::View view = view_of(scene::point_light("", {0, 0, -5}, glm::vec3(1.0f)));
  view.lights[0].cone = scene::Cone{.axis = {0, 0, -1}, .inner = 0.0, .outer = 0.1};
  EXPECT_TRUE(may_reach(view)) << "it stands in the image";
  view.lights[0].position = {0, 0, 5};
  EXPECT_TRUE(may_reach(view)) << "from behind, along the view";
  view.lights[0].cone->axis = {0, 0, 1};
  EXPECT_FALSE(may_reach(view)) << "away from it";
  view.lights[0].cone->outer = 0.5 * pi;
  EXPECT_FALSE(may_reach(view)) << "a half-space behind the eye";
  view.lights[0].position = {0, 0, -1e-3};
  EXPECT_TRUE(may_reach(view)) << "one that the eye is in";
}

TEST(MayReach, EndsWhereSinglePrecisionDoes) {
  scene::View view = view_of(scene::point_light("", {0, 0, -10}, glm::vec3(1.0f)));
  view.medium.sigma_s = {10.6f, 10.4f, 20.0f};
  EXPECT_TRUE(may_reach(view)) << "in green, an optical depth of 104";
  view.medium.sigma_a = {0.0f, 0.2f, 0.0f};
  EXPECT_FALSE(may_reach(view));
  EXPECT_EQ(1e30f * std::exp(static_cast<float>(-k_deepest_light)), 0.0f);
  view.medium.top = -1.0;
  EXPECT_TRUE(may_reach(view)) << "above the medium";
  view.medium.top = 4.97;
  EXPECT_FALSE(may_reach(view)) << "up to the top and down again is hardly shorter";
  view.medium.top = 4.9;
  EXPECT_TRUE(may_reach(view));
  view.lights = {scene::sun("", {0, 1, 0}, glm::vec3(1.0f))};
  EXPECT_TRUE(may_reach(view));
  view.medium.top = 11.0;
  EXPECT_FALSE(may_reach(view)) << "the eye is deep below the top";
  view.medium.top.reset();
  EXPECT_TRUE(may_reach(view)) << "its path has no length";
}

}  // namespace
}  // namespace airlight::frame
