#include "frame/shadow_plane.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "frame/blocks.h"
#include "support/random.h"
#include "support/view_rays.h"

namespace airlight::frame {
namespace {

using tests::Random;

constexpr int k_size = 256;

scene::Light lamp(glm::dvec3 position) {
  return scene::point_light("", position, glm::vec3(1.0f));
}

scene::Light sun(glm::dvec3 towards) {
  return scene::sun("", towards, glm::vec3(1.0f));
}

/// From a point towards the light: where [m] the ray enters a box, and where it leaves it or ends at the
/// light; the first is larger where it misses.
std::pair<double, double> inside(const scene::Box& box, glm::dvec3 from, glm::dvec3 direction, double end) {
  double enters = 0.0, leaves = end;
  for (int i = 0; i < 3; ++i) {
    const double a = (static_cast<double>(box.lower[i]) - from[i]) / direction[i];
    const double b = (static_cast<double>(box.upper[i]) - from[i]) / direction[i];
    enters = std::max(enters, std::min(a, b));
    leaves = std::min(leaves, std::max(a, b));
  }
  return {enters, leaves};
}

/// What the shaders make of a point relative to the eye.
struct OnMap {
  glm::dvec2 uv;
  double depth, z, across;
};

OnMap on_map(const shaders::LightBlock& block, glm::dvec3 relative) {
  const auto point = glm::vec3(relative);
  const glm::vec3 mapped = point / shaders::plane_share(block, point);
  const glm::dvec4 clip(shaders::plane_clip(block, point));
  const glm::dvec3 axis(block.axis);
  return {.uv = glm::dvec2(shaders::plane_uv(block, mapped)),
          .depth = clip.z / clip.w,
          .z = glm::dot(glm::dvec3(mapped), axis),
          .across = glm::length(glm::cross(glm::dvec3(mapped), axis))};
}

scene::Box random_box(Random& random, glm::dvec3 about) {
  scene::Box box;
  const glm::dvec3 centre = about + random.in_box(8.0);
  box.include(glm::vec3(centre));
  for (int i = 0; i < 2; ++i) box.include(glm::vec3(centre + random.in_box(random.logarithmic(0.3, 10.0))));
  return box;
}

/// Points that the camera sees, in the air and on surfaces, in the box and anywhere, and what in the box may
/// shade them: returns how many such pairs there were.
int expect_occluders_on_map(Random& random, const scene::Light& light, const scene::CameraFrame& camera,
                            const scene::Box& box, const ShadowPlane& plane) {
  const shaders::LightBlock block = light_block(light, camera.eye, 0.0f, k_size, plane);
  const glm::dvec3 axis = scene::direction_to(light, camera.eye);
  int pairs = 0;
  for (int sample = 0; sample < 400; ++sample) {
    // As often on the image's border as inside it.
    const auto coordinate = [&] { return std::clamp(random.uniform(-1.5, 1.5), -1.0, 1.0); };
    const double x = coordinate(), y = coordinate(), t = random.logarithmic(1e-3, 1e3);
    const glm::dvec3 seen = camera.eye + t * tests::view_ray(camera, x, y);
    const glm::dvec3 direction = scene::direction_to(light, seen);
    const double end = scene::is_sun(light) ? 1e9 : glm::distance(light.position, seen);
    const auto [enters, leaves] = inside(box, seen, direction, end);
    if (enters >= leaves) continue;
    ++pairs;
    const double s = enters + (leaves - enters) * std::clamp(random.uniform(-0.5, 1.5), 0.0, 1.0);
    const glm::dvec3 occluder = seen + s * direction - camera.eye;
    const OnMap on = on_map(block, occluder);
    EXPECT_LE(std::abs(on.uv.x), 1.0);
    EXPECT_LE(std::abs(on.uv.y), 1.0);
    EXPECT_GT(on.depth, 0.0);
    EXPECT_LT(on.depth, 1.0);
    // The map keeps view rays, and with them α. Roundings are of the size of the box.
    const double size = glm::length(occluder);
    EXPECT_NEAR(std::atan2(on.across, on.z),
                std::atan2(glm::length(glm::cross(occluder, axis)), glm::dot(occluder, axis)),
                2e-6 + 1e-5 / size);
    // What is nearer to the light on the light ray has the same place and is stored as nearer.
    const OnMap nearest = on_map(block, seen + leaves * direction - camera.eye);
    const double reach = glm::length(seen + leaves * direction - camera.eye);
    EXPECT_NEAR(nearest.uv.x, on.uv.x,
                1e-6 * (1.0 + (size + reach) * glm::length(glm::dvec3(plane.image_x))));
    EXPECT_NEAR(nearest.uv.y, on.uv.y,
                1e-6 * (1.0 + (size + reach) * glm::length(glm::dvec3(plane.image_y))));
    if (leaves - s > 1e-3 * (1.0 + size)) {
      EXPECT_GT(nearest.depth, on.depth);
    }
    EXPECT_NEAR(static_cast<double>(shaders::plane_z(block, static_cast<float>(on.depth))), on.z,
                1e-5 * (size + 1.0 / plane.depth_scale));
    scene::Box speck;  // with what rounding leaves of a position
    speck.include(glm::vec3(camera.eye + occluder) - 4e-6f);
    speck.include(glm::vec3(camera.eye + occluder) + 4e-6f);
    EXPECT_TRUE(plane.may_touch(speck));
  }
  return pairs;
}

TEST(ShadowPlane, HoldsWhatCanShadeWhatIsSeenOfASun) {
  Random random(1);
  int pairs = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const scene::CameraFrame camera = tests::random_camera(random);
    const scene::Box box = random_box(random, camera.eye);
    const scene::Light light = sun(random.direction());
    const auto plane = fit_shadow_plane(light, camera, box, k_size);
    ASSERT_TRUE(plane);
    pairs += expect_occluders_on_map(random, light, camera, box, *plane);
    if (HasFailure()) FAIL() << "trial " << trial;
  }
  EXPECT_GT(pairs, 10000);
}

TEST(ShadowPlane, HoldsWhatCanShadeWhatIsSeenOfAFarLamp) {
  Random random(2);
  int pairs = 0, planes = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const scene::CameraFrame camera = tests::random_camera(random);
    const scene::Box box = random_box(random, camera.eye);
    const scene::Light light = lamp(camera.eye + random.logarithmic(5, 500) * random.direction());
    const auto plane = fit_shadow_plane(light, camera, box, k_size);
    if (!plane) continue;
    ++planes;
    pairs += expect_occluders_on_map(random, light, camera, box, *plane);
    if (HasFailure()) FAIL() << "trial " << trial;
  }
  EXPECT_GT(planes, 1000);
  EXPECT_GT(pairs, 10000);
}

