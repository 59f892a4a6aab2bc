#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "reference/shadow_intervals.h"
#include "reference/sun_fog.h"
#include "support/random.h"
#include "support/view_rays.h"
#include "unit/reference/fixtures.h"

/// Shadows from a sun: parallel, from far outside the image too.
namespace airlight::reference {
namespace {

using airlight::tests::Random;
using tests::Crossing, tests::rrmse;

constexpr double k_infinity = std::numeric_limits<double>::infinity();
/// Rounding of images to single precision.
constexpr double k_single = 3e-7;

/// Whether a triangle hides a point from a sun.
Crossing crossing(const Corners& corners, const glm::dvec3& point, const glm::dvec3& sun) {
  const Corners c = {corners[0] - point, corners[1] - point, corners[2] - point};
  const Crossing inside = tests::passes_inside(c, sun);
  const glm::dvec3 n = glm::normalize(normal(c));
  const double along = glm::dot(n, c[0]), facing = glm::dot(n, sun);
  return {inside.hides && along * facing > 0.0,
          std::min({inside.margin, std::abs(along) / glm::length(c[0]), std::abs(facing)})};
}

bool is_lit(const ShadowIntervals& shadows, double t) {
  return std::any_of(shadows.lit_runs().begin(), shadows.lit_runs().end(),
                     [&](const auto& run) { return run.from <= t && t <= run.to; });
}

TEST(SunShadowIntervals, AgreeWithRaysCastOneByOne) {
  Random random(1);
  int shadowed = 0, lit = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const glm::dvec3 sun = random.direction();
    const std::vector<Corners> triangles = tests::random_triangles(random, 4.0);
    Occluders occluders(sun);
    for (const Corners& corners : triangles) occluders.add(corners);
    const double distance = trial % 2 == 0 ? 0.0 : random.logarithmic(0.1, 10.0);
    const SunRay ray = make_sun_ray(sun, random.direction(), {1, 0, 0}, distance, 1e-6, {});
    ShadowIntervals shadows;
    shadows.trace(ray, occluders);
    for (int sample = 0; sample < 200; ++sample) {
      const double t = random.uniform() * std::min(ray.to, 10.0);
      const auto [hidden, margin] = tests::crossing_of_all(
          triangles, [&](const Corners& corners) { return crossing(corners, t * ray.w, sun); });
      if (margin < 1e-11) continue;  // neither can know
      EXPECT_EQ(is_lit(shadows, t), !hidden) << trial << " " << t;
      ++(hidden ? shadowed : lit);
    }
  }
  EXPECT_GT(shadowed, 3000);
  EXPECT_GT(lit, 10000);
}

TEST(SunShadowIntervals, AClosedSurfaceAroundTheRayLeaksNothing) {
  // Every other half-plane holds an edge of the sphere, or passes through a corner.
  scene::Geometry mesh;
  tests::add_sphere(mesh, {0, 0, 0}, 1.0f, 24);
  const Triangles sphere(mesh);
  Random random(3);
  ShadowIntervals shadows;
  for (int trial = 0; trial < 2000; ++trial) {
    const Corners around_centre =
        sphere.around({0, 0, 0}, random.bits() % static_cast<std::uint32_t>(sphere.count()));
    const glm::dvec3 eye = trial % 4 == 0 ? glm::dvec3(0.0) : random.in_box(0.5);
    const glm::dvec3 sun = trial % 2 == 0 ? glm::normalize(around_centre[0] - eye) : random.direction();
    const glm::dvec3 direction = trial % 2 == 0 ? glm::normalize(around_centre[1] - eye) : random.direction();
    Occluders occluders(sun);
    for (std::uint32_t i = 0; i < sphere.count(); ++i) occluders.add(sphere.around(eye, i));
    // As far as the sphere inside the facets reaches.
    const double inner = 0.99, along = glm::dot(eye, direction);
    const double distance = -along + std::sqrt(along * along + inner * inner - glm::dot(eye, eye));
    const SunRay ray = make_sun_ray(sun, direction, {1, 0, 0}, distance, 1e-6, {});
    shadows.trace(ray, occluders);
    EXPECT_TRUE(shadows.lit_runs().empty()) << trial;
  }
}

TEST(SunShadowIntervals, AreNoneOfATriangleAlongTheLight) {
  const glm::dvec3 sun = glm::normalize(glm::dvec3(0.5, 1.0, -0.25)), across(-0.5, 0.125, 1.0);
  for (double aside : {0.0, 0.3, 1.0}) {
    Occluders occluders(sun);
    const glm::dvec3 corner = glm::dvec3(0, 0, -2) - aside * across;
    occluders.add({corner, corner + 3.0 * sun, corner + across});
    EXPECT_EQ(occluders.count(), 0u);
  }
  Occluders occluders(sun);
  occluders.add({glm::dvec3(-1, 1, -2), glm::dvec3(1, 1, -2), glm::dvec3(0, 1, -3)});
  EXPECT_EQ(occluders.count(), 1u);
}

const glm::dvec3 k_eye(0.5, 1.0, 2.0);

/// A level view along −Z, one pixel, the sun ahead and up in its plane: what hangs h over the ray casts its
/// shadow 4/3 h nearer.
scene::View level_view(std::optional<double> top) {
  scene::View view;
  view.camera.eye = k_eye;
  view.camera.target = k_eye - glm::dvec3(0, 0, 1);
  view.camera.vertical_fov_degrees = 0.01;
  view.lights[0] = scene::sun("sun", {0.0, 0.6, -0.8}, {2, 3, 5});
  view.medium.sigma_s = {0.02f, 0.1f, 0.3f};
  view.medium.top = top;
  view.size = {1, 1};
  return view;
}

/// The airlight of the lit part of a level view's ray.
glm::dvec3 expected_radiance(const scene::View& view, double t_from, double t_to) {
  const glm::dvec3 sigma(view.medium.sigma_s);
  const double down = view.medium.top ? (*view.medium.top - k_eye.y) / 0.6 : 0.0;
  glm::dvec3 radiance;
  for (int channel = 0; channel < 3; ++channel) {
    radiance[channel] =
        static_cast<double>(view.lights[0].irradiance[channel]) / (4 * std::numbers::pi) *
        (std::exp(-sigma[channel] * (t_from + down)) - std::exp(-sigma[channel] * (t_to + down)));
  }
  return radiance;
}

void expect_radiance(const AirlightImage& image, const glm::dvec3& expected, double tolerance) {
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(static_cast<double>(image.radiance[0][channel]) / expected[channel], 1.0, tolerance)
        << "channel " << channel;
  }
}

