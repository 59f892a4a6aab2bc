#include <gtest/gtest.h>

#include "support/view_rays.h"
#include "unit/reference/fixtures.h"

/// First hits, and whether the light sees them.
namespace airlight::reference {
namespace {

scene::View looking_down(glm::dvec3 light) {
  scene::View view;
  view.camera.eye = {0.1, 4, 0.3};
  view.camera.target = {0, 0, 0};
  view.camera.up = {0, 0, -1};
  view.camera.vertical_fov_degrees = 40;
  view.lights[0].position = light;
  view.size = {64, 64};
  return view;
}

glm::dvec3 pixel_direction(const scene::View& view, int x, int y) {
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  return airlight::tests::pixel_ray(camera, view.size, x, y);
}

TEST(Surfaces, NothingIsHitInAnEmptyScene) {
  const SurfaceImage image = Reference({}, looking_down({0, 2, 0})).surfaces();
  ASSERT_EQ(image.distance.size(), 64u * 64u);
  for (float distance : image.distance) EXPECT_EQ(distance, 0.0f);
  for (float visibility : image.visibility) EXPECT_EQ(visibility, 0.0f);
}

TEST(Surfaces, DistanceRunsAlongTheUnitViewRayFromTheTopRow) {
  scene::Geometry floor;
  tests::add_quad(floor, {-50, 0, -50}, {100, 0, 0}, {0, 0, 50.5});  // ends at z = 0.5
  const scene::View view = looking_down({0, 2, 0});
  const SurfaceImage image = Reference(floor, view).surfaces();
  int hits = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const glm::dvec3 direction = pixel_direction(view, x, y);
      const double distance = -view.camera.eye.y / direction.y;
      const bool hit = (view.camera.eye + distance * direction).z < 0.5;
      hits += hit ? 1 : 0;
      EXPECT_NEAR(image.distance[static_cast<std::size_t>(64 * y + x)], hit ? distance : 0.0,
                  1e-6 * distance);
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LT(hits, 3900);
}

TEST(Surfaces, AQuadCastsItsShadowWhereItShould) {
  scene::Geometry geometry;
  tests::add_quad(geometry, {-50, 0, -50}, {100, 0, 0}, {0, 0, 100});
  tests::add_quad(geometry, {0.1f, 1, 0.1f}, {0.3f, 0, 0}, {0, 0, 0.2f});
  const scene::View view = looking_down({0, 2, 0});
  const SurfaceImage image = Reference(geometry, view).surfaces();
  int dark = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const glm::dvec3 point =
          view.camera.eye + static_cast<double>(image.distance[static_cast<std::size_t>(64 * y + x)]) *
                                pixel_direction(view, x, y);
      if (point.y > 0.5) {
        EXPECT_EQ(image.visibility[static_cast<std::size_t>(64 * y + x)], 1.0f) << "the quad itself";
        continue;
      }
      // Twice as large on the floor as at half the light's height.
      const bool shadow = point.x > 0.2 && point.x < 0.8 && point.z > 0.2 && point.z < 0.6;
      dark += shadow ? 1 : 0;
      EXPECT_EQ(image.visibility[static_cast<std::size_t>(64 * y + x)], shadow ? 0.0f : 1.0f)
          << x << " " << y;
    }
  }
  EXPECT_GT(dark, 20);
}

TEST(Surfaces, AFlatMeshNeverShadowsItselfHoweverGrazingTheLight) {
  // A slanted floor of many triangles, and a light that skims it or lies in its very plane.
  const tests::SlantedFloor floor;
  const scene::Geometry geometry = floor.geometry();
  for (double height : {1.0, 1e-2, 1e-4, 0.0, -1e-4}) {
    const glm::dvec3 light = 2.2 * floor.u + 0.3 * floor.v + height * floor.normal;
    const auto [hits, lit] = tests::count_surfaces(Reference(geometry, looking_down(light)).surfaces());
    EXPECT_GT(hits, 3000u);
    EXPECT_EQ(lit, height < 0.0 ? 0u : hits) << height;
  }
}

TEST(Surfaces, ACurvedMeshIsLitUpToItsTerminator) {
  scene::Geometry geometry;
  tests::add_sphere(geometry, {0, 0, 0}, 1.0f, 200);
  const glm::dvec3 light(3, 1, 0);
  const scene::View view = looking_down(light);
  const SurfaceImage image = Reference(geometry, view).surfaces();
  std::size_t hits = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const auto i = static_cast<std::size_t>(64 * y + x);
      if (image.distance[i] == 0.0f) continue;
      ++hits;
      const glm::dvec3 point =
          view.camera.eye + static_cast<double>(image.distance[i]) * pixel_direction(view, x, y);
      const double cosine = glm::dot(glm::normalize(point), glm::normalize(light - point));
      // Facets are π/200 wide; within that of the terminator either is right.
      if (std::abs(cosine) > 0.02) {
        EXPECT_EQ(image.visibility[i], cosine > 0 ? 1.0f : 0.0f) << x << " " << y;
      }
    }
  }
  EXPECT_GT(hits, 500u);
}

TEST(Surfaces, AHollowBoxAroundTheLightIsDarkOutside) {
  scene::Geometry geometry;
  tests::add_box(geometry, {-1, -1, -1}, {1, 1, 1});
  tests::add_box(geometry, {-0.99f, -0.99f, -0.99f}, {0.99f, 0.99f, 0.99f});
  const SurfaceImage image = Reference(geometry, looking_down({0.2, 0.3, 0.1})).surfaces();
  for (float visibility : image.visibility) EXPECT_EQ(visibility, 0.0f);
}

TEST(Surfaces, ALoneSheetIsLitOnTheSideOfTheLight) {
  // Whichever way its corners go round.
  for (float turn : {10.0f, -10.0f}) {
    scene::Geometry sheet;
    tests::add_quad(sheet, {-0.5f * turn, 0, -5}, {turn, 0, 0}, {0, 0, 10});
    for (double height : {2.0, -2.0}) {
      const SurfaceImage image = Reference(sheet, looking_down({0.2, height, 0.1})).surfaces();
      for (float visibility : image.visibility) EXPECT_EQ(visibility, height > 0.0 ? 1.0f : 0.0f);
    }
  }
}

}  // namespace
}  // namespace airlight::reference