TEST(ShadowPlane, OfALightOnACamerasOwnAxesHoldsThemToo) {
  Random random(3);
  int pairs = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const scene::CameraFrame camera = tests::random_camera(random);
    const scene::Box box = random_box(random, camera.eye);
    for (const glm::dvec3& axis : {camera.right, camera.up, camera.forward}) {
      for (const double side : {-1.0, 1.0}) {
        const auto plane = fit_shadow_plane(sun(side * axis), camera, box, k_size);
        ASSERT_TRUE(plane);
        pairs += expect_occluders_on_map(random, sun(side * axis), camera, box, *plane);
      }
    }
    if (HasFailure()) FAIL() << "trial " << trial;
  }
  EXPECT_GT(pairs, 10000);
}

/// Of a unit box, 5 m ahead of a camera that sees all of it.
const scene::CameraFrame k_camera{.eye = {0, 0, 5},
                                  .right = {1, 0, 0},
                                  .up = {0, 1, 0},
                                  .forward = {0, 0, -1},
                                  .half_width = 0.5,
                                  .half_height = 0.5};
const scene::Box k_box{.lower = glm::vec3(-0.5f), .upper = glm::vec3(0.5f)};

TEST(ShadowPlane, IsNoLargerThanABoxThatIsSeen) {
  for (const scene::Light& light : {sun({0.3, 1, 0.2}), sun({0, 1, 0}), lamp({10, 20, 30})}) {
    const auto plane = fit_shadow_plane(light, k_camera, k_box, k_size);
    ASSERT_TRUE(plane);
    const shaders::LightBlock block = light_block(light, k_camera.eye, 0.0f, k_size, plane);
    glm::dvec2 lower(1.0), upper(-1.0);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 at(corner & 1, corner >> 1 & 1, corner >> 2);
      const OnMap on = on_map(block, at - 0.5 - k_camera.eye);
      lower = glm::min(lower, on.uv);
      upper = glm::max(upper, on.uv);
    }
    for (int i = 0; i < 2; ++i) {
      // A texel is left free on each side.
      EXPECT_NEAR(lower[i], -1.0 / (1.0 + 2.0 / k_size), 1e-4);
      EXPECT_NEAR(upper[i], 1.0 / (1.0 + 2.0 / k_size), 1e-4);
    }
    // Where light rays cross the plane through the eye, a texel is that large.
    const glm::dvec3 across = glm::normalize(glm::dvec3(plane->image_x));
    const OnMap step = on_map(block, 2.0 * plane->half_texel * across), eye = on_map(block, glm::dvec3(0.0));
    EXPECT_LE(step.uv.x - eye.uv.x, 2.0 / k_size * 20.0);
    EXPECT_GE(step.uv.x - eye.uv.x, 2.0 / k_size * 0.999);
  }
}