TEST(SunOccluders, ALidShadowsTheRayBetweenItsEdges) {
  // In the fog, over it, and in front of the first of the ray that it can shadow.
  for (const std::optional<double> top : {std::optional<double>(), std::optional(2.5), std::optional(8.0)}) {
    for (double height : {0.75, 3.0, 60.0}) {
      const scene::View view = level_view(top);
      const double shift = height * 0.8 / 0.6, from = 1.5, to = 4.0;
      scene::Geometry lid;
      tests::add_quad(lid, glm::vec3(0, k_eye.y + height, k_eye.z - shift - from), {1, 0, 0},
                      {0, 0, static_cast<float>(from - to)});
      const glm::dvec3 expected =
          expected_radiance(view, 0.0, from) + expected_radiance(view, to, k_infinity);
      const Reference reference(lid, view);
      // The lid's corners are single precision.
      const double corner = 1e-7 * shift;
      expect_radiance(reference.exact(), expected, k_single + corner);
      EXPECT_EQ(reference.exact().lit_runs_per_pixel, 2.0);
      const AirlightImage sampled = reference.sampled(64);
      expect_radiance(sampled, expected, 1e-5 + corner);
      EXPECT_EQ(sampled.self_error, 0.0);
      for (RayMode mode : {RayMode::packet, RayMode::single}) {
        const AirlightImage march = reference.march(1000, mode);
        expect_radiance(march, expected, 3e-3);  // a step
        EXPECT_EQ(march.rays, 1000u);
      }
    }
  }
}

