#include "frame/shadow_map.h"

#include <algorithm>
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

std::size_t face_of(glm::dvec3 direction) {
  return static_cast<std::size_t>(shaders::cube_point(glm::vec3(direction)).face);
}

/// From the light to a point that the camera may see, unit.
glm::dvec3 random_seen(Random& random, const scene::CameraFrame& camera, glm::dvec3 light) {
  // As often on the image's border as inside it.
  const auto coordinate = [&] { return std::clamp(random.uniform(-1.5, 1.5), -1.0, 1.0); };
  const double x = coordinate(), y = coordinate();
  const glm::dvec3 from_light = camera.eye - light;
  const double t = glm::length(from_light) * random.logarithmic(1e-3, 1e3);
  return glm::normalize(from_light + t * tests::view_ray(camera, x, y));
}

glm::dvec3 turned(Random& random, glm::dvec3 direction, double angle) {
  const glm::dvec3 across = glm::normalize(glm::cross(direction, random.direction()));
  return std::cos(angle) * direction + std::sin(angle) * across;
}

TEST(NeededFaces, AreThoseOnWhichWhatIsSeenFallsAndFewMore) {
  Random random(1);
  int needed_faces_in_all = 0, missed = 0, idle = 0;
  constexpr int k_views = 300;
  for (int i = 0; i < k_views; ++i) {
    const scene::CameraFrame camera = tests::random_camera(random);
    const glm::dvec3 light = camera.eye + random.logarithmic(0.01, 100) * random.direction();
    const double reach = i % 2 == 0 ? 0.0 : random.logarithmic(0.001, 1.0);
    const CubeFaces needed = needed_faces(camera, light, reach);
    CubeFaces hit;
    for (int sample = 0; sample < 3000; ++sample)
      hit.set(face_of(turned(random, random_seen(random, camera, light), reach * random.uniform())));
    needed_faces_in_all += static_cast<int>(needed.count());
    missed += static_cast<int>((hit & ~needed).count());
    idle += static_cast<int>((needed & ~hit).count());
  }
  RecordProperty("needed", std::to_string(static_cast<double>(needed_faces_in_all) / k_views));
  RecordProperty("idle", idle);
  EXPECT_EQ(missed, 0);
  EXPECT_LT(needed_faces_in_all, 5 * k_views) << "of six a view";
  EXPECT_LT(idle, needed_faces_in_all / 20);
}

TEST(NeededFaces, AreKnownInEasyCases) {
  const scene::CameraFrame camera{.eye = {0, 0, 0},
                                  .right = {1, 0, 0},
                                  .up = {0, 1, 0},
                                  .forward = {0, 0, -1},
                                  .half_width = 0.9,
                                  .half_height = 0.5};
  const CubeFaces all("111111");
  EXPECT_EQ(needed_faces(camera, {0, 0, 1}, 0.0), CubeFaces("100000")) << "light right behind the eye";
  EXPECT_EQ(needed_faces(camera, {0, 0, 1}, 0.2), CubeFaces("100011")) << "the image's sides are near x";
  EXPECT_EQ(needed_faces(camera, {0, 1, 0}, 0.0), CubeFaces("101000")) << "light above the eye";
  EXPECT_EQ(needed_faces(camera, {0, 0, -5}, 0.0), all) << "light in view";
  EXPECT_EQ(needed_faces(camera, {0, 0, 1}, pi), all);
}

}  // namespace
}  // namespace airlight::frame
