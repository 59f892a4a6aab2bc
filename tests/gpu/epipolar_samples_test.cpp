#include "frame/epipolar_samples.h"

#include <cmath>

#include <gtest/gtest.h>

#include "support/render.h"
#include "support/scenes.h"

/// Airlight along listed rays, of epipolar samples and of pixels that these do not serve, against that of all
/// pixels.
namespace airlight {
namespace {

using frame::ViewRays;
using frame::Where;
using Image = std::vector<glm::vec3>;

const ViewRays k_samples = {.where = Where::epipolar, .slices = 128, .samples = 96};

media::Vsv make_vsv(const ViewRays& rays, int theta = 512) {
  return {tests::gpu_context(), {.rays = rays, .volume = {.resolution = {256, theta, 512}}}};
}

struct Rendered {
  Image airlight;
  std::uint32_t rays;
};

/// Counts the listed rays of the last light.
class RayCounter : public frame::Airlight {
 public:
  explicit RayCounter(frame::Airlight& airlight) : airlight_(airlight) {}
  void integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) override {
    airlight_.integrate(inputs, radiance);
    count = inputs.listed ? inputs.listed->count() : 0;
  }
  ViewRays rays() const override { return airlight_.rays(); }

  std::uint32_t count = 0;

 private:
  frame::Airlight& airlight_;
};

Rendered render(frame::Frame& frame, const scene::View& view, frame::Airlight& airlight) {
  RayCounter counter(airlight);
  frame::NoShadow no_shadow;
  gpu::StageTimer timer(nullptr);
  frame.render(view, no_shadow, counter, timer);
  return {frame.read().airlight, counter.count};
}

Rendered render_vsv(const scene::Geometry& geometry, const scene::View& view, const ViewRays& rays) {
  frame::Frame frame(tests::gpu_context(), geometry, 512);
  media::Vsv vsv = make_vsv(rays);
  return render(frame, view, vsv);
}

Rendered render_march(const scene::Geometry& geometry, const scene::View& view, const ViewRays& rays) {
  frame::Frame frame(tests::gpu_context(), geometry, 512);
  media::March march(tests::gpu_context(), {.steps = 64, .rays = rays});
  return render(frame, view, march);
}

scene::View view_of_lights(std::vector<scene::Light> lights) {
  scene::View view;
  view.camera.eye = {0, 0, 6};
  view.camera.target = {0, 0, 0};
  view.lights = std::move(lights);
  view.medium.sigma_s = glm::vec3(0.05f);
  view.size = {117, 80};
  return view;
}

struct Placed {
  const char* name;
  scene::Light light;
};

/// In the image, beside it on each side, behind the camera, and where its epipolar lines are parallel.
std::vector<Placed> lights() {
  const auto lamp = [](glm::dvec3 position) { return scene::point_light("", position, glm::vec3(10.0f)); };
  scene::Light spot = lamp({-2, 2, 0});
  spot.cone = scene::Cone{.axis = glm::normalize(glm::dvec3(1, -1, 0)), .inner = 0.2, .outer = 0.5};
  return {{"lamp in the image", lamp({0.83, 0.41, 0})},
          {"lamp above", lamp({0.5, 7, 0})},
          {"lamp to the left", lamp({-9, 0.3, 1})},
          {"lamp beyond a corner", lamp({7, -6, 1})},
          {"lamp behind", lamp({0.4, -0.3, 9})},
          {"lamp behind and beside", lamp({9, 3, 8})},
          {"lamp beside the eye", lamp({4, 0, 6})},
          {"lamp overhead", lamp({0, 3, 6})},
          {"sun in the image", scene::sun("", {0.1, 0.2, -1}, glm::vec3(1.0f))},
          {"sun behind", scene::sun("", {0.3, 0.5, 1}, glm::vec3(1.0f))},
          {"sun overhead", scene::sun("", {0, 1, 0}, glm::vec3(1.0f))},
          {"spot", spot}};
}

/// A plate above a floor that reaches far.
scene::Geometry plate_above_floor() {
  scene::Geometry geometry;
  tests::add_triangle(geometry, {-3, -4, 4}, {0.7f, -4, 4}, {-0.6f, 4, 4});
  tests::add_triangle(geometry, {-3, -4, 4}, {-0.6f, 4, 4}, {-3, 4, 4});
  tests::add_quad(geometry, {-100, -8, 20}, {200, 0, 0}, {0, 0, -200});
  return geometry;
}

// Without shadows airlight is smooth, wherever its epipolar lines lead.
TEST(EpipolarSamples, ServeWhatIsSmooth) {
  for (const Placed& placed : lights()) {
    const scene::View view = view_of_lights({placed.light});
    const Rendered pixels = render_vsv({}, view, {});
    const Rendered samples = render_vsv({}, view, k_samples);
    EXPECT_EQ(pixels.rays, 0u);
    EXPECT_LT(samples.rays, 117u * 80u / 2u) << placed.name;
    // Samples are marked until what lies between is within 0.3 % of linear; the spot's cone, which that does
    // not know of, is sampled at every fourth of them, three pixels apart.
    EXPECT_LT(tests::error_of(samples.airlight, pixels.airlight).rrmse, placed.light.cone ? 0.02 : 0.003)
        << placed.name;
  }
}

// Both sides of a break of depth are asked, and take from their own.
TEST(EpipolarSamples, DoNotMixWhatIsNearWithWhatIsFar) {
  const scene::Geometry geometry = plate_above_floor();
  for (const Placed& placed : lights()) {
    const scene::View view = view_of_lights({placed.light});
    const Image pixels = render_vsv(geometry, view, {}).airlight;
    const Image samples = render_vsv(geometry, view, k_samples).airlight;
    // The plate's shadow has edges that run along slices, which are up to three pixels apart.
    EXPECT_LT(tests::error_of(samples, pixels).rrmse, 0.04) << placed.name;
  }
}

// Shadows of many occluders, in half-planes that no pixel's ray may look into.
TEST(EpipolarSamples, KeepShafts) {
  const scene::Scene& scene = tests::builtin("spheres");
  scene::View view = tests::view_of(scene, {128, 96});
  const Image pixels = render_vsv(scene.geometry, view, {}).airlight;
  const Image samples = render_vsv(scene.geometry, view, k_samples).airlight;
  // Shafts' edges, softened between slices up to 3.5 pixels apart.
  EXPECT_LT(tests::error_of(samples, pixels).rrmse, 0.02);
  const auto marched = [&](const ViewRays& rays) {
    return render_march(scene.geometry, view, rays).airlight;
  };
  // And march's bands, which differ from ray to ray.
  EXPECT_LT(tests::error_of(marched(k_samples), marched({})).rrmse, 0.02);
}

// Bars as thin as a pixel before a bright sky: what a coarse image loses.
TEST(EpipolarSamples, KeepThinBars) {
  scene::Geometry geometry;
  for (int i = -20; i <= 20; ++i)
    tests::add_quad(geometry, {0.31f * static_cast<float>(i), -4, 4}, {0.03f, 0, 0}, {0.4f, 8, 0});
  const scene::View view = view_of_lights({scene::point_light("", {1, 2, -3}, glm::vec3(10.0f))});
  const Image pixels = render_vsv(geometry, view, {}).airlight;
  const double coarse =
      tests::error_of(render_vsv(geometry, view, {.where = Where::half}).airlight, pixels).rrmse;
  const Rendered samples =
      render_vsv(geometry, view, {.where = Where::epipolar, .slices = 40, .samples = 64});
  EXPECT_GT(coarse, 0.2);
  // What slices up to ten pixels apart miss of the bars' shadows.
  EXPECT_LT(tests::error_of(samples.airlight, pixels).rrmse, coarse / 20.0);
}

// Each pixel sees a square of its own depth: but for those beside a sample that sees as deep a one they are
// asked themselves, and get what they get without samples.
TEST(EpipolarSamples, PixelsThatNoneServesAreAskedThemselves) {
  scene::View view = view_of_lights({scene::point_light("", {0.83, 0.41, 0}, glm::vec3(10.0f))});
  view.size = {96, 64};
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  scene::Geometry geometry;
  for (int y = 0; y < view.size.y; ++y) {
    for (int x = 0; x < view.size.x; ++x) {
      // Those within eight pixels have other depths, by 5 % at least.
      const double depth = 2.0 * std::pow(1.05, (11 * x + 27 * y) % 83);
      const auto corner = [&](int i, int j) {
        return glm::vec3(camera.eye +
                         depth * (camera.forward +
                                  camera.half_width * (2.0 * i / view.size.x - 1.0) * camera.right +
                                  camera.half_height * (1.0 - 2.0 * j / view.size.y) * camera.up));
      };
      tests::add_triangle(geometry, corner(x, y), corner(x + 1, y), corner(x, y + 1));
      tests::add_triangle(geometry, corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1));
    }
  }
  const ViewRays few = {.where = Where::epipolar, .slices = 16, .samples = 32};
  const Image pixels = render_march(geometry, view, {}).airlight;
  const Rendered samples = render_march(geometry, view, few);
  const auto count = static_cast<std::uint32_t>(pixels.size());
  EXPECT_GT(samples.rays, count * 9 / 10);
  std::uint32_t same = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) same += pixels[i] == samples.airlight[i];
  EXPECT_GE(same, samples.rays - 16u * 32u);
}