TEST(SunOccluders, BelowTheRayOrBehindItsShadowAreNone) {
  const scene::View view = level_view(8.0);
  const glm::dvec3 expected = expected_radiance(view, 0.0, k_infinity);
  for (const glm::vec3 at : {glm::vec3(0, -1, -1), glm::vec3(0, 2, 2), glm::vec3(3, 2, -1)}) {
    scene::Geometry lid;
    tests::add_quad(lid, at, {1, 0, 0}, {0, 0, -0.5f});
    const Reference reference(lid, view);
    expect_radiance(reference.exact(), expected, k_single);
    expect_radiance(reference.sampled(64), expected, k_single);
    expect_radiance(reference.march(64, RayMode::packet), expected, k_single);
  }
}

TEST(SunOccluders, ALoneSheetAlongTheLightCastsNoShadow) {
  // Walls that hold the view ray and the sun, over the ray, in corners that single precision knows.
  Random random(9);
  for (int trial = 0; trial < 50; ++trial) {
    const auto dyadic = [&] { return glm::round(64.0 * random.direction()) / 64.0; };
    scene::View view = level_view({});
    const glm::dvec3 along = dyadic(), sun = dyadic();
    view.camera.target = k_eye + along;
    view.camera.up = random.direction();
    view.lights[0].towards = glm::normalize(sun);
    scene::Geometry wall;
    tests::add_quad(wall, glm::vec3(k_eye + 0.5 * sun - 4.0 * along), glm::vec3(sun),
                    glm::vec3(16.0 * along));
    const Reference reference(wall, view), empty({}, view);
    EXPECT_EQ(reference.exact().radiance[0], empty.exact().radiance[0]) << trial;
    EXPECT_LT(rrmse(reference.sampled(64), empty.exact()), k_single) << trial;
    EXPECT_LT(rrmse(reference.march(64, RayMode::single), empty.exact()), k_single) << trial;
    EXPECT_LT(rrmse(reference.march(64, RayMode::packet), empty.exact()), k_single) << trial;
  }
}

scene::View clutter_view(int size, std::optional<double> top) {
  scene::View view = tests::clutter_view(size);
  view.lights[0] = scene::sun("sun", {0.35, 0.8, -0.4}, {2, 3, 5});
  view.medium.top = top;
  return view;
}

TEST(SunOccluders, RaysConvergeToTheTruth) {
  for (const std::optional<double> top : {std::optional<double>(), std::optional(0.7)}) {
    const Reference reference(tests::clutter(150), clutter_view(24, top));
    const AirlightImage exact = reference.exact();
    tests::expect_march_converges(reference, exact);
    EXPECT_LT(rrmse(reference.march(100, RayMode::single), reference.march(100, RayMode::packet)), 1e-3);
    const AirlightImage sampled = reference.sampled(1023);
    EXPECT_LT(rrmse(sampled, exact), 1e-3);
    const AirlightImage coarse = reference.sampled(64);
    EXPECT_GT(coarse.self_error, 0.5 * rrmse(coarse, exact));
    EXPECT_GT(coarse.rays, 24u * 24u);
  }
}

/// The image with every triangle looked at for every pixel.
AirlightImage without_hierarchy(const scene::Geometry& geometry, const scene::View& view) {
  const glm::dvec3 sun = view.lights[0].towards;
  const Triangles triangles(geometry);
  Occluders occluders(sun);
  for (std::uint32_t i = 0; i < triangles.count(); ++i) occluders.add(triangles.around(view.camera.eye, i));
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  const SurfaceImage surfaces = Reference(geometry, view).surfaces();
  const std::optional<double> eye_y =
      view.medium.top ? std::optional(view.camera.eye.y - *view.medium.top) : std::nullopt;
  AirlightImage image;
  ShadowIntervals shadows;
  for (std::size_t pixel = 0; pixel < surfaces.distance.size(); ++pixel) {
    const SunRay ray = make_sun_ray(sun, airlight::tests::pixel_ray(camera, view.size, pixel), camera.right,
                                    static_cast<double>(surfaces.distance[pixel]),
                                    0.5 * camera.half_height / view.size.y, eye_y);
    shadows.trace(ray, occluders);
    const SunFog fog(ray, view.medium, glm::dvec3(view.lights[0].irradiance));
    glm::dvec3 sum(0.0);
    for (const auto& run : shadows.lit_runs()) sum += fog.radiance(run.from, run.to);
    image.radiance.push_back(glm::vec3(sum));
  }
  return image;
}

