#include "quality/truth_cache.h"

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "quality/truth.h"
#include "scene/error.h"
#include "scene/light_texture.h"

namespace airlight::quality {
namespace {

namespace fs = std::filesystem;

class Cache : public testing::Test {
 protected:
  // Tests may run at the same time.
  Cache() : folder_(fs::path(testing::TempDir()) / fmt::format("airlight_truth_cache_{}", getpid())) {
    fs::remove_all(folder_);
    geometry_.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    geometry_.triangles = {{0, 1, 2}};
    geometry_.material_of_triangle = {0};
    geometry_.materials = {{}};
    view_.camera = {"", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 45};
    view_.lights[0].position = {1, 0.2, -3};
    view_.lights.push_back(scene::point_light("", {0, 2, 2}, {1, 2, 3}));
    view_.size = {9, 7};
  }

  /// A frame that shows no surface, which is none of the cache's business.
  frame::SurfacePoints no_points() const {
    const auto pixels = static_cast<std::size_t>(view_.size.x) * static_cast<std::size_t>(view_.size.y);
    return {.triangles = std::vector<std::uint32_t>(pixels),
            .of_light = std::vector(view_.lights.size(), std::vector<glm::vec4>(pixels))};
  }
  Truth trace() {
    SharedReference shared(geometry_, view_, {}, folder_);
    return trace_truth(shared, view_, no_points());
  }
  std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  fs::path folder_;
  scene::Geometry geometry_;
  scene::View view_;
};

TEST_F(Cache, GivesBackEveryBitWithoutTracing) {
  const Truth traced = trace();
  EXPECT_EQ(files(), 3) << "airlight of two lights, and the distances";
  SharedReference shared(geometry_, view_, {}, folder_);
  const Truth kept = trace_truth(shared, view_, no_points());
  EXPECT_EQ(kept.airlight, traced.airlight);
  EXPECT_EQ(kept.distance, traced.distance);
  EXPECT_EQ(kept.figures.ms, traced.figures.ms) << "what it cost when it was traced";
  EXPECT_EQ(kept.figures.bound, traced.figures.bound);
  EXPECT_EQ(kept.figures.shadows_per_pixel, traced.figures.shadows_per_pixel);
  EXPECT_EQ(kept.figures.lit_runs_per_pixel, traced.figures.lit_runs_per_pixel);
  EXPECT_EQ(shared.take_work().kept_ms_of("integrate"), kept.figures.ms);
  EXPECT_EQ(files(), 3);
}

TEST_F(Cache, TellsApartWhateverATruthDependsOn) {
  trace();
  std::ptrdiff_t before = files();
  const auto expect_new = [&](const char* what, const std::function<void()>& change) {
    const scene::Geometry geometry = geometry_;
    const scene::View view = view_;
    change();
    trace();
    EXPECT_GT(files(), before) << what;
    before = files();
    geometry_ = geometry;
    view_ = view;
  };
  expect_new("position", [&] { geometry_.positions[0].x = -1.0000001f; });
  expect_new("triangle", [&] { geometry_.triangles[0] = {1, 2, 0}; });
  expect_new("eye", [&] { view_.camera.eye.z += 1e-15; });
  expect_new("target", [&] { view_.camera.target.x = 1e-3; });
  expect_new("up", [&] { view_.camera.up.x = 0.5; });
  expect_new("field of view", [&] { view_.camera.vertical_fov_degrees = 46; });
  expect_new("size", [&] { view_.size.x = 8; });
  expect_new("light", [&] { view_.lights[1].position.x = 0.1; });
  expect_new("intensity", [&] { view_.lights[0].intensity.y = 2; });
  expect_new("scattering", [&] { view_.medium.sigma_s.z = 0.2f; });
  expect_new("absorption", [&] { view_.medium.sigma_a.z = 0.2f; });
  expect_new("phase function", [&] { view_.medium.phase = scene::PhaseFunction::rayleigh; });
  expect_new("g", [&] { view_.medium.g = 0.1f; });
  // What is none of a lamp's tells lights apart as well; the key is made of all that a light has.
  expect_new("direction", [&] { view_.lights[0].towards = {1, 0, 0}; });
  expect_new("irradiance", [&] { view_.lights[0].irradiance.z = 2; });
  expect_new("Rayleigh's part", [&] { view_.medium.rayleigh_weight = 0.1f; });
  expect_new("texture", [&] {
    view_.lights[0].texture =
        std::make_shared<scene::LightTexture>("t", glm::ivec2(1, 1), std::vector<glm::vec3>{glm::vec3(0.5f)});
  });
  expect_new("cone", [&] { view_.lights[0].cone.emplace(); });
  expect_new("range", [&] { view_.lights[0].range = 100; });
  const auto cut_out = [&](std::uint8_t alpha, float least, float place) {
    geometry_.textures = {{{1, 1}, {{0, 0, 0, alpha}}}};
    geometry_.texture_places.assign(geometry_.triangles.size(), {{{place, 0}, {1, 0}, {0, 1}}});
    geometry_.materials[0].cut_out = scene::CutOut{0, least};
  };
  expect_new("what is cut out", [&] { cut_out(200, 0.5f, 0); });
  expect_new("a mask", [&] { cut_out(100, 0.5f, 0); });
  expect_new("its least alpha", [&] { cut_out(200, 0.75f, 0); });
  expect_new("its place", [&] { cut_out(200, 0.5f, 0.5f); });
  expect_new("pose", [&] {
    std::vector<std::uint32_t> of_triangle(geometry_.triangles.size(), 1);
    view_.pose.objects = std::make_shared<const scene::Objects>(scene::Objects{{"all"}, of_triangle});
    view_.pose.motions.emplace_back().matrix[3].x = 1e-3;
  });
  SharedReference refined(geometry_, view_, {}, folder_);
  refined.exact(0, 2);
  EXPECT_EQ(files(), before + 1) << "refinement";
}

TEST_F(Cache, ADamagedFileIsAnErrorThatNamesIt) {
  trace();
  fs::path file;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    file = entry.path();
    fs::resize_file(file, fs::file_size(file) / 2);
  }
  try {
    trace();
    FAIL() << "an error was expected";
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, scene::ExitCode::bad_file);
    EXPECT_THAT(error.what(), testing::HasSubstr(folder_.string()));
  }
}

