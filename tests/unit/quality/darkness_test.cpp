#include "quality/darkness.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/builtin.h"

namespace airlight::quality {
namespace {

using testing::HasSubstr;

constexpr const char* k_unknown = "whatever is seen lies in shadow, or neither reflects nor scatters";

/// An eye 5 m from a unit sphere.
scene::View view_of(const scene::Light& light) {
  scene::View view;
  view.camera.eye = {0.0, 0.0, 5.0};
  view.lights = {light};
  return view;
}

const scene::Geometry& sphere() {
  static const scene::Geometry geometry = scene::find_builtin("sphere")->make().geometry;
  return geometry;
}

TEST(WhyBlack, TellsOfASunWithoutIrradiance) {
  EXPECT_EQ(why_black(sphere(), view_of(scene::sun("", {0, 1, 0}, glm::vec3(0.0f)))),
            "the light's irradiance is 0");
}

TEST(WhyBlack, ASunIsDimmedByALayerAboveTheEyeAlone) {
  scene::View view = view_of(scene::sun("", {0, 1, 0}, glm::vec3(1.0f)));
  view.medium.sigma_a = glm::vec3(1e3f);
  EXPECT_EQ(why_black(sphere(), view), k_unknown) << "its own path has no length";
  view.medium.top = 7.0;
  EXPECT_THAT(why_black(sphere(), view), HasSubstr("is shorter than 7 m in the medium"));
  view.medium.top = -7.0;
  EXPECT_EQ(why_black(sphere(), view), k_unknown) << "the eye is above it";
}

TEST(WhyBlack, ALampIsDimmedByWhatALayerHoldsOfThePath) {
  scene::View view = view_of(scene::point_light("", {0, 0, 105}, glm::vec3(1.0f)));
  view.medium.sigma_a = glm::vec3(10.0f);
  EXPECT_THAT(why_black(sphere(), view), HasSubstr("is shorter than 100 m in the medium"));
  view.medium.top = 20.0;
  EXPECT_THAT(why_black(sphere(), view), HasSubstr("is shorter than 40 m in the medium"));
  view.medium.top = 0.0;
  EXPECT_EQ(why_black(sphere(), view), k_unknown);
}

constexpr const char* k_out_of_reach = "nothing that is seen lies within the light's cone and range";

TEST(WhyBlack, TellsOfARangeThatEndsBeforeWhatIsSeen) {
  scene::View view = view_of(scene::point_light("", {0, 0, 8}, glm::vec3(1.0f)));  // behind the eye
  view.lights[0].range = 2.9;
  EXPECT_EQ(why_black(sphere(), view), k_out_of_reach);
  view.lights[0].range = 3.1;
  EXPECT_EQ(why_black(sphere(), view), k_unknown);
  // Above the image's upper edge, which rises by half of 45 degrees.
  view.lights[0].position = {0, 10, 0};
  const double to_edge = 10 * std::cos(glm::radians(22.5)) - 5 * std::sin(glm::radians(22.5));
  view.lights[0].range = to_edge - 0.01;
  EXPECT_EQ(why_black(sphere(), view), k_out_of_reach);
  view.lights[0].range = to_edge + 0.01;
  EXPECT_EQ(why_black(sphere(), view), k_unknown);
}

TEST(WhyBlack, TellsOfASpotThatLooksAway) {
  const auto why = [](glm::dvec3 position, glm::dvec3 axis, double half_angle) {
    scene::View view = view_of(scene::point_light("", position, glm::vec3(1.0f)));
    view.lights[0].cone = {.axis = glm::normalize(axis), .outer = glm::radians(half_angle)};
    return why_black(sphere(), view);
  };
  EXPECT_EQ(why({0, 0, 6}, {0, 0, 1}, 90), k_out_of_reach) << "behind the eye";
  EXPECT_EQ(why({0, 0, 4}, {0, 0, -1}, 90), k_unknown) << "its back to the eye";
  EXPECT_EQ(why({0, 20, 0}, {0, 1, 0}, 60), k_out_of_reach) << "above the image, upwards";
  EXPECT_EQ(why({0, 20, 0}, {0, 1, 0}, 75), k_unknown) << "wider, it meets what rises in the image";
  EXPECT_EQ(why({0, 20, 0}, {0, 1, -3}, 60), k_unknown) << "far off it lights what is seen";
  EXPECT_EQ(why({0, 20, 0}, {0, -1, 0}, 60), k_unknown);
}

TEST(WhyBlack, TellsOfAClosedPartThatHoldsTheEyeUnderASun) {
  for (glm::dvec3 towards : {glm::dvec3(0, 1, 0), glm::dvec3(1, -2, 3), glm::dvec3(-1, 0, 0)}) {
    scene::View view = view_of(scene::sun("", towards, glm::vec3(1.0f)));
    EXPECT_EQ(why_black(sphere(), view), k_unknown);
    view.camera.eye = {0.1, 0.2, 0.3};
    EXPECT_THAT(why_black(sphere(), view), HasSubstr("the eye is inside a closed part"));
  }
}

TEST(WhyBlack, TellsOfEachOfSeveralLights) {
  scene::View view = view_of(scene::sun("noon", {0, 1, 0}, glm::vec3(0.0f)));
  view.lights.push_back(scene::point_light("far", {0, 0, 105}, glm::vec3(1.0f)));
  EXPECT_EQ(why_black(sphere(), view), k_unknown) << "of one alone there is no reason";
  view.medium.sigma_a = glm::vec3(1.0f);
  EXPECT_THAT(why_black(sphere(), view),
              testing::StartsWith("of light 'noon': the light's irradiance is 0; of light 'far': no path"));
}

TEST(WhyBlack, TellsOfASpotThatShinesElsewhere) {
  scene::View view = view_of(scene::point_light("", {0, 0, 10}, glm::vec3(1.0f)));
  view.lights[0].cone = scene::Cone{.axis = {0, 0, 1}, .inner = 0.0, .outer = 0.5};
  EXPECT_EQ(why_black(sphere(), view), "nothing that is seen lies within the light's cone and range");
}

}  // namespace
}  // namespace airlight::quality