TEST(SunOccluders, TheHierarchyLeavesNothingOut) {
  scene::Geometry clutter = tests::clutter(500);
  Random random(5);
  for (int i = 0; i < 70000; ++i) {
    const glm::dvec3 centre = random.in_box(2.0);
    tests::add_triangle(clutter, glm::vec3(centre), glm::vec3(centre + random.in_box(0.01)),
                        glm::vec3(centre + random.in_box(0.01)));
  }
  for (const std::optional<double> top : {std::optional<double>(), std::optional(1.2)}) {
    scene::View view = clutter_view(10, top);
    const glm::dvec3 sun = view.lights[0].towards;
    const auto expect_same = [&](const char* what) {
      EXPECT_LT(rrmse(Reference(clutter, view).exact(), without_hierarchy(clutter, view)), 2e-6) << what;
    };
    view.camera.eye = {0, 0, 2.6};
    view.camera.target = {0, 0, 0};
    expect_same("across");
    view.camera.eye = {0.1, 0.2, 0.1};
    view.camera.target = view.camera.eye + sun;
    expect_same("the sun in the image");
    view.camera.target = view.camera.eye - sun;
    expect_same("its antipode in the image");
    view.camera.vertical_fov_degrees = 150;
    expect_same("a wide view");
    view.camera.target = view.camera.eye + glm::dvec3(1.0, 0.2, 0.1);
    expect_same("aside, wide");
    view.camera.eye = {0.3, 5.0, 3.0};
    view.camera.target = {0, 0, 0};
    view.camera.vertical_fov_degrees = 45;
    expect_same("from above");
  }
}

TEST(SunOccluders, AClosedBoxAroundTheEyeIsDark) {
  for (const bool is_sphere : {false, true}) {
    scene::Geometry geometry;
    if (is_sphere) {
      tests::add_sphere(geometry, {0.1f, 0.1f, -0.2f}, 10.0f, 100);
    } else {
      tests::add_box(geometry, {-8, -8, -8}, {8, 8, 8});
    }
    for (const glm::dvec3 sun : {glm::dvec3(0.35, 0.8, -0.4), glm::dvec3(0, 1, 0), glm::dvec3(0, 0.6, 0.8)}) {
      scene::View view = clutter_view(32, 3.0);
      view.lights[0].towards = glm::normalize(sun);
      const Reference reference(geometry, view);
      for (const glm::vec3& radiance : reference.exact().radiance) EXPECT_EQ(radiance, glm::vec3(0.0f));
      for (RayMode mode : {RayMode::packet, RayMode::single}) {
        for (const glm::vec3& radiance : reference.march(128, mode).radiance)
          EXPECT_EQ(radiance, glm::vec3(0.0f));
      }
    }
  }
}

TEST(SunOccluders, FarFromTheOriginNothingChanges) {
  // At 2²⁰ m single precision knows eighths of a metre: the geometry is given in those.
  scene::Geometry geometry = tests::clutter(150);
  for (glm::vec3& position : geometry.positions) position = glm::round(position * (32 * 8.0f)) / 8.0f;
  scene::View view = clutter_view(24, 32 * 0.7);
  view.camera.eye *= 32;
  view.medium.sigma_s /= 32;
  const AirlightImage near = Reference(geometry, view).exact();
  const glm::dvec3 offset(1048576, -1048576, 1048576);
  for (glm::vec3& position : geometry.positions) position += glm::vec3(offset);
  view.camera.eye += offset;
  view.camera.target += offset;
  *view.medium.top += offset.y;
  const Reference reference(geometry, view);
  EXPECT_LT(rrmse(reference.exact(), near), 1e-6);
  EXPECT_LT(rrmse(reference.sampled(512), near), 5e-3);
}

