#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "reference/fog_quadrature.h"
#include "reference/shadow_intervals.h"
#include "support/random.h"
#include "unit/reference/fixtures.h"

/// The truth without sampling: against rays cast one by one, and where triangles degenerate.
namespace airlight::reference {
namespace {

using airlight::tests::Random;
using tests::Crossing, tests::rrmse;

/// Whether a triangle hides a point from the light at the origin.
Crossing crossing(const Corners& c, const glm::dvec3& point) {
  const Crossing inside = tests::passes_inside(c, point);
  const glm::dvec3 n = glm::normalize(normal(c));
  const double from = glm::dot(n, -c[0]), to = glm::dot(n, point - c[0]);
  const double scale = glm::length(point) + glm::length(c[0]);
  return {inside.hides && from * to < 0.0,
          std::min({inside.margin, std::abs(from) / scale, std::abs(to) / scale})};
}

Occluders occluders_of(const std::vector<Corners>& triangles) {
  Occluders occluders;
  for (const Corners& corners : triangles) occluders.add(corners);
  return occluders;
}

bool is_lit(const ShadowIntervals& shadows, double psi) {
  return std::any_of(shadows.lit_runs().begin(), shadows.lit_runs().end(),
                     [&](const auto& run) { return run.to <= psi && psi <= run.from; });
}

/// A view ray of random eye and direction, up to `distance`.
ViewRay random_ray(Random& random, const glm::dvec3& eye, double distance) {
  return make_view_ray(eye, random.direction(), {1, 0, 0}, distance, 1e-6);
}

TEST(ShadowIntervals, AgreeWithRaysCastOneByOne) {
  Random random(1);
  int shadowed = 0, lit = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const std::vector<Corners> triangles = tests::random_triangles(random, 3.0);
    const glm::dvec3 eye = random.in_box(4.0);
    const double distance = trial % 2 == 0 ? 0.0 : random.logarithmic(0.1, 20.0);
    const ViewRay ray = random_ray(random, eye, distance);
    Occluders occluders = occluders_of(triangles);
    ShadowIntervals shadows;
    shadows.trace(ray, occluders);
    for (int sample = 0; sample < 200; ++sample) {
      const double psi = ray.psi(random.uniform());
      const glm::dvec3 point =
          ray.D * ray.sin_alpha / std::sin(psi) * (ray.w * std::cos(psi) + ray.q * std::sin(psi));
      const auto [hidden, margin] =
          tests::crossing_of_all(triangles, [&](const Corners& corners) { return crossing(corners, point); });
      if (margin < 1e-11) continue;  // neither can know
      EXPECT_EQ(is_lit(shadows, psi), !hidden) << trial << " " << psi;
      ++(hidden ? shadowed : lit);
    }
  }
  EXPECT_GT(shadowed, 5000);
  EXPECT_GT(lit, 10000);
}

/// A ray along +Z at a height of 2 above the light, whose half-plane is x = 0.
ViewRay level_ray(double eye_z, double distance) {
  return make_view_ray({0, 2, eye_z}, {0, 0, 1}, {1, 0, 0}, distance, 1e-6);
}

struct ZRange {
  double from, to;
};

/// The lit part of a level ray, in z.
std::vector<ZRange> lit_ranges(const ViewRay& ray, const std::vector<Corners>& triangles) {
  Occluders occluders = occluders_of(triangles);
  ShadowIntervals shadows;
  shadows.trace(ray, occluders);
  std::vector<ZRange> ranges;
  for (const ShadowIntervals::Run& run : shadows.lit_runs())
    ranges.push_back({2.0 / std::tan(run.from), 2.0 / std::tan(run.to)});
  return ranges;
}

void expect_ranges(const std::vector<ZRange>& ranges, const std::vector<ZRange>& expected) {
  ASSERT_EQ(ranges.size(), expected.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    EXPECT_NEAR(ranges[i].from, expected[i].from, 1e-12);
    EXPECT_NEAR(ranges[i].to, expected[i].to, 1e-12);
  }
}

/// A quad between two z at a height y, to either side of the half-plane x = 0.
std::vector<Corners> lid(double y, double z_from, double z_to) {
  const glm::dvec3 a(-1, y, z_from), b(1, y, z_from), c(1, y, z_to), d(-1, y, z_to);
  return {{a, b, c}, {a, c, d}};
}

TEST(ShadowIntervals, OfALidAreTwiceItsSizeAtHalfTheHeight) {
  expect_ranges(lit_ranges(level_ray(-4, 10), lid(1, -1, 0.5)), {{-4, -2}, {1, 6}});
}

TEST(ShadowIntervals, OfTrianglesBehindTheLightOrTheRayAreNone) {
  expect_ranges(lit_ranges(level_ray(-4, 10), lid(-1, -1, 0.5)), {{-4, 6}});
  expect_ranges(lit_ranges(level_ray(-4, 10), lid(2.5, -1, 0.5)), {{-4, 6}});
}

TEST(ShadowIntervals, EndWhereATriangleTouchesTheRay) {
  // A wall up to the ray, at z = 1, from the height of half the ray's.
  const std::vector<Corners> wall = {{glm::dvec3(-1, 1, 1), glm::dvec3(1, 1, 1), glm::dvec3(0, 2, 1)}};
  expect_ranges(lit_ranges(level_ray(-4, 10), wall), {{-4, 1}, {2, 6}});
  // The same through the ray, which ends there.
  const std::vector<Corners> through = {{glm::dvec3(-1, 1, 1), glm::dvec3(1, 1, 1), glm::dvec3(0, 5, 1)}};
  expect_ranges(lit_ranges(level_ray(-4, 5), through), {{-4, 1}});
}

TEST(ShadowIntervals, ReachToTheEndsWhereATrianglePassesTheLight) {
  // From beside the light, at its very height and below: all of the ray beyond its upper edge is hidden.
  for (double y : {0.0, -1.0}) {
    const std::vector<Corners> wall = {
        {glm::dvec3(-9, y, 0.5), glm::dvec3(9, y, 0.5), glm::dvec3(0, 1, 0.5)}};
    expect_ranges(lit_ranges(level_ray(-4, 10), wall), {{-4, 1}});
    EXPECT_EQ(lit_ranges(level_ray(-4, 0), wall).size(), 1u) << "the endless part is dark";
  }
}

TEST(ShadowIntervals, OfATriangleThatHoldsTheEyeBeginThere) {
  // A floor through the eye and below the ray: it holds the eye in a corner, on an edge, and inside.
  for (double z : {-4.0, -4.5}) {
    for (double x : {0.0, -1.0}) {
      const std::vector<Corners> slope = {
          {glm::dvec3(x, 2 + 0.5 * (-4 - z), z), glm::dvec3(2, 1, -2), glm::dvec3(-2, 1, -2)}};
      const std::vector<ZRange> ranges = lit_ranges(level_ray(-4, 10), slope);
      ASSERT_EQ(ranges.size(), 1u);
      EXPECT_NEAR(ranges[0].to, 6.0, 1e-12);
      // Of the slope down from the eye, the lower end casts its shadow at z = −4 too: it lies in a light ray.
      EXPECT_NEAR(ranges[0].from, -4.0, 1e-9);
    }
  }
}

TEST(ShadowIntervals, AreNoneOfATriangleEdgeOnToTheLight) {
  // Planes through the light: by a corner, an edge, the inside, and beside the triangle.
  const glm::dvec3 u(0.75, 0.25, 0.5), v(-0.5, 0.125, 1.0);
  for (const glm::dvec2 place :
       {glm::dvec2(0), glm::dvec2(0.5, 0), glm::dvec2(0.25, 0.25), glm::dvec2(2, 3)}) {
    const glm::dvec3 corner = -place.x * u - place.y * v;
    const std::vector<Corners> triangle = {{corner, corner + u, corner + v}};
    expect_ranges(lit_ranges(level_ray(-4, 10), triangle), {{-4, 6}});
  }
}

TEST(ShadowIntervals, OfATriangleInTheHalfPlaneAreThoseOfAnInfinitelyNearRay) {
  // Alone it is edge-on to the ray: nothing. As a face of a box, whose other faces meet the half-plane in its
  // edges, it leaks nothing.
  const std::vector<Corners> face = {{glm::dvec3(0, 1, -1), glm::dvec3(0, 1.5, -1), glm::dvec3(0, 1, 1)}};
  expect_ranges(lit_ranges(level_ray(-4, 10), face), {{-4, 6}});
  for (double side : {-1.0, 1.0}) {
    scene::Geometry box;
    const glm::vec3 lower(std::min(side, 0.0), 1, -1), upper(std::max(side, 0.0), 1.5f, 0.5f);
    tests::add_box(box, lower, upper);
    std::vector<Corners> triangles;
    const Triangles of_box(box);
    for (std::uint32_t i = 0; i < of_box.count(); ++i) triangles.push_back(of_box.around({0, 0, 0}, i));
    const std::vector<ZRange> ranges = lit_ranges(level_ray(-4, 10), triangles);
    if (side > 0.0) {
      expect_ranges(ranges, {{-4, -2}, {1, 6}});  // zero counts as inside
    } else {
      expect_ranges(ranges, {{-4, 6}});
    }
  }
}

/// A sphere of flat facets, many of whose corners and edges lie in planes of symmetry.
std::vector<Corners> sphere_of_corners(double radius, int rings) {
  scene::Geometry sphere;
  tests::add_sphere(sphere, {0, 0, 0}, static_cast<float>(radius), rings);
  const Triangles triangles(sphere);
  std::vector<Corners> corners;
  for (std::uint32_t i = 0; i < triangles.count(); ++i) corners.push_back(triangles.around({0, 0, 0}, i));
  return corners;
}

TEST(ShadowIntervals, AClosedSurfaceAroundTheLightLeaksNothing) {
  const std::vector<Corners> sphere = sphere_of_corners(1.0, 24);
  Occluders occluders = occluders_of(sphere);
  Random random(3);
  ShadowIntervals shadows;
  for (int trial = 0; trial < 3000; ++trial) {
    // Every other half-plane holds an edge of the sphere: eye and ray are made from its ends.
    glm::dvec3 a = random.direction(), b = random.direction();
    if (trial % 2 == 0) {
      const Corners& corners = sphere[random.bits() % sphere.size()];
      a = corners[0];
      b = corners[1];
    }
    const glm::dvec3 eye = 3.0 * a + random.uniform(-3.0, 3.0) * b;
    if (glm::length(eye) < 1.2) continue;
    const ViewRay ray = make_view_ray(eye, glm::normalize(eye + random.uniform() * b), {1, 0, 0}, 0.0, 1e-6);
    shadows.trace(ray, occluders);
    EXPECT_TRUE(shadows.lit_runs().empty()) << trial;
  }
}

TEST(ShadowIntervals, ASpikySurfaceAroundTheLightLeaksNothing) {
  // A sphere whose corners are moved along their light rays, up to a million times as far: slivers, whose
  // edges the half-plane cuts where rounding is coarse.
  Random random(4);
  std::map<std::array<double, 3>, double> reach;
  std::vector<Corners> spikes = sphere_of_corners(1.0, 12);
  for (Corners& corners : spikes) {
    for (glm::dvec3& corner : corners) {
      const auto place = reach.try_emplace({corner.x, corner.y, corner.z}, 0.0).first;
      if (place->second == 0.0) place->second = random.logarithmic(1.0, 1e6);
      corner = glm::dvec3(glm::vec3(place->second * corner));
    }
  }
  Occluders occluders = occluders_of(spikes);
  ShadowIntervals shadows;
  for (int trial = 0; trial < 3000; ++trial) {
    const glm::dvec3 outward = random.direction(), aside = random.direction();
    const ViewRay ray = make_view_ray(
        2e6 * outward, glm::normalize(outward + random.logarithmic(1e-6, 0.9) * aside), {1, 0, 0}, 0.0, 1e-6);
    shadows.trace(ray, occluders);
    EXPECT_TRUE(shadows.lit_runs().empty()) << trial;
  }
}

/// The image with every triangle looked at for every pixel.
std::vector<glm::vec3> without_hierarchy(const scene::Geometry& geometry, const scene::View& view) {
  const glm::dvec3 light = view.lights[0].position;
  const Triangles triangles(geometry);
  Occluders occluders;
  for (std::uint32_t i = 0; i < triangles.count(); ++i) occluders.add(triangles.around(light, i));
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  const SurfaceImage surfaces = Reference(geometry, view).surfaces();
  std::vector<glm::vec3> image;
  ShadowIntervals shadows;
  for (int y = 0; y < view.size.y; ++y) {
    for (int x = 0; x < view.size.x; ++x) {
      const glm::dvec3 direction = glm::normalize(
          camera.forward + ((x + 0.5) / view.size.x * 2.0 - 1.0) * camera.half_width * camera.right +
          (1.0 - (y + 0.5) / view.size.y * 2.0) * camera.half_height * camera.up);
      const auto distance = static_cast<double>(surfaces.distance[image.size()]);
      const ViewRay ray = make_view_ray(camera.eye - light, direction, camera.right, distance,
                                        0.5 * camera.half_height / view.size.y);
      shadows.trace(ray, occluders);
      FogQuadrature fog(ray, static_cast<double>(view.medium.sigma_s.x), view.medium);
      glm::dvec3 sum(0.0);
      for (const auto& run : shadows.lit_runs()) sum += fog.integral(run.from, run.to);
      image.push_back(glm::vec3(static_cast<double>(view.medium.sigma_s.x) / (ray.D * ray.sin_alpha) * sum));
    }
  }
  return image;
}

TEST(Exact, TheHierarchyLeavesNothingOut) {
  // So many that tiles are split, most of them too small to darken all.
  scene::Geometry clutter = tests::clutter(500);
  Random random(5);
  for (int i = 0; i < 70000; ++i) {
    const glm::dvec3 centre = random.in_box(2.0);
    tests::add_triangle(clutter, glm::vec3(centre), glm::vec3(centre + random.in_box(0.01)),
                        glm::vec3(centre + random.in_box(0.01)));
  }
  scene::View view = tests::clutter_view(10);
  view.lights[0].intensity = glm::vec3(1.0f);
  view.medium.sigma_s = glm::vec3(0.1f);
  const auto expect_same = [&](const char* what) {
    const double error = rrmse(Reference(clutter, view).exact().radiance, without_hierarchy(clutter, view));
    // The distance comes through an image of single precision.
    EXPECT_LT(error, 2e-6) << what;
  };
  view.camera.eye = {0, 0, 2.6};
  expect_same("the light in the image");
  view.camera.target = view.camera.eye + glm::dvec3(1, 0.2, 0.1);
  expect_same("the light aside");
  view.camera.target = view.camera.eye + glm::dvec3(-0.3, -0.2, 2.9);
  expect_same("the light behind the eye, its antipode in the image");
  view.camera.vertical_fov_degrees = 150;
  expect_same("a wide view");
  view.camera.eye = {0.3, 0.2, -0.41};
  view.camera.target = {0.3, 0.2, -3.0};
  expect_same("the light at the back of the head");
}

TEST(Exact, FourTimesTheNodesStayWithinTheBound) {
  scene::View view = tests::clutter_view(24);
  for (float g : {0.0f, 0.95f, -0.95f}) {
    view.medium.phase = scene::PhaseFunction::henyey_greenstein;
    view.medium.g = g;
    const Reference reference(tests::clutter(150), view);
    const AirlightImage image = reference.exact();
    EXPECT_LT(image.bound, 2e-6);
    EXPECT_LE(rrmse(image, reference.exact(4)), image.bound);
  }
}

}  // namespace
}  // namespace airlight::reference
