#include <cmath>
#include <map>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "support/render.h"
#include "support/scenes.h"

/// The error against the converged reference falls as the grid grows along each angle, the others held at
/// their defaults.
namespace airlight {
namespace {

struct Curve {
  const char* scene;
  const char* angle;
  int epipolar::Resolution::*count;
  int first, last;
  double ratio;  ///< of the error at `last` to that at `first`, at most
};

void PrintTo(const Curve& curve, std::ostream* stream) {
  *stream << curve.scene << " " << curve.angle;
}

class Convergence : public testing::TestWithParam<Curve> {
 protected:
  static const tests::Truth& truth(const char* name) {
    static std::map<std::string, tests::Truth> truths;
    const auto kept = truths.find(name);
    if (kept != truths.end()) return kept->second;
    return truths.emplace(name, tests::trace(tests::builtin(name).geometry, view(name))).first->second;
  }
  static scene::View view(const char* name) { return tests::view_of(tests::builtin(name), {64, 64}); }
};

TEST_P(Convergence, ErrorFallsAsTheCountDoubles) {
  const Curve& curve = GetParam();
  const tests::Truth& exact = truth(curve.scene);
  double first = 0.0, before = 1e30;
  for (int count = curve.first; count <= curve.last; count *= 2) {
    tests::VsvSettings settings{.resolution = {512, 2048, 512}, .shadow_map = 2048};
    settings.resolution.*curve.count = count;
    const double rrmse =
        tests::error_of(tests::render_vsv(tests::builtin(curve.scene).geometry, view(curve.scene), settings),
                        exact)
            .rrmse;
    RecordProperty(curve.angle + std::to_string(count), std::to_string(rrmse));
    if (first == 0.0) first = rrmse;
    // Near the floor that the other counts set, an error may rise by chance.
    EXPECT_LT(rrmse, 1.05 * before + 1e-4) << count;
    before = rrmse;
  }
  EXPECT_LT(before, curve.ratio * first);
}

// In `window` the shadows are cut by thin bars far from the eye: φ and θ set the error, and α hardly matters.
INSTANTIATE_TEST_SUITE_P(
    Curves, Convergence,
    testing::Values(Curve{"window", "alpha", &epipolar::Resolution::alpha, 64, 512, 1.0},
                    Curve{"window", "theta", &epipolar::Resolution::theta, 64, 2048, 0.25},
                    Curve{"window", "phi", &epipolar::Resolution::phi, 128, 1024, 0.35},
                    Curve{"cornell", "alpha", &epipolar::Resolution::alpha, 64, 512, 0.4},
                    Curve{"cornell", "theta", &epipolar::Resolution::theta, 64, 2048, 0.2},
                    Curve{"cornell", "phi", &epipolar::Resolution::phi, 128, 1024, 0.5}));

struct Agreement {
  const char* scene;
  double rrmse, p99;
};

void PrintTo(const Agreement& agreement, std::ostream* stream) {
  *stream << agreement.scene;
}

class Accuracy : public testing::TestWithParam<Agreement> {};

TEST_P(Accuracy, OfEveryIntegralAtTheDefaultResolution) {
  const Agreement& expected = GetParam();
  const scene::Scene& scene = tests::builtin(expected.scene);
  const scene::View view = tests::view_of(scene, {96, 96});
  const tests::Truth truth = tests::trace(scene.geometry, view);
  std::vector<std::vector<glm::vec3>> images;
  for (media::VsvIntegral integral :
       {media::VsvIntegral::table, media::VsvIntegral::riemann, media::VsvIntegral::quadrature}) {
    const tests::VsvSettings settings{
        .resolution = {512, 2048, 512}, .integral = integral, .shadow_map = 2048};
    const frame::FrameImages image = tests::render_vsv(scene.geometry, view, settings);
    const auto error = tests::error_of(image, truth);
    const std::string name = tests::name_of(integral);
    RecordProperty(name, std::to_string(error.rrmse) + ", bias " + std::to_string(error.bias) + ", p99 " +
                             std::to_string(error.p99));
    // Each change of visibility is misplaced by up to half a cell of φ, of α (rounding of the occluder), or
    // of θ (the neighbouring half-plane's shadow), and by half a texel of the shadow map.
    EXPECT_LT(error.rrmse, expected.rrmse) << name;
    EXPECT_LT(error.p99, expected.p99) << name;
    // The roundings go either way.
    EXPECT_LT(std::abs(error.bias), 2e-3) << name;
    images.push_back(image.airlight);
  }
  // The same bits, summed by cells or taken from the table: where a ray ends within a cell, the sum counts it
  // whole or not.
  EXPECT_LT(tests::error_of(images[0], images[1]).rrmse, 4e-3);
  // The same runs, from a table that is interpolated, or by panels.
  EXPECT_LT(tests::error_of(images[0], images[2]).rrmse, 4e-4);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Accuracy,
                         testing::Values(Agreement{"window", 0.016, 0.06}, Agreement{"cornell", 0.003, 0.01},
                                         Agreement{"sphere", 0.003, 0.01},
                                         Agreement{"half-space", 0.002, 0.005}));

/// Of a scene with all of its lights, as `render` shows it.
struct Picture {
  const char* scene;
  double rrmse;
};

void PrintTo(const Picture& picture, std::ostream* stream) {
  *stream << picture.scene;
}

class Pictures : public testing::TestWithParam<Picture> {};

TEST_P(Pictures, AreThoseOfTheReference) {
  const Picture& picture = GetParam();
  const scene::Scene& scene = tests::builtin(picture.scene);
  scene::View view = tests::view_of(scene, {64, 36});
  view.lights = scene.lights;
  tests::Truth truth = tests::trace(scene.geometry, view);
  for (std::size_t light = 1; light < view.lights.size(); ++light) {
    const auto one = reference::Reference(scene.geometry, view, light).exact().radiance;
    for (std::size_t i = 0; i < one.size(); ++i) truth.airlight.radiance[i] += one[i];
  }
  // Where leaves and ropes are no thicker than pixels, more of these are at silhouettes.
  const auto error = tests::error_of(tests::render_vsv(scene.geometry, view), truth, 0.015);
  RecordProperty(picture.scene, std::to_string(error.rrmse) + ", bias " + std::to_string(error.bias));
  // As above, of changes of visibility by the dozen in each view ray; and what is thinner than a texel of the
  // shadow map is hit or missed.
  EXPECT_LT(error.rrmse, picture.rrmse);
  EXPECT_LT(std::abs(error.bias), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Pictures,
                         testing::Values(Picture{"forest", 0.08}, Picture{"jali", 0.04},
                                         Picture{"lighthouse", 0.04}, Picture{"harbour", 0.02}));

TEST(LitRuns, GoOnBeyondTheLastCellOfAHalfPlane) {
  // A screen under open sky: half-planes that meet it have no cells beyond its edge, and their last ones are
  // dark.
  scene::Geometry screen;
  tests::add_quad(screen, {-0.5f, -0.5f, -1}, {1, 0, 0}, {0, 1, 0.2f});
  scene::View view;
  view.camera.eye = {0.3, 0.4, 3};
  view.camera.target = {0, 0, -1};
  view.lights[0] = scene::point_light("", {0.2, 0.1, -3}, {3, 2, 1});
  view.size = {48, 48};
  const tests::Truth truth = tests::trace(screen, view);
  for (const media::VsvIntegral integral : {media::VsvIntegral::table, media::VsvIntegral::quadrature}) {
    const auto error = tests::error_of(tests::render_vsv(screen, view, {.integral = integral}), truth);
    EXPECT_LT(error.rrmse, 3e-3) << tests::name_of(integral);
    RecordProperty(tests::name_of(integral), std::to_string(error.rrmse));
  }
}

}  // namespace
}  // namespace airlight
