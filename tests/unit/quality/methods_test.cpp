#include "quality/methods.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/error.h"

namespace airlight::quality {
namespace {

using scene::Error;
using scene::ExitCode;
using testing::HasSubstr;

/// What parsing a list of volume methods complains about.
std::string complaint(std::string_view list) {
  try {
    parse_volumes(list, {});
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code, ExitCode::usage);
    return error.what();
  }
  return "none";
}

TEST(MethodSpec, OfOneWordTakesTheCommonSettings) {
  Settings common;
  common.volume.resolution.alpha = 100;
  common.integral = media::VsvIntegral::riemann;
  const std::vector<VolumeChoice> choices = parse_volumes("vsv", common);
  ASSERT_EQ(choices.size(), 1u);
  EXPECT_EQ(choices[0].spec, "vsv");
  EXPECT_EQ(choices[0].method->name, "vsv");
  EXPECT_EQ(choices[0].settings.volume.resolution.alpha, 100);
  EXPECT_EQ(choices[0].settings.integral, media::VsvIntegral::riemann);
}

TEST(MethodSpec, OwnKeysOverrideTheCommonSettings) {
  Settings common;
  common.volume.resolution = {100, 200, 256};
  const std::vector<VolumeChoice> choices = parse_volumes(
      "vsv:alpha=7:phi=128,vsv:integral=riemann:scan=fused:phi-cells=equal:populate=shadow-map,"
      "reference:samples=33,reference-march:steps=44:rays=single,none",
      common);
  ASSERT_EQ(choices.size(), 5u);
  EXPECT_EQ(choices[0].settings.volume.resolution, (epipolar::Resolution{7, 200, 128}));
  EXPECT_EQ(choices[1].settings.volume.resolution, common.volume.resolution);
  EXPECT_EQ(choices[1].settings.integral, media::VsvIntegral::riemann);
  EXPECT_EQ(choices[1].settings.volume.scan, epipolar::Scan::fused);
  EXPECT_EQ(choices[1].settings.phi_cells, media::PhiCells::equal);
  EXPECT_EQ(choices[2].settings.samples, 33);
  EXPECT_EQ(choices[3].settings.steps, 44);
  EXPECT_EQ(choices[3].settings.rays, reference::RayMode::single);
  EXPECT_EQ(choices[4].method->name, "none");
}

TEST(MethodSpec, MistakesAreNamedWithWhatIsValid) {
  EXPECT_THAT(complaint("fog"), testing::AllOf(HasSubstr("'fog'"), HasSubstr("reference-march")));
  EXPECT_THAT(complaint(""), HasSubstr("''"));
  EXPECT_THAT(complaint("vsv,"), HasSubstr("''"));
  EXPECT_THAT(complaint("vsv:"), HasSubstr("no key ''"));
  EXPECT_THAT(complaint("vsv:steps=3"), testing::AllOf(HasSubstr("'steps'"), HasSubstr("integral")));
  EXPECT_THAT(complaint("vsv:alpha"), HasSubstr("no value"));
  EXPECT_THAT(complaint("vsv:alpha="), HasSubstr("''"));
  EXPECT_THAT(complaint("vsv:alpha=-4"), testing::AllOf(HasSubstr("vsv:alpha=-4"), HasSubstr("'-4'")));
  EXPECT_THAT(complaint("vsv:alpha=4x"), HasSubstr("'4x'"));
  EXPECT_THAT(complaint("vsv:alpha=99999999999"), HasSubstr("'99999999999'"));
  EXPECT_THAT(complaint("vsv:phi=100"), HasSubstr("multiple of 128"));
  EXPECT_THAT(complaint("vsv:theta=many"), HasSubstr("theta"));
  EXPECT_THAT(complaint("vsv:populate=screen-space:scan=fused"), HasSubstr("column"));
  EXPECT_THAT(complaint("vsv:integral=sum"), testing::AllOf(HasSubstr("unknown"), HasSubstr("riemann")));
  EXPECT_THAT(complaint("none:alpha=4"), HasSubstr("it has none"));
  EXPECT_THAT(complaint("vsv,vsv"), HasSubstr("twice"));
}

TEST(MethodSpec, OfSurfacesHasItsOwnMethods) {
  EXPECT_EQ(parse_surfaces("none,shadow-map,vsv:theta=64,reference", {}).size(), 4u);
  EXPECT_THROW(parse_surfaces("reference-march", {}), Error);
  EXPECT_THROW(parse_surfaces("vsv:integral=table", {}), Error);
}

TEST(Registry, EveryKeyOfAMethodExistsAndReadsBackWhatWasSet) {
  for (const VolumeMethod& method : volume_methods()) {
    const VolumeChoice choice{std::string(method.name), &method, {}};
    for (const auto& [name, value] : choice.values()) {
      Settings settings;
      const std::string text = std::holds_alternative<int>(value) ? std::to_string(std::get<int>(value))
                                                                  : std::get<std::string>(value);
      key(name).set(settings, "--" + name, text);
      EXPECT_EQ(key(name).get(settings), value) << method.name << ", " << name;
    }
  }
}

TEST(SharedReference, TracesTheTruthOnceAndChargesForItTwice) {
  scene::Geometry geometry;
  geometry.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  geometry.triangles = {{0, 1, 2}};
  geometry.material_of_triangle = {0};
  geometry.materials = {{}};
  scene::View view;
  view.camera = {"", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 45};
  view.lights[0].position = {1, 2, 3};
  view.size = {8, 8};
  SharedReference shared(geometry, view, {});

  const reference::AirlightImage* image = &shared.converged(16);
  const SharedReference::Work first = shared.take_work();
  EXPECT_GT(first.airlight_rays, 0u);
  EXPECT_EQ(first.kept_airlight_ms, 0.0);
  EXPECT_EQ(&shared.converged(16), image);
  const SharedReference::Work second = shared.take_work();
  EXPECT_EQ(second.airlight_rays, first.airlight_rays);
  EXPECT_EQ(second.kept_airlight_ms, first.airlight_ms);
  EXPECT_NE(&shared.converged(32), image);
  EXPECT_EQ(shared.take_work().kept_airlight_ms, 0.0);

  shared.surfaces();
  EXPECT_EQ(shared.take_work().kept_surface_ms, 0.0);
  shared.surfaces();
  EXPECT_GT(shared.take_work().kept_surface_ms, 0.0);
}

}  // namespace
}  // namespace airlight::quality