TEST(ShadowPlane, IsForLightsFarFromWhatTheyShade) {
  const auto has_plane = [](glm::dvec3 light) {
    return fit_shadow_plane(lamp(light), k_camera, k_box, k_size).has_value();
  };
  EXPECT_TRUE(has_plane({0, 100, 0}));
  EXPECT_TRUE(has_plane({0, 30, 30}));
  EXPECT_FALSE(has_plane({0, 0, -0.4})) << "in the box";
  EXPECT_FALSE(has_plane({0, 0, 3})) << "between eye and box";
  EXPECT_FALSE(has_plane({0, 0, -2})) << "just behind the box";
  EXPECT_TRUE(has_plane({0, 0, -20}));
}

TEST(ShadowPlane, OfNothingHasFiniteNumbers) {
  const auto plane = fit_shadow_plane(sun({0, 1, 0}), k_camera, scene::Box(), k_size);
  ASSERT_TRUE(plane);
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(std::isfinite(plane->image_x[i]));
    EXPECT_TRUE(std::isfinite(plane->image_y[i]));
  }
  EXPECT_TRUE(std::isfinite(plane->depth_scale));
  EXPECT_TRUE(std::isfinite(plane->depth_offset));
  EXPECT_GT(plane->half_texel, 0.0);
}

TEST(ShadowPlane, LeavesOutWhatCannotShadeWhatIsSeen) {
  const auto plane = fit_shadow_plane(sun({0, 1, 0}), k_camera, k_box, k_size);
  ASSERT_TRUE(plane);
  const auto touches = [&](glm::vec3 point) {
    scene::Box speck;
    speck.include(point);
    return plane->may_touch(speck);
  };
  EXPECT_TRUE(touches({0, 0, 0}));
  EXPECT_TRUE(touches({0, 100, 0})) << "high above";
  EXPECT_FALSE(touches({0, -100, 0})) << "below, away from the sun";
  EXPECT_FALSE(touches({0, 0, 6})) << "behind the camera";
  EXPECT_FALSE(touches({5, 0, 0})) << "beside what it sees";
}

}  // namespace
}  // namespace airlight::frame
