#include "frame/coarse_image.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/render.h"
#include "support/scenes.h"

/// Airlight of fewer view rays than there are pixels.
namespace airlight {
namespace {

using frame::Where;

std::vector<glm::vec3> airlight_of(const scene::Geometry& geometry, const scene::View& view, Where where) {
  frame::Frame frame(tests::gpu_context(), geometry, 512);
  media::Vsv vsv(tests::gpu_context(), {.rays = {.where = where}, .volume = {.resolution = {256, 512, 512}}});
  frame::NoShadow no_shadow;
  gpu::StageTimer timer(nullptr);
  frame.render(view, no_shadow, vsv, timer);
  return frame.read().airlight;
}

TEST(CoarseImage, IsAsHighAndNoNarrower) {
  EXPECT_EQ(frame::coarse_size({640, 480}, Where::half), glm::ivec2(320, 240));
  EXPECT_EQ(frame::coarse_size({97, 61}, Where::half), glm::ivec2(50, 31));
  EXPECT_EQ(frame::coarse_size({97, 61}, Where::quarter), glm::ivec2(26, 16));
  EXPECT_EQ(frame::coarse_size({1, 1}, Where::quarter), glm::ivec2(1, 1));
  EXPECT_EQ(frame::coarse_size({97, 61}, Where::pixel), glm::ivec2(97, 61));
}

// A lamp beyond the image's border: between rays airlight is a smooth function, and odd sizes move nothing.
TEST(CoarseImage, ServesWhatIsSmooth) {
  scene::View view;
  view.camera.eye = {0, 0, 6};
  view.camera.target = {0, 0, 0};
  view.lights = {scene::point_light("", {5, 4, 0}, glm::vec3(10.0f)),
                 scene::point_light("", {-6, -3, 1}, glm::vec3(4.0f, 7.0f, 9.0f))};
  view.medium.sigma_s = glm::vec3(0.05f);
  view.size = {157, 101};
  const auto pixels = airlight_of({}, view, Where::pixel);
  // Linear interpolation leaves h² f'' / 8, and pixels beyond the outermost rays take those as they are.
  EXPECT_LT(tests::error_of(airlight_of({}, view, Where::half), pixels).rrmse, 2e-3);
  EXPECT_LT(tests::error_of(airlight_of({}, view, Where::quarter), pixels).rrmse, 6e-3);
}

// A plate before a far wall: airlight jumps at its slanted border, and each side takes from its own.
TEST(CoarseImage, DoesNotMixWhatIsNearWithWhatIsFar) {
  scene::Geometry geometry;
  tests::add_triangle(geometry, {-3, -4, 4}, {0.7f, -4, 4}, {-0.6f, 4, 4});
  tests::add_triangle(geometry, {-3, -4, 4}, {-0.6f, 4, 4}, {-3, 4, 4});
  tests::add_quad(geometry, {-40, -40, -20}, {80, 0, 0}, {0, 80, 0});
  scene::View view;
  view.camera.eye = {0, 0, 6};
  view.camera.target = {0, 0, 0};
  view.lights = {scene::point_light("", {6, 1, 0}, glm::vec3(10.0f))};
  view.medium.sigma_s = glm::vec3(0.05f);
  view.size = {160, 100};
  const auto pixels = airlight_of(geometry, view, Where::pixel);
  const float mean = [&] {
    float sum = 0.0f;
    for (const glm::vec3& pixel : pixels) sum += pixel.y;
    return sum / static_cast<float>(pixels.size());
  }();
  for (const Where where : {Where::half, Where::quarter}) {
    const auto coarse = airlight_of(geometry, view, where);
    // What is not as deep weighs a two-thousandth. But the surface of a coarse ray is that of a pixel half a
    // pixel beside it, so that in each of the border's 100 rows there may be one or two pixels, whose four
    // neighbours all see what is on its other side.
    std::size_t mixed = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
      if (std::abs(coarse[i].y - pixels[i].y) > 0.05f * mean) ++mixed;
    EXPECT_LT(mixed, where == Where::half ? 100u : 200u) << static_cast<int>(where);
  }
}

}  // namespace
}  // namespace airlight