TEST_F(Cache, AFileUnderAnothersNameIsRefused) {
  trace();
  std::vector<fs::path> all;
  for (const auto& entry : fs::directory_iterator(folder_)) all.push_back(entry.path());
  for (const fs::path& file : all)
    if (file != all[0]) fs::copy_file(all[0], file, fs::copy_options::overwrite_existing);
  EXPECT_THROW(trace(), scene::Error);
}

TEST_F(Cache, AFolderThatCannotBeMadeIsNamed) {
  folder_ = "/dev/null/cache";
  EXPECT_THROW(trace(), scene::Error);
}

TEST(Truth, OfTwoLightsIsTheSumOfTheirs) {
  scene::Geometry geometry;
  geometry.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  geometry.triangles = {{0, 1, 2}};
  scene::View view;
  view.camera = {"", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 45};
  view.lights = {scene::point_light("", {1, 0, -3}, glm::vec3(1.0f)),
                 scene::point_light("", {0, 2, 2}, {1, 2, 3})};
  view.size = {9, 7};
  SharedReference both(geometry, view, {});
  // Each pixel shows the same point of the triangle, z = 0, behind which the first light is.
  const auto points_of = [&](const scene::View& seen) {
    frame::SurfacePoints points{.triangles = std::vector<std::uint32_t>(9 * 7, 1), .of_light = {}};
    for (const scene::Light& light : seen.lights)
      points.of_light.emplace_back(9 * 7, glm::vec4(-light.position, 1.0));
    return points;
  };
  const Truth sum = trace_truth(both, view, points_of(view));
  std::vector<glm::vec3> expected(9 * 7, glm::vec3(0.0f));
  for (const scene::Light& light : view.lights) {
    scene::View alone = view;
    alone.lights = {light};
    SharedReference one(geometry, alone, {});
    const Truth truth = trace_truth(one, alone, points_of(alone));
    for (std::size_t i = 0; i < expected.size(); ++i) expected[i] += truth.airlight[i];
  }
  EXPECT_EQ(sum.airlight, expected);
  using reference::Verdict;
  const reference::SurfaceVerdict dark{Verdict::dark, true}, lit{Verdict::lit, true};
  EXPECT_EQ(sum.verdicts, (std::vector{SurfaceVerdicts(9 * 7, dark), SurfaceVerdicts(9 * 7, lit)}));
}

}  // namespace
}  // namespace airlight::quality
