#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "frame/blocks.h"

namespace airlight::shaders {
#include "frame/epipolar_lines.glsl"
namespace {

struct Case {
  std::string name;
  vec3 axis;  ///< towards the light; the camera looks along −z
  bool is_inside;
};

/// All around the camera, whose image is twice as wide as high, at 90° from top to bottom.
std::vector<Case> cases() {
  return {{"in the middle", {0, 0, -1}, true},
          {"inside", {0.7f, -0.4f, -1}, true},
          {"inside, behind the eye", {-0.7f, 0.4f, 1}, true},
          {"left", {-3, 0.2f, -1}, false},
          {"right", {3, 0.2f, -1}, false},
          {"above", {0.3f, 5, -1}, false},
          {"below", {0.3f, -1.001f, -1}, false},
          {"beyond a corner", {4, 3, -1}, false},
          {"beyond the opposite one, behind the eye", {4, 3, 1}, false},
          {"beside", {1, 0, 0}, false},
          {"beside and above", {-1, 2, 0}, false},
          {"overhead", {0, 1, 0}, false},
          {"nearly overhead", {1e-5f, 1, -1e-6f}, false},
          {"on a side", {-2, 0.3f, -1}, false},
          {"on a corner", {2, 1, -1}, false}};
}

CameraBlock camera() {
  CameraBlock block{};
  block.right = {1, 0, 0};
  block.up = {0, 1, 0};
  block.forward = {0, 0, -1};
  block.half_width = 2;
  block.half_height = 1;
  block.image_width = 200;
  block.image_height = 100;
  return block;
}

/// How far a place is beside the line through two others.
float beside(vec2 from, vec2 to, vec2 place) {
  const vec2 way = to - from, apart = place - from;
  return std::abs(way.x * apart.y - way.y * apart.x) / glm::length(way);
}

TEST(EpipolarLines, EveryPlaceLiesOnTheLineWithItsEnd) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const EpipolarLines lines = epipolar_lines(camera(), glm::normalize(c.axis));
    EXPECT_EQ(lines.is_inside, c.is_inside);
    for (float y = 0.5f; y < 100.0f; y += 3.0f) {
      for (float x = 0.5f; x < 200.0f; x += 3.0f) {
        const vec2 place(x, y);
        const float end = line_end(lines, place);
        ASSERT_GE(end, 0.0f);
        ASSERT_LE(end, 1.0f);
        const EpipolarLine line = line_to(lines, end);
        for (const vec2 point : {line.from, line.to}) {
          ASSERT_TRUE(point.x >= -1e-3f && point.x <= 200.001f && point.y >= -1e-3f && point.y <= 100.001f)
              << point.x << ", " << point.y;
        }
        // On a border where lines run along it, rounding tells one from the next.
        ASSERT_LT(beside(line.from, line.to, place), 1e-2f) << x << ", " << y;
        const float number = sample_beside(line, place, 33);
        ASSERT_LT(glm::distance(sample_place(line, number, 33), place), k_epipole_gap + 1e-2f)
            << x << ", " << y;
      }
    }
  }
}

TEST(EpipolarLines, SlicesGoThroughTheEpipoleAndAreNoFartherApartThanTheirEnds) {
  constexpr uint k_slices = 64;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const EpipolarLines lines = epipolar_lines(camera(), glm::normalize(c.axis));
    const float step = lines.extent / slice_intervals(lines, k_slices);
    EXPECT_LE(lines.extent, border_length(lines.size));
    if (c.is_inside) {
      EXPECT_EQ(lines.extent, border_length(lines.size));
    }
    vec2 last = slice_line(lines, k_slices - 1, k_slices).to;
    for (uint slice = 0; slice < k_slices; ++slice) {
      const EpipolarLine line = slice_line(lines, slice, k_slices);
      if (slice > 0 || c.is_inside) {
        EXPECT_LE(glm::distance(line.to, last), step * 1.001f) << slice;
      }
      last = line.to;
      if (glm::distance(line.from, line.to) < 1.0f) continue;  // cuts a corner of the image
      const vec2 way = line.to - line.from;
      const vec3 epipole = lines.epipole;
      const vec2 towards = vec2(epipole) - epipole.z * line.from;
      // Of the epipole's distance: its own rounding.
      EXPECT_LT(std::abs(way.x * towards.y - way.y * towards.x),
                1e-4f * glm::length(way) * (glm::length(vec2(epipole)) + 200.0f * epipole.z))
          << slice;
      // And the first end is the one next to it.
      if (epipole.z > 0.0f) {
        EXPECT_GE(glm::dot(way, -towards), -1e-2f) << slice;
      }
    }
  }
}

TEST(EpipolarLines, ThePlaneThatIsSeenIsLinearInTheImage) {
  const CameraBlock block = camera();
  // A floor one metre below the eye.
  const auto distance_at = [&](vec2 place) { return -1.0f / view_ray(block, place).y; };
  const vec2 place(120, 80);
  const SeenPlane plane = seen_plane(block, place, {0, 1, 0}, distance_at(place));
  for (const vec2 other : {vec2(3, 60), vec2(190, 99), vec2(120, 80)}) {
    const float depth = distance_at(other) * glm::dot(view_ray(block, other), block.forward);
    EXPECT_NEAR(inverse_depth_at(plane, other - place), 1.0f / depth, 1e-5f / depth);
  }
  EXPECT_EQ(inverse_depth_at(seen_plane(block, place, {0, 0, 0}, 0), {40, 30}), 0.0f);
}

}  // namespace
}  // namespace airlight::shaders
