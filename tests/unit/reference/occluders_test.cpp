#include <algorithm>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "scene/error.h"
#include "unit/reference/fixtures.h"

/// Shadows whose place is known in closed form, and the places where rays go wrong.
namespace airlight::reference {
namespace {

using tests::airlight_over_distance;
using tests::one_pixel_view;
using tests::rrmse;

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// A light at a height of 2 above the view ray from the origin along +Z, 3 ahead of the eye.
scene::View overhead_light() {
  scene::View view = one_pixel_view(1.0, 0.0, {.sigma_s = {0.05f, 0.1f, 0.5f}, .sigma_a = glm::vec3(0.02f)});
  view.lights[0].position = {0, 2, 3};
  return view;
}

/// Rounding to single precision, and the quadrature of the truth and of what it is compared with.
constexpr double k_exact = 3e-7;

void expect_radiance(const AirlightImage& image, const glm::dvec3& expected, double tolerance) {
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(static_cast<double>(image.radiance[0][channel]) / expected[channel], 1.0, tolerance)
        << "channel " << channel;
  }
}

double alpha_of(const scene::View& view) {
  return std::atan2(view.lights[0].position.y, view.lights[0].position.z);
}

TEST(Occluders, AHalfPlaneShadowsTheRayUpToItsEdge) {
  const scene::View view = overhead_light();
  // At half the light's height, an edge at z casts its shadow's edge at 2z − 3 of the ray.
  scene::Geometry geometry;
  tests::add_quad(geometry, {-0.5f, 1, 4}, {1, 0, 0}, {0, 0, -3});
  const glm::dvec3 expected = airlight_over_distance(view, alpha_of(view), 5.0, k_infinity);
  const AirlightImage exact = Reference(geometry, view).exact();
  expect_radiance(exact, expected, k_exact);
  EXPECT_EQ(exact.lit_runs_per_pixel, 1.0);
  const AirlightImage image = Reference(geometry, view).sampled(64);
  // The edge is known to 1e-6 of the range of φ.
  expect_radiance(image, expected, 1e-5);
  EXPECT_EQ(image.self_error, 0.0) << "one edge is found however few samples there are";
  // A sample more than steps; a step is 15625 times the resolution, less than 2¹⁴.
  EXPECT_EQ(image.rays, 65u + 14u);
}

TEST(Occluders, ASlitLightsTheRayBetweenItsEdges) {
  const scene::View view = overhead_light();
  scene::Geometry geometry;
  tests::add_quad(geometry, {-0.5f, 1, 4}, {1, 0, 0}, {0, 0, -3});
  tests::add_quad(geometry, {-0.5f, 1, 4.5f}, {1, 0, 0}, {0, 0, 100});
  const glm::dvec3 expected = airlight_over_distance(view, alpha_of(view), 5.0, 6.0);
  expect_radiance(Reference(geometry, view).exact(), expected, k_exact);
  // Embree's robust mode widens a triangle by 1e-7 of its size, here by 1e-5 of the slit.
  expect_radiance(Reference(geometry, view).sampled(256), expected, 5e-5);
}

TEST(Occluders, ASphereShadowsTheRayBetweenItsTangents) {
  const scene::View view = overhead_light();
  const glm::dvec3 centre(0, 1, 3.5);
  const double radius = 0.25;
  scene::Geometry geometry;
  tests::add_sphere(geometry, centre, static_cast<float>(radius), 512);
  // Angles from straight down to the tangents, and where those meet the ray.
  const glm::dvec3 to_centre = centre - view.lights[0].position;
  const double middle = std::atan2(to_centre.z, -to_centre.y),
               half = std::asin(radius / glm::length(to_centre));
  const double from = 3 + 2 * std::tan(middle - half), to = 3 + 2 * std::tan(middle + half);
  const double alpha = alpha_of(view);
  const glm::dvec3 expected =
      airlight_over_distance(view, alpha, 0.0, from) + airlight_over_distance(view, alpha, to, k_infinity);
  // The facets cut the sphere short by (π/512)²/8 of its radius.
  expect_radiance(Reference(geometry, view).exact(), expected, 2e-5);
  expect_radiance(Reference(geometry, view).sampled(256), expected, 2e-5);
}

TEST(Occluders, MarchApproachesTheTruthAsStepsGrow) {
  const Reference reference(tests::clutter(150), tests::clutter_view(24));
  tests::expect_march_converges(reference, reference.exact());
}

TEST(Occluders, SingleRaysAndPacketsSeeTheSame) {
  const Reference reference(tests::clutter(150), tests::clutter_view(24));
  const AirlightImage single = reference.march(100, RayMode::single),
                      packet = reference.march(100, RayMode::packet);
  EXPECT_EQ(single.rays, 24u * 24u * 100u);
  EXPECT_EQ(packet.rays, single.rays);
  EXPECT_GT(single.ms, 0.0);
  // Rays that graze an edge may be rounded either way: one step of a hundred in few pixels.
  EXPECT_LT(rrmse(single, packet), 1e-3);
}

TEST(Occluders, SelfErrorFallsWithSamplesAndPredictsTheTrueError) {
  const Reference reference(tests::clutter(150), tests::clutter_view(24));
  double coarser = k_infinity;
  for (int samples : {16, 32, 64, 128}) {
    const AirlightImage image = reference.sampled(samples);
    const double actual = rrmse(image, reference.exact());
    EXPECT_LT(image.self_error, coarser);
    EXPECT_GT(image.self_error, 0.7 * actual) << samples;
    EXPECT_LT(image.self_error, 5 * actual) << samples;
    coarser = image.self_error;
  }
}

TEST(Occluders, SelfErrorIsTheChangeFromHalfAsManySamples) {
  const Reference reference(tests::clutter(150), tests::clutter_view(24));
  for (int samples : {16, 64}) {
    const AirlightImage fine = reference.sampled(2 * samples);
    // Where a step holds several changes, halving it may end at another of them.
    EXPECT_NEAR(fine.self_error / rrmse(reference.sampled(samples), fine), 1.0, 0.03) << samples;
  }
}

TEST(Occluders, ALightOnASurfaceShinesToEitherSide) {
  // Planes through the light, whose corners, like the light, are exact in binary.
  scene::View view = one_pixel_view(3.0, 2.5, {.sigma_s = glm::vec3(0.1f)});
  view.lights[0].position = {1.75, 0.5, -2.25};
  const glm::vec3 light(view.lights[0].position);
  const AirlightImage free = Reference({}, view).exact();
  for (float tilt : {0.0f, 0.125f, 0.3125f}) {
    const glm::vec3 u(0.75f, tilt, 0.125f), v(0.125f, tilt, 1.25f);
    for (const glm::vec2 place : {glm::vec2(0.25f, 0.375f), glm::vec2(0.5f, 0.0f), glm::vec2(1.0f, 0.0f)}) {
      scene::Geometry geometry;
      tests::add_quad(geometry, light - place.x * u - place.y * v, u, v);
      EXPECT_LT(rrmse(Reference(geometry, view).exact(), free), 1e-6) << tilt;
      EXPECT_LT(rrmse(Reference(geometry, view).sampled(64), free), 1e-6) << tilt;
    }
  }
}

TEST(Occluders, ALightAHairBehindAWallIsBehindIt) {
  scene::Geometry wall;
  tests::add_quad(wall, {-2000, -2000, 0}, {4000, 0, 0}, {0, 4000, 0});
  for (double gap : {1.0, 1e-3, 1e-6}) {
    scene::View view;
    view.camera = {.name = "", .eye = {0, 1, 1000}, .target = {0, 1, 0}, .vertical_fov_degrees = 0.5};
    view.lights[0].position = {0.3, 1.5, -gap};
    view.size = {16, 16};
    const Reference reference(wall, view);
    for (const AirlightImage& image :
         {reference.exact(), reference.sampled(64), reference.march(64, RayMode::packet)}) {
      for (const glm::vec3& radiance : image.radiance) EXPECT_EQ(radiance, glm::vec3(0.0f)) << gap;
    }
  }
}

TEST(Occluders, AClosedBoxAroundTheLightLetsNothingOut) {
  scene::View view = tests::clutter_view(32);
  scene::Geometry geometry;
  tests::add_box(geometry, {-1, -1, -1}, {1, 1, 1});
  const Reference reference(geometry, view);
  const AirlightImage free = Reference({}, view).exact();
  AirlightImage image = reference.exact();
  for (const glm::vec3& radiance : image.radiance) EXPECT_EQ(radiance, glm::vec3(0.0f));
  // Rays that end on the box end within rounding of its surface: 1e-6 of their range may leak.
  image = reference.sampled(64);
  for (std::size_t i = 0; i < image.radiance.size(); ++i) {
    EXPECT_LE(image.radiance[i].r, 1e-5f * free.radiance[i].r) << i;
  }
  image = reference.march(64, RayMode::packet);
  for (const glm::vec3& radiance : image.radiance) EXPECT_EQ(radiance, glm::vec3(0.0f));
  image = reference.march(64, RayMode::single);
  for (const glm::vec3& radiance : image.radiance) EXPECT_EQ(radiance, glm::vec3(0.0f));
}

TEST(Occluders, FacetedSphereAroundTheLightHasNoCracks) {
  scene::View view = tests::clutter_view(32);
  scene::Geometry geometry;
  tests::add_sphere(geometry, {0.1f, 0.1f, -0.2f}, 1.0f, 200);
  const Reference reference(geometry, view);
  for (const glm::vec3& radiance : reference.exact().radiance) EXPECT_EQ(radiance, glm::vec3(0.0f));
  for (RayMode mode : {RayMode::single, RayMode::packet}) {
    const AirlightImage image = reference.march(1024, mode);
    for (const glm::vec3& radiance : image.radiance) EXPECT_EQ(radiance, glm::vec3(0.0f));
  }
}

TEST(Occluders, FarFromTheOriginNothingChanges) {
  // At 2²⁰ m single precision knows eighths of a metre: the geometry is given in those, eye and light are
  // not.
  scene::Geometry geometry = tests::clutter(150);
  for (glm::vec3& position : geometry.positions) position = glm::round(position * (32 * 8.0f)) / 8.0f;
  scene::View view = tests::clutter_view(24);
  view.camera.eye *= 32;
  view.lights[0].position *= 32;
  view.medium.sigma_s /= 32;
  const AirlightImage near = Reference(geometry, view).exact();
  const SurfaceImage near_surfaces = Reference(geometry, view).surfaces();

  const glm::dvec3 offset(1048576, -1048576, 1048576);
  for (glm::vec3& position : geometry.positions) position += glm::vec3(offset);
  view.camera.eye += offset;
  view.camera.target += offset;
  view.lights[0].position += offset;
  const Reference reference(geometry, view);
  // Eye and light are rounded to 1e-10 m there.
  EXPECT_LT(rrmse(reference.exact(), near), 1e-6);
  EXPECT_LT(rrmse(reference.sampled(512), near), 5e-3);
  const SurfaceImage far_surfaces = reference.surfaces();
  std::size_t differing = 0;
  for (std::size_t i = 0; i < near_surfaces.distance.size(); ++i) {
    if (std::abs(far_surfaces.distance[i] - near_surfaces.distance[i]) > 1e-4f) ++differing;
  }
  EXPECT_LE(differing, 1u);
}

TEST(Occluders, RefusesTooFewSamples) {
  const Reference reference({}, one_pixel_view(1.0, 1.0));
  EXPECT_THROW(reference.sampled(1), scene::Error);
  EXPECT_THROW(reference.march(0, RayMode::packet), scene::Error);
}

TEST(Occluders, OddSampleCountsWork) {
  const Reference reference(tests::clutter(150), tests::clutter_view(24));
  EXPECT_LT(rrmse(reference.sampled(1023), reference.exact()), 5e-3);
  EXPECT_LT(rrmse(reference.march(1023, RayMode::packet), reference.exact()), 5e-3);
}

TEST(Occluders, RefusesALightAtTheEye) {
  scene::View view = one_pixel_view(1.0, 1.0);
  view.lights[0].position = view.camera.eye;
  EXPECT_THROW(Reference({}, view), scene::Error);
}

TEST(Occluders, ProgressComesOnTheCallingThreadAndEndsAtOne) {
  const Reference reference(tests::clutter(20), tests::clutter_view(16));
  const auto caller = std::this_thread::get_id();
  std::vector<double> fractions;
  const auto progress = [&](double fraction) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    fractions.push_back(fraction);
  };
  reference.exact(1, progress);
  ASSERT_FALSE(fractions.empty());
  EXPECT_EQ(fractions.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  const auto cancel = [](double) { throw std::runtime_error("cancelled"); };
  EXPECT_THROW(reference.surfaces(cancel), std::runtime_error);
}

}  // namespace
}  // namespace airlight::reference