TEST(SunOccluders, AFarLampOfItsIrradianceIsTheSun) {
  // In a layer: in endless fog the lamp's own path would dim it away.
  // What casts the shadows is out of sight: first hits are single precision around the lamp.
  scene::Geometry clutter = tests::clutter(150);
  const scene::View view = clutter_view(24, 1.5);
  for (glm::vec3& position : clutter.positions) position += glm::vec3(30.0 * view.lights[0].towards);
  const AirlightImage sun = Reference(clutter, view).exact();
  double nearer = 1.0;
  EXPECT_GT(sun.lit_runs_per_pixel, 4.0);
  for (double distance : {1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
    const double D = 4.0 * distance;  // in sizes of the clutter
    scene::View lamp = view;
    lamp.lights[0] = scene::point_light("lamp", view.camera.eye + D * view.lights[0].towards,
                                        view.lights[0].irradiance * static_cast<float>(D * D));
    const double error = rrmse(Reference(clutter, lamp).exact(), sun);
    EXPECT_LT(error, std::max(0.15 * nearer, 1e-6)) << distance;
    nearer = error;
  }
}

TEST(SunSurfaces, AQuadCastsItsShadowWhereItShould) {
  scene::Geometry geometry;
  tests::add_quad(geometry, {-50, 0, -50}, {100, 0, 0}, {0, 0, 100});
  tests::add_quad(geometry, {0.1f, 1, 0.1f}, {0.3f, 0, 0}, {0, 0, 0.2f});
  scene::View view = airlight::tests::view_of_level_plane({});
  view.camera.eye = {0.1, 4, 0.3};
  view.camera.up = {0, 0, -1};
  view.lights[0] = scene::sun("sun", {1.0, 2.0, 0.0}, glm::vec3(1.0f));
  const SurfaceImage image = Reference(geometry, view).surfaces();
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  int dark = 0;
  for (std::size_t i = 0; i < image.distance.size(); ++i) {
    const glm::dvec3 point = view.camera.eye + static_cast<double>(image.distance[i]) *
                                                   airlight::tests::pixel_ray(camera, view.size, i);
    // Half a metre to −x, of its own size; the quad itself is lit.
    const bool shadow = point.y < 0.5 && point.x > -0.4 && point.x < -0.1 && point.z > 0.1 && point.z < 0.3;
    dark += shadow ? 1 : 0;
    EXPECT_EQ(image.visibility[i], shadow ? 0.0f : 1.0f) << i;
  }
  EXPECT_GT(dark, 20);
}

TEST(SunSurfaces, AFlatMeshNeverShadowsItselfHoweverGrazingTheSun) {
  const tests::SlantedFloor floor;
  const scene::Geometry geometry = floor.geometry();
  for (double height : {1.0, 1e-2, 1e-4, 0.0, -1e-4}) {
    scene::View view = airlight::tests::view_of_level_plane({});
    view.camera.eye = {0.1, 4, 0.3};
    view.camera.up = {0, 0, -1};
    view.lights[0] =
        scene::sun("sun", glm::normalize(floor.u + 0.3 * floor.v) + height * floor.normal, glm::vec3(1.0f));
    const auto [hits, lit] = tests::count_surfaces(Reference(geometry, view).surfaces());
    EXPECT_GT(hits, 2000u);
    EXPECT_EQ(lit, height < 0.0 ? 0u : hits) << height;
  }
}

TEST(SunSurfaces, ACurvedMeshIsLitUpToItsTerminator) {
  scene::Geometry geometry;
  tests::add_sphere(geometry, {0, 0, 0}, 1.0f, 200);
  scene::View view = airlight::tests::view_of_level_plane({});
  view.lights[0] = scene::sun("sun", {3, 1, 0}, glm::vec3(1.0f));
  view.camera.eye = {0, 1, 4};
  const SurfaceImage image = Reference(geometry, view).surfaces();
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < image.distance.size(); ++i) {
    if (image.distance[i] == 0.0f) continue;
    ++hits;
    const glm::dvec3 point = view.camera.eye + static_cast<double>(image.distance[i]) *
                                                   airlight::tests::pixel_ray(camera, view.size, i);
    const double cosine = glm::dot(glm::normalize(point), view.lights[0].towards);
    // Facets are π/200 wide; within that of the terminator either is right.
    if (std::abs(cosine) > 0.02) {
      EXPECT_EQ(image.visibility[i], cosine > 0 ? 1.0f : 0.0f) << i;
    }
  }
  EXPECT_GT(hits, 500u);
}

}  // namespace
}  // namespace airlight::reference
