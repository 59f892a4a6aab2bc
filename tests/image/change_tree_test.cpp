#include "epipolar/change_tree.h"

#include <ostream>

#include <gtest/gtest.h>

#include "quality/measure.h"
#include "scene/error.h"
#include "support/open_room.h"
#include "support/render.h"

/// Airlight from a tree of changes, and from the bits of a grid with as many rows of α as its numbers tell
/// apart: the same.
namespace airlight {
namespace {

using epipolar::Populate;
using epipolar::Query;
using media::VsvIntegral;

struct Case {
  const char* name;
  scene::View view;
  Populate populate = Populate::shadow_map;
  VsvIntegral integral = VsvIntegral::automatic;
  int phi = 128;
  bool has_plates = false;
};
void PrintTo(const Case& of, std::ostream* stream) {
  *stream << of.name;
}

std::vector<Case> cases() {
  const scene::View in_view = tests::open_room_with_lamp_at({0.3, 0.5, -0.2}),
                    aside = tests::open_room_with_lamp_at({4, 3, 1});
  const scene::View behind = tests::open_room_with_lamp_at({0.4, 0.9, 4}),
                    sun = tests::open_room_lit_by(scene::sun("", {0.5, 1, 0.3}, glm::vec3(5)));
  return {{"lamp_in_view", in_view},
          {"lamp_aside", aside},
          {"lamp_behind", behind},
          {"sun", sun},
          {"quadrature", in_view, Populate::shadow_map, VsvIntegral::quadrature},
          {"conservative", aside, Populate::conservative},
          {"conservative_behind", behind, Populate::conservative, VsvIntegral::quadrature},
          // There, rays end before the first light ray of their half-plane that says anything: dark where the
          // plate looks away from the lamp, and where the eye is in the other one's shadow.
          {"dark_plate", aside, Populate::shadow_map, VsvIntegral::automatic, 128, true},
          {"plate_in_shadow", behind, Populate::shadow_map, VsvIntegral::quadrature, 128, true},
          // Neither is a power of four, and their trees have five levels and six.
          {"phi_384", in_view, Populate::shadow_map, VsvIntegral::automatic, 384},
          {"phi_1152", aside, Populate::shadow_map, VsvIntegral::quadrature, 1152}};
}

class ChangeTreeOf : public ::testing::TestWithParam<Case> {};

TEST_P(ChangeTreeOf, SeesWhatTheBitsSay) {
  const Case& of = GetParam();
  const scene::Geometry geometry = tests::open_room(of.has_plates);
  const auto render = [&](Query query) {
    return tests::render_vsv(geometry, of.view,
                             {.resolution = {epipolar::k_tree_alpha, 24, of.phi},
                              .integral = of.integral,
                              .shadow_map = 256,
                              .populate = of.populate,
                              .query = query});
  };
  const auto bits = render(Query::bits).airlight;
  EXPECT_TRUE(render(Query::tree).airlight == bits);
  // There is shadow in it.
  const auto unshadowed = tests::render_vsv({}, of.view).airlight;
  EXPECT_GT(tests::error_of(unshadowed, bits).rrmse, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Cases, ChangeTreeOf, ::testing::ValuesIn(cases()),
                         [](const auto& of) { return of.param.name; });

std::map<std::string, double> counters(const scene::Geometry& geometry, const scene::View& view,
                                       const std::string& volume) {
  quality::Measurer measurer(tests::gpu_context(), geometry, view, 256, {}, {});
  const auto choices = quality::parse_volumes(volume);
  return measurer.measure(choices[0], quality::parse_surfaces("none")[0], 1).cost.counters;
}

TEST(Counters, SayWhatAViewRayTakes) {
  const scene::View view = tests::open_room_with_lamp_at({0.3, 0.5, -0.2});
  const scene::Geometry geometry = tests::open_room();
  auto bits = counters(geometry, view, "vsv:alpha=65535:theta=24:phi=256");
  auto tree = counters(geometry, view, "vsv:query=tree:theta=24:phi=256");
  EXPECT_GT(bits["changes"], 0.5);
  EXPECT_EQ(tree["changes"], bits["changes"]);
  EXPECT_GT(bits["reads"], 1.0);
  EXPECT_LE(bits["reads"], 2.0);
  // The root, and on each of the three levels below at most one node a change: of those before the ray's end,
  // and of the first one beyond.
  EXPECT_GT(tree["reads"], 1.0);
  EXPECT_LE(tree["reads"], 1.0 + 3.0 * (tree["changes"] + 1.0));
  // Nothing casts a shadow.
  EXPECT_EQ(counters({}, view, "vsv:theta=24:phi=256")["changes"], 0.0);
  EXPECT_EQ(counters({}, view, "vsv:query=tree:theta=24:phi=256")["reads"], 1.0);
  // A row for each texel of a half-plane, of 16 bytes.
  EXPECT_EQ(counters({}, view, "vsv:scan=blocks:theta=24:phi=256")["scanned_bytes"],
            16.0 * 24 * 2 / (65 * 47));
  EXPECT_EQ(counters(geometry, view, "march:steps=24")["look_ups"], 24.0);
  // 9 × 6 tiles of 8 × 8 pixels.
  EXPECT_EQ(counters(geometry, view, "froxel:slices=32:samples=2")["look_ups"], 9.0 * 6 * 32 * 2 / (65 * 47));
}

TEST(ChangeTree, RefusesWhatItCannotServe) {
  const auto message_of = [](const media::VsvOptions& options) {
    try {
      options.validate();
    } catch (const scene::Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const epipolar::VolumeOptions tree{.query = Query::tree};
  EXPECT_EQ(message_of({.volume = tree}), "");
  EXPECT_NE(message_of({.integral = VsvIntegral::riemann, .volume = tree}).find("integral=riemann"),
            std::string::npos);
  EXPECT_NE(message_of({.integral = VsvIntegral::factored, .volume = tree}).find("integral=factored"),
            std::string::npos);
  EXPECT_NE(
      message_of({.volume = {.populate = Populate::screen_space, .query = Query::tree}}).find("populate"),
      std::string::npos);
  EXPECT_NE(message_of({.volume = {.scan = epipolar::Scan::column, .query = Query::tree}}).find("scan"),
            std::string::npos);
  EXPECT_NE(message_of({.volume = {.scan = epipolar::Scan::none}}).find("scan"), std::string::npos);
  EXPECT_NE(message_of({.volume = {.resolution = {1, 1, 131072}, .query = Query::tree}}).find("phi=131072"),
            std::string::npos);
}

}  // namespace
}  // namespace airlight