// In which order the list is made is left to chance.
TEST(EpipolarSamples, DoNotDependOnTheOrderOfTheList) {
  const scene::Scene& scene = tests::builtin("window");
  const scene::View view = tests::view_of(scene, {128, 128});
  frame::Frame frame(tests::gpu_context(), scene.geometry, 512);
  media::Vsv vsv = make_vsv(k_samples);
  const Rendered first = render(frame, view, vsv);
  for (int i = 0; i < 3; ++i) {
    const Rendered again = render(frame, view, vsv);
    EXPECT_TRUE(first.airlight == again.airlight) << i;
    EXPECT_EQ(first.rays, again.rays);
  }
}

// Lights have lists of their own, one after the other, in one frame that has drawn other images before.
TEST(EpipolarSamples, OfLightsAddUp) {
  const scene::Geometry geometry = plate_above_floor();
  const std::vector<Placed> all = lights();
  frame::Frame frame(tests::gpu_context(), geometry, 512);
  media::Vsv vsv = make_vsv(k_samples), of_pixels = make_vsv({});
  scene::View view = view_of_lights({all[0].light, all[4].light, all[9].light});
  view.size = {40, 100};
  render(frame, view, vsv);
  view.size = {117, 80};
  render(frame, view, of_pixels);
  const Rendered together = render(frame, view, vsv);
  Image sum(together.airlight.size());
  std::uint32_t rays = 0;  // of the last one
  for (const scene::Light& light : view.lights) {
    const Rendered alone = render_vsv(geometry, view_of_lights({light}), k_samples);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += alone.airlight[i];
    rays = alone.rays;
  }
  EXPECT_LT(tests::error_of(together.airlight, sum).rrmse, 1e-6);
  EXPECT_EQ(together.rays, rays);
}

TEST(EpipolarSamples, CannotBeGathered) {
  const scene::View view = view_of_lights({lights()[0].light});
  media::MarchOptions options = {.jitter = media::MarchJitter::gathered, .rays = k_samples};
  ASSERT_TRUE(options.refusal(view));
  EXPECT_EQ(options.refusal(view)->where, "jitter=gathered");
  options.jitter = media::MarchJitter::interleaved;
  EXPECT_FALSE(options.refusal(view));
}

}  // namespace
}  // namespace airlight
