#include "surface_shadows/cluster_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/scenes.h"

namespace airlight::surface_shadows {
namespace {

/// In exact enough arithmetic: long doubles of floats.
using Vector = glm::vec<3, long double>;

long double distance_to_segment(const Vector& point, const Vector& from, const Vector& to) {
  const Vector along = to - from;
  const long double length2 = glm::dot(along, along);
  const long double t = length2 > 0 ? std::clamp(glm::dot(point - from, along) / length2, 0.0L, 1.0L) : 0.0L;
  return glm::length(point - from - t * along);
}

void expect_bounded(const scene::Geometry& geometry, const ClusterBounds& bounds, const std::string& what) {
  const Vector from(bounds.from), to(bounds.to), axis(bounds.axis);
  EXPECT_NEAR(static_cast<double>(glm::length(axis)), 1.0, 1e-6) << what;
  for (const glm::uvec3& t : geometry.triangles) {
    const Vector corners[3] = {Vector(geometry.positions[t.x]), Vector(geometry.positions[t.y]),
                               Vector(geometry.positions[t.z])};
    for (const Vector& corner : corners) {
      EXPECT_LE(distance_to_segment(corner, from, to), static_cast<long double>(bounds.radius)) << what;
      const long double height = glm::dot(axis, corner - from);
      EXPECT_LE(static_cast<long double>(bounds.lower), height) << what;
      EXPECT_GE(static_cast<long double>(bounds.upper), height) << what;
    }
    const Vector normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const long double longest =
        std::max({glm::distance(corners[0], corners[1]), glm::distance(corners[1], corners[2]),
                  glm::distance(corners[2], corners[0])});
    if (longest > 0) {
      EXPECT_LE(static_cast<long double>(bounds.least_altitude), glm::length(normal) / longest * (1 + 1e-12L))
          << what;
    } else {
      EXPECT_EQ(bounds.least_altitude, 0.0f) << what;
    }
    if (glm::length(normal) == 0) {
      EXPECT_EQ(bounds.opening, k_any_direction) << what << ": it has no normal";
    } else {
      const Vector unit = glm::normalize(normal), along = glm::normalize(axis);
      EXPECT_LE(2 * std::atan2(glm::distance(unit, along), glm::length(unit + along)),
                static_cast<long double>(bounds.opening))
          << what;
    }
  }
}

/// Any rotation, and a shift.
scene::Rigid any_motion(tests::Random& random, double shift) {
  const glm::dquat rotation = glm::normalize(glm::dquat(random.uniform(-1, 1), random.uniform(-1, 1) + 1e-3,
                                                        random.uniform(-1, 1), random.uniform(-1, 1)));
  scene::Rigid motion{glm::mat4_cast(rotation)};
  motion.matrix[3] = glm::dvec4(shift * random.direction(), 1.0);
  return motion;
}

ClusterBounds bounds_of_all(const scene::Geometry& geometry, bool has_capsules = true) {
  return bounds_of(geometry, geometry.triangles, has_capsules);
}

TEST(ClusterBounds, HoldAllOfRandomAndDegenerateClusters) {
  tests::Random random(1);
  int capsules = 0, spheres = 0;
  for (int i = 0; i < 3000; ++i) {
    scene::Geometry geometry;
    const int count = 1 + static_cast<int>(random.uniform() * 16);
    const glm::dvec3 middle = random.in_box(random.logarithmic(1e-3, 1e4));
    const double size = random.logarithmic(1e-6, 10.0);
    const glm::dvec3 shape(1.0, random.logarithmic(1e-6, 1.0), random.logarithmic(1e-6, 1.0));
    const int kind = i % 6;
    for (int k = 0; k < count; ++k) {
      const auto any = [&] { return middle + size * (random.in_box(1.0) * shape); };
      glm::dvec3 a = any(), b = any(), c = any();
      if (kind == 1) a = b = c = middle;                                                 // points
      if (kind == 2) b = a + size * glm::dvec3(1, 2, 3), c = a;                          // a segment
      if (kind == 3) c = 0.5 * (a + b);                                                  // in line, or nearly
      if (kind == 4 && k > 0) a = middle, b = middle + size, c = middle + size * shape;  // alike
      if (kind == 5) b = a + 1e-7 * size * random.direction();                           // needles
      tests::add_triangle(geometry, glm::vec3(a), glm::vec3(b), glm::vec3(c));
    }
    const ClusterBounds bounds = bounds_of_all(geometry);
    expect_bounded(geometry, bounds, "cluster " + std::to_string(i));
    ++(bounds.is_sphere() ? spheres : capsules);

    // Moved, and the corners rounded there: near, and so far away that they lose digits.
    const scene::Rigid motion = any_motion(random, random.logarithmic(1e-3, 1e3) * (size + 1e-3));
    scene::Geometry there = geometry;
    for (glm::vec3& position : there.positions) position = glm::vec3(motion(glm::dvec3(position)));
    expect_bounded(there, moved(bounds, motion), "moved cluster " + std::to_string(i));

    const ClusterBounds sphere = bounds_of_all(geometry, false);
    EXPECT_TRUE(sphere.is_sphere());
    expect_bounded(geometry, sphere, "sphere " + std::to_string(i));
  }
  EXPECT_GT(capsules, 500);
  EXPECT_GT(spheres, 500);
}

TEST(ClusterBounds, OfWhatMovesAreHardlyLarger) {
  scene::Geometry sheet;
  for (int i = 0; i < 8; ++i) tests::add_quad(sheet, {static_cast<float>(i), 5, 0}, {0, 0, 1}, {1, 0, 0});
  const ClusterBounds bounds = bounds_of_all(sheet);
  tests::Random random(2);
  for (int i = 0; i < 100; ++i) {
    const ClusterBounds there = moved(bounds, any_motion(random, 10.0));
    EXPECT_NEAR(there.radius, bounds.radius, 1e-5f);
    EXPECT_NEAR(glm::distance(there.from, there.to), glm::distance(bounds.from, bounds.to), 1e-5f);
    EXPECT_NEAR(there.upper - there.lower, 0.0f, 5e-5f);
    EXPECT_LT(there.opening, 5e-5f);
    EXPECT_NEAR(there.least_altitude, bounds.least_altitude, 1e-5f);
  }
}

TEST(ClusterBounds, AreTight) {
  scene::Geometry box;
  tests::add_box(box, {1, 2, 3}, {2, 3, 4});
  const ClusterBounds cube = bounds_of_all(box);
  EXPECT_TRUE(cube.is_sphere());
  EXPECT_NEAR(cube.radius, std::sqrt(0.75), 1e-6);
  EXPECT_EQ(cube.opening, k_any_direction) << "its normals have no mean";

  scene::Geometry beam;
  tests::add_box(beam, {0, 0, 0}, {10, 1, 1});
  const ClusterBounds capsule = bounds_of_all(beam);
  // The covariance of a box's corners, which do not all have as many triangles, is a little askew.
  EXPECT_NEAR(capsule.radius, std::sqrt(0.5), 0.1);
  EXPECT_NEAR(std::abs(capsule.to.x - capsule.from.x), 10.0, 0.1);

  scene::Geometry sheet;
  tests::add_quad(sheet, {0, 5, 0}, {0, 0, 1}, {1, 0, 0});
  const ClusterBounds flat = bounds_of_all(sheet);
  EXPECT_NEAR(flat.axis.y, 1.0f, 1e-6f);
  EXPECT_NEAR(flat.lower, 0.0f, 1e-6f);
  EXPECT_NEAR(flat.upper, 0.0f, 1e-6f);
  EXPECT_LT(flat.opening, 1e-6f);
  EXPECT_NEAR(flat.least_altitude, std::sqrt(0.5), 1e-6);
}

TEST(ClusterBounds, OfWhatIsTwiceAsLongIsACapsule) {
  for (const float length : {1.5f, 6.0f}) {
    scene::Geometry beam;
    tests::add_box(beam, {0, 0, 0}, {length, 1, 1});
    EXPECT_EQ(bounds_of_all(beam).is_sphere(), length < 2.0f);
  }
}

}  // namespace
}  // namespace airlight::surface_shadows
