#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "shared.h"
#include "support/random.h"
#include "support/rough_shaders.h"

namespace airlight::shaders {
#include "frame/occlusion.glsl"
#include "surface_shadows/apparent.glsl"
}  // namespace airlight::shaders

namespace airlight::rough {
using glm::max, glm::min, glm::clamp;
using bvec3 = glm::bvec3;
#undef AIRLIGHT_LIGHT_RAYS_GLSL
#undef AIRLIGHT_APPARENT_GLSL
#define float Rough
#include "surface_shadows/apparent.glsl"
#undef float
}  // namespace airlight::rough

/// What the light sees of capsules, and how far apart: bounds that hold.
namespace airlight::shaders {
namespace {

constexpr double k_reach = 16.0;  ///< of all positions here
constexpr double k_exact = std::numbers::pi * 1e-12;

/// A lamp, and a sun from anywhere.
std::vector<Observer> observers(tests::Random& random) {
  const Observer lamp{{vec3(0.0f), false}, k_angle_error};
  const Observer sun{{vec3(random.direction()), true}, static_cast<float>(k_foot_error * k_reach)};
  return {lamp, sun};
}

double angle(glm::dvec3 a, glm::dvec3 b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// In doubles, between what the light sees of two points.
double distance(const Observer& observer, glm::dvec3 a, glm::dvec3 b) {
  if (!observer.rays.is_sun) return angle(a, b);
  return glm::length(glm::cross(a - b, glm::normalize(glm::dvec3(observer.rays.travels))));
}

/// Points of a segment, close to each other as the light sees them.
std::vector<glm::dvec3> points_between(glm::dvec3 from, glm::dvec3 to) {
  std::vector<glm::dvec3> points;
  constexpr int k_count = 400;
  // Even in angle, of a lamp; of a segment that the lamp is not on.
  const double whole = angle(from, to);
  for (int i = 0; i <= k_count; ++i) {
    const double part = static_cast<double>(i) / k_count;
    const double s = whole > 1e-9 ? glm::length(from) * std::sin(part * whole) /
                                        (glm::length(from) * std::sin(part * whole) +
                                         glm::length(to) * std::sin((1.0 - part) * whole))
                                  : part;
    points.push_back(from + std::clamp(s, 0.0, 1.0) * (to - from));
  }
  return points;
}

double distance_of_points(const Observer& observer, const std::vector<glm::dvec3>& points, glm::dvec3 other) {
  double least = 1e30;
  for (const glm::dvec3& point : points) least = std::min(least, distance(observer, point, other));
  return least;
}

/// The most by which a point between those misses the least distance.
double spacing(const Observer& observer, const std::vector<glm::dvec3>& points) {
  double most = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    most = std::max(most, distance(observer, points[i - 1], points[i]));
  return 0.5 * most;
}

/// Of all sizes, and some close to the light; now and then a sphere, or all but one, or without a radius.
Capsule any_capsule(tests::Random& random) {
  const glm::dvec3 from =
      random.uniform() < 0.3 ? random.logarithmic(1e-3, 5.0) * random.direction() : random.in_box(5.0);
  const double length = random.uniform() < 0.5 ? random.uniform(2.0, 8.0) : random.logarithmic(1e-7, 5.0);
  const bool is_sphere = random.uniform() < 0.2, is_thin = random.uniform() < 0.1;
  const glm::vec3 to = is_sphere ? glm::vec3(from) : glm::vec3(from + length * random.direction());
  return {glm::vec3(from), to, static_cast<float>(is_thin ? 0.0 : random.logarithmic(1e-4, 2.0))};
}

/// Points of a capsule, most of them on its surface.
std::vector<glm::dvec3> points_in(const Capsule& capsule, tests::Random& random, int count) {
  std::vector<glm::dvec3> points;
  for (int i = 0; i < count; ++i) {
    const double t = i % 3 == 0 ? 0.0 : i % 3 == 1 ? 1.0 : random.uniform();
    const glm::dvec3 from(capsule.from), to(capsule.to);
    points.push_back(from + t * (to - from) +
                     (1.0 - 1e-9) * static_cast<double>(capsule.radius) * random.direction());
  }
  return points;
}

TEST(Apparent, DistancesAreAnglesOrThoseOfFeet) {
  const Observer lamp{{vec3(0.0f), false}, k_angle_error};
  EXPECT_NEAR(distance_between(lamp, {1, 0, 0}, {0, 1, 0}), std::numbers::pi / 2, 1e-6);
  EXPECT_NEAR(distance_between(lamp, {1, 0, 0}, {-1, 0, 0}), std::numbers::pi, 1e-6);
  EXPECT_EQ(distance_between(lamp, {1, 0, 0}, {1, 0, 0}), 0.0f);
  EXPECT_NEAR(distance_to_arc(lamp, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), std::numbers::pi / 2, 1e-6);
  const float h = std::sqrt(0.5f);
  EXPECT_NEAR(distance_to_arc(lamp, {1, 0, 0}, {0, 1, 0}, {h, 0, h}), std::numbers::pi / 4, 1e-6)
      << "at an end";
  EXPECT_NEAR(distance_to_arc(lamp, {1, 0, 0}, {0, 1, 0}, {0.5f, 0.5f, h}), std::numbers::pi / 4, 1e-6);
  EXPECT_NEAR(distance_to_arc(lamp, {1, 0, 0}, {0, 1, 0}, {-h, -h, 0}), 0.75 * std::numbers::pi, 1e-6);
  const Observer sun{{vec3(0, -1, 0), true}, 1e-5f};
  EXPECT_EQ(place_of(sun, {1, 7, 2}), vec3(1, 0, 2));
  EXPECT_EQ(distance_to_arc(sun, {0, 0, 0}, {2, 0, 0}, {1, 0, 3}), 3.0f);
  EXPECT_EQ(distance_to_arc(sun, {0, 0, 0}, {2, 0, 0}, {5, 0, 4}), 5.0f);
  EXPECT_EQ(distance_of_arcs(sun, {{0, 0, 0}, {2, 0, 0}, 0}, {{1, 0, -1}, {1, 0, 1}, 0}), 0.0f) << "crossed";
}

TEST(Apparent, ArcsThatCrossAreNoDistanceApartAndOthersAre) {
  tests::Random random(1);
  int crossed = 0;
  for (int i = 0; i < 3000; ++i) {
    for (const Observer& observer : observers(random)) {
      const Capsule a = any_capsule(random), b = any_capsule(random);
      const SeenCapsule seen_a = seen_capsule(observer, a), seen_b = seen_capsule(observer, b);
      if (seen_a.is_all || seen_b.is_all) continue;
      const std::vector<glm::dvec3> of_a = points_between(glm::dvec3(a.from), glm::dvec3(a.to)),
                                    of_b = points_between(glm::dvec3(b.from), glm::dvec3(b.to));
      double least = 1e30;
      for (std::size_t k = 0; k < of_b.size(); k += 16)
        least = std::min(least, distance_of_points(observer, of_a, of_b[k]));
      const double found = static_cast<double>(distance_of_arcs(observer, seen_a.apparent, seen_b.apparent));
      const double error = static_cast<double>(observer.error);
      EXPECT_LT(found, least + error) << i;
      EXPECT_GT(found, least - spacing(observer, of_a) - 16.0 * spacing(observer, of_b) - error) << i;
      if (found == 0.0) ++crossed;
    }
  }
  EXPECT_GT(crossed, 30);
}

TEST(Apparent, ACapsuleIsSeenWithinItsWidthAndNoNearerThanItsDepth) {
  tests::Random random(2);
  int seen_everywhere = 0;
  for (int i = 0; i < 20000; ++i) {
    for (const Observer& observer : observers(random)) {
      const Capsule capsule = any_capsule(random);
      const SeenCapsule seen = seen_capsule(observer, capsule);
      if (seen.is_all) {
        ++seen_everywhere;
        continue;
      }
      const Apparent& apparent = seen.apparent;
      for (const glm::dvec3& point : points_in(capsule, random, 6)) {
        const vec3 place = place_of(observer, vec3(point));
        EXPECT_LE(distance_to_arc(observer, apparent.from, apparent.to, place),
                  apparent.width + observer.error)
            << i;
        const double depth =
            observer.rays.is_sun ? glm::dot(glm::dvec3(observer.rays.travels), point) : glm::length(point);
        EXPECT_LE(static_cast<double>(seen.depth), depth + 1e-7 * k_reach) << i;
      }
    }
  }
  EXPECT_GT(seen_everywhere, 100);
  EXPECT_LT(seen_everywhere, 10000);
}

TEST(Apparent, NearAndFarHoldOfAllThatIsSeenOfACapsule) {
  tests::Random random(3);
  for (int i = 0; i < 20000; ++i) {
    for (const Observer& observer : observers(random)) {
      const Capsule pivot = any_capsule(random), other = any_capsule(random);
      const SeenCapsule seen_pivot = seen_capsule(observer, pivot),
                        seen_other = seen_capsule(observer, other);
      if (seen_pivot.is_all || seen_other.is_all) continue;
      const vec2 bounds = distances_to(observer, seen_pivot.apparent, seen_other.apparent);
      for (const glm::dvec3& point : points_in(other, random, 6)) {
        const float found = distance_to_arc(observer, seen_pivot.apparent.from, seen_pivot.apparent.to,
                                            place_of(observer, vec3(point)));
        // What a decision allows for: these are all the roundings between insertion and query.
        EXPECT_GE(found, bounds.x - k_decisions * observer.error) << i;
        EXPECT_LE(found, bounds.y + k_decisions * observer.error) << i;
      }
    }
  }
}

TEST(Apparent, TheFarthestOfAnArcNeedNotBeAnEnd) {
  // Along a parallel in the north, seen from a pivot on its other side: the arc's middle lies beyond its
  // ends.
  const Observer lamp{{vec3(0.0f), false}, k_angle_error};
  const vec3 pivot(0, -1, 0);
  const auto at = [](double longitude) {
    return vec3(static_cast<float>(std::cos(1.2) * std::cos(longitude)), static_cast<float>(std::sin(1.2)),
                static_cast<float>(std::cos(1.2) * std::sin(longitude)));
  };
  const Apparent arc{at(-1.0), at(1.0), 0.0f};
  const float at_ends = distance_between(lamp, pivot, arc.from);
  const float at_middle = distance_between(lamp, pivot, middle_of(lamp, arc.from, arc.to));
  EXPECT_GT(at_middle, at_ends + 0.1f);
  EXPECT_GE(distances_to(lamp, {pivot, pivot, 0.1f}, arc).y, at_middle);
}

TEST(Apparent, SlabsLeaveOutNoWayThatPassesTheCluster) {
  tests::Random random(4);
  int left_out = 0;
  for (int i = 0; i < 50000; ++i) {
    for (const Observer& observer : observers(random)) {
      const Capsule capsule = any_capsule(random);
      const glm::dvec3 axis = random.direction();
      const std::vector<glm::dvec3> points = points_in(capsule, random, 4);
      double lower = 1e30, upper = -1e30;
      const vec3 axis_32(axis);
      for (const glm::dvec3& point : points) {
        const double height = glm::dot(glm::dvec3(axis_32), point - glm::dvec3(capsule.from));
        lower = std::min(lower, height);
        upper = std::max(upper, height);
      }
      const auto passes = [&](glm::dvec3 end) {
        const glm::dvec3 to_light =
            observer.rays.is_sun ? -2.0 * k_reach * glm::dvec3(observer.rays.travels) : -end;
        return passes_slabs(capsule, axis_32, static_cast<float>(lower - 1e-7),
                            static_cast<float>(upper + 1e-7), vec3(end), vec3(to_light));
      };
      // A point in the light's way beyond one of the cluster.
      const double beyond = random.uniform() < 0.5 ? random.logarithmic(1e-6, 1.0) : random.uniform(0.0, 3.0);
      const glm::dvec3 behind = observer.rays.is_sun ? points[0] + beyond * glm::dvec3(observer.rays.travels)
                                                     : points[0] * (1.0 + beyond);
      EXPECT_TRUE(passes(behind)) << i;
      if (!passes(random.in_box(8.0))) ++left_out;
    }
  }
  EXPECT_GT(left_out, 20000);
}

TEST(Apparent, FrontsAreThoseOfTrianglesThatFaceTheLight) {
  tests::Random random(5);
  int fronts = 0;
  for (int i = 0; i < 100000; ++i) {
    for (const Observer& observer : observers(random)) {
      // A triangle alone, of any shape; a sphere about its corners.
      const glm::dvec3 a = random.in_box(5.0);
      const double size = random.logarithmic(1e-4, 3.0);
      const glm::dvec3 ab = size * random.direction();
      const glm::dvec3 ac = random.uniform() * ab + size * random.logarithmic(1e-7, 1.0) * random.direction();
      const std::array<vec3, 3> corners = {vec3(a), vec3(a + ab), vec3(a + ac)};
      const glm::dvec3 exact_a(corners[0]), exact_b(corners[1]), exact_c(corners[2]);
      const glm::dvec3 normal = glm::cross(exact_b - exact_a, exact_c - exact_a);
      if (glm::length(normal) == 0.0) continue;
      const double longest = std::max({glm::distance(exact_a, exact_b), glm::distance(exact_b, exact_c),
                                       glm::distance(exact_c, exact_a)});
      const Capsule capsule{corners[0], corners[0], static_cast<float>(1.0001 * longest)};
      const SeenCapsule seen = seen_capsule(observer, capsule);
      if (!shows_fronts(observer, capsule, seen, vec3(glm::normalize(normal)), 1e-7f,
                        static_cast<float>(0.999 * glm::length(normal) / longest)))
        continue;
      ++fronts;
      // Corners relative to the light are rounded.
      std::array<vec3, 3> moved = corners;
      for (vec3& corner : moved)
        for (int k = 0; k < 3; ++k)
          corner[k] *= 1.0f + static_cast<float>(random.uniform(-1.0, 1.0)) * 1.2e-7f;
      EXPECT_LT(turn_of(observer.rays, moved[0], moved[1], moved[2]), 0.0f) << i;
    }
  }
  EXPECT_GT(fronts, 5000);
}

/// Errors upwards, downwards, and by chance.
class ApparentInRoughArithmetic : public testing::TestWithParam<int> {
 public:
  ApparentInRoughArithmetic() { rough::Rough::lean = GetParam(); }
};

double exact(rough::Rough value) {
  return static_cast<double>(static_cast<float>(value));
}

rough::vec3 rough_point(const vec3& v) {
  return {v.x, v.y, v.z};
}

TEST_P(ApparentInRoughArithmetic, DistancesKeepTheirError) {
  tests::Random random(6);
  for (int i = 0; i < 20000; ++i) {
    for (const Observer& observer : observers(random)) {
      const rough::Observer who{{rough_point(observer.rays.travels), observer.rays.is_sun}, observer.error};
      const Capsule capsule = any_capsule(random);
      if (seen_capsule(observer, capsule).is_all) continue;
      const vec3 from = capsule.from, to = capsule.to;
      const vec3 point = random.uniform() < 0.5
                             ? vec3(random.in_box(5.0))
                             : vec3(glm::dvec3(from) + random.logarithmic(1e-7, 1.0) * random.direction());
      const rough::vec3 place = place_of(who, rough_point(point)),
                        seen_from = place_of(who, rough_point(from)),
                        seen_to = place_of(who, rough_point(to));
      EXPECT_NEAR(exact(distance_between(who, seen_from, place)),
                  distance(observer, glm::dvec3(from), glm::dvec3(point)),
                  static_cast<double>(observer.error));
      const std::vector<glm::dvec3> between = points_between(glm::dvec3(from), glm::dvec3(to));
      const double least = distance_of_points(observer, between, glm::dvec3(point));
      const double found = exact(distance_to_arc(who, seen_from, seen_to, place));
      EXPECT_LE(found, least + static_cast<double>(observer.error));
      EXPECT_GE(found, least - spacing(observer, between) - static_cast<double>(observer.error));
    }
  }
}

// Limits where a capsule without width is just near of them, or just far; a query rounds as badly as it can.
TEST_P(ApparentInRoughArithmetic, APointIsOnTheSideOfItsCapsule) {
  tests::Random random(7);
  int near = 0, far = 0;
  for (int i = 0; i < 20000; ++i) {
    for (const Observer& observer : observers(random)) {
      const rough::Observer who{{rough_point(observer.rays.travels), observer.rays.is_sun}, observer.error};
      const float slack = k_decisions * observer.error;
      const auto any_place = [&] { return place_of(who, rough_point(vec3(random.in_box(5.0)))); };
      const rough::vec3 from = any_place(), to = i % 2 == 0 ? from : any_place(), other = any_place();
      const rough::vec2 distances = distances_to(who, {from, to, 0.0f}, {other, other, 0.0f});
      const rough::Rough found = distance_to_arc(who, from, to, other);
      for (int step = -3; step <= 3; ++step) {
        for (const double beyond : {exact(distances.y) + static_cast<double>(slack),
                                    exact(distances.x) - static_cast<double>(slack)}) {
          const rough::Rough limit(static_cast<float>(beyond * (1.0 + 1e-7 * step)));
          const uint side = side_of(distances, limit, slack);
          if (side == k_near) {
            ++near;
            EXPECT_TRUE(found <= limit) << i;
          }
          if (side == k_far) {
            ++far;
            EXPECT_TRUE(found > limit) << i;
          }
        }
      }
    }
  }
  EXPECT_GT(near, 10000);
  EXPECT_GT(far, 10000);
}

INSTANTIATE_TEST_SUITE_P(Leaning, ApparentInRoughArithmetic, testing::Values(-1, 0, 1));

}  // namespace
}  // namespace airlight::shaders
