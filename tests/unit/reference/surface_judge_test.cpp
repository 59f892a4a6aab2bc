#include "reference/surface_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

#include <gtest/gtest.h>

#include "unit/reference/fixtures.h"

namespace airlight::reference {

void PrintTo(const SurfaceVerdict& v, std::ostream* out) {
  *out << (v.verdict == Verdict::lit ? "lit" : "dark") << (v.is_decided ? "" : ", undecided");
}

namespace {

constexpr SurfaceVerdict k_lit{Verdict::lit, true}, k_dark{Verdict::dark, true};
constexpr SurfaceVerdict k_lit_undecided{Verdict::lit, false}, k_dark_undecided{Verdict::dark, false};

std::uint32_t add(Triangles& triangles, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  const auto first = static_cast<std::uint32_t>(triangles.positions.size());
  triangles.positions.insert(triangles.positions.end(), {a, b, c});
  triangles.indices.emplace_back(first, first + 1, first + 2);
  return static_cast<std::uint32_t>(triangles.count() - 1);
}

/// A floor y = 0 below a lamp 10 above it, or a sun in the zenith; half-way up, what hides it.
class Room {
 public:
  explicit Room(bool is_sunny, glm::dvec3 eye = {2, 10, 2})
      : light_(is_sunny ? scene::sun("", {0, 1, 0}, {}) : scene::point_light("", {1, 10, -3}, {})),
        eye_(eye) {
    floor_ = add(triangles, {-30, 0, -30}, {60, 0, -30}, {-30, 0, 60});
  }

  Triangles triangles;

  /// @param at world space [m], relative to the floor's point below the lamp; under a sun, half of it
  SurfaceVerdict judge(glm::vec3 at) const { return judge(at, floor_); }
  SurfaceVerdict judge(glm::vec3 at, std::uint32_t on) const {
    return SurfaceJudge(triangles, light_, eye_).judge({point(at), on});
  }

  /// Adds a triangle at that height, given by how its shadow lies about the point below the lamp.
  void hide(float height, glm::vec2 a, glm::vec2 b, glm::vec2 c) {
    const auto corner = [&](glm::vec2 shadow) {
      const glm::vec2 at = scene::is_sun(light_) ? shadow : shadow * (1.0f - height / 10.0f);
      return below_lamp() + glm::vec3(at.x, height, at.y);
    };
    add(triangles, corner(a), corner(b), corner(c));
  }

  /// A point relative to what a judge has it relative to.
  glm::vec3 point(glm::vec3 at) const {
    return glm::vec3(glm::dvec3(below_lamp() + at) - (scene::is_sun(light_) ? eye_ : light_.position));
  }
  static glm::vec3 below_lamp() { return {1, 0, -3}; }

 private:
  scene::Light light_;
  glm::dvec3 eye_;
  std::uint32_t floor_;
};

class SurfaceJudgeRoom : public testing::TestWithParam<bool> {
 protected:
  Room room() const { return Room(GetParam()); }

  /// With a triangle whose shadow has the corners (−2, −2), (2, −2) and (−2, 2), round one way or the other.
  Room room_with_triangle(bool is_turned) const {
    Room made = room();
    if (is_turned)
      made.hide(5, {-2, -2}, {-2, 2}, {2, -2});
    else
      made.hide(5, {-2, -2}, {2, -2}, {-2, 2});
    return made;
  }
};

INSTANTIATE_TEST_SUITE_P(Lights, SurfaceJudgeRoom, testing::Bool(),
                         [](const auto& parameter) { return parameter.param ? "sun" : "lamp"; });

TEST_P(SurfaceJudgeRoom, WhatIsBehindATriangleIsDark) {
  for (bool is_turned : {false, true}) {
    const Room r = room_with_triangle(is_turned);
    EXPECT_EQ(r.judge({-1, 0, -1}), k_dark);
    EXPECT_EQ(r.judge({1.75f, 0, -1.875f}), k_dark);
    for (glm::vec3 outside : {glm::vec3(1, 0, 1), {0, 0, -2.5f}, {-2.5f, 0, 0}, {25, 0, -25}})
      EXPECT_EQ(r.judge(outside), k_lit);
  }
}

TEST_P(SurfaceJudgeRoom, EdgesHide) {
  for (bool is_turned : {false, true}) {
    const Room r = room_with_triangle(is_turned);
    for (glm::vec3 on_edge : {glm::vec3(0, 0, -2), {-2, 0, 0}, {0, 0, 0}, {0.5f, 0, -0.5f}, {2, 0, -2}})
      EXPECT_EQ(r.judge(on_edge), k_dark_undecided);
    constexpr float k_ulp = 0x1p-21f;  // of the points' coordinates
    EXPECT_EQ(r.judge({0, 0, -2 - k_ulp}), k_lit_undecided);
    EXPECT_EQ(r.judge({-2 - k_ulp, 0, 0}), k_lit_undecided);
    EXPECT_EQ(r.judge({0.5f + k_ulp, 0, -0.5f}), k_lit_undecided);
  }
}

TEST_P(SurfaceJudgeRoom, ASharedEdgeHides) {
  Room r = room();
  r.hide(5, {-2, -2}, {2, -2}, {-2, 2});
  r.hide(5, {2, 2}, {2, -2}, {-2, 2});
  EXPECT_EQ(r.judge({0, 0, 0}), k_dark) << "around the edge one or the other hides";
  EXPECT_EQ(r.judge({0.5f, 0, -0.5f}), k_dark);
  EXPECT_EQ(r.judge({2, 0, -2}), k_dark_undecided);
}

TEST_P(SurfaceJudgeRoom, WhatIsInFrontOfATriangleIsLit) {
  for (bool is_turned : {false, true}) {
    Room r = room_with_triangle(is_turned);
    const auto at_height = [&](float y) {
      return add(r.triangles, Room::below_lamp() + glm::vec3(-9, y, -9),
                 Room::below_lamp() + glm::vec3(9, y, -9), Room::below_lamp() + glm::vec3(-9, y, 9));
    };
    const std::uint32_t in_front = at_height(7), behind = at_height(3);
    EXPECT_EQ(r.judge({-0.25f, 7, -0.25f}, in_front), k_lit);
    EXPECT_EQ(r.judge({-0.25f, 3, -0.25f}, behind), k_dark);
    // On a surface that passes through the triangle.
    const std::uint32_t through = add(r.triangles, Room::below_lamp() + glm::vec3(-9, 0, -9),
                                      Room::below_lamp() + glm::vec3(-9, 0, 9), {10, 10, -3});
    EXPECT_EQ(r.judge({-0.25f, 5, -0.25f}, through), k_dark) << "the triangle in front hides it";
    r.triangles.indices[in_front] = r.triangles.indices[through];
    EXPECT_EQ(r.judge({-0.25f, 5, -0.25f}, through), k_lit_undecided) << "in the triangle's plane";
  }
}

TEST_P(SurfaceJudgeRoom, ItsOwnTriangleAndThoseInItsPlaneDoNotHideAPoint) {
  Room r = room();
  const float below = -0x1p-20f;
  EXPECT_EQ(r.judge({1, below, 1}), k_lit);
  add(r.triangles, {-30, 0, -30}, {-30, 0, 60}, {60, 0, -30});
  add(r.triangles, {-40, 0, -20}, {-20, 0, 60}, {60, 0, -40});
  EXPECT_EQ(r.judge({1, below, 1}), k_lit);
  add(r.triangles, {-30, 0, -30}, {-30, 0, 60}, {60, -0x1p-30f, -30});
  EXPECT_EQ(r.judge({1, below, 1}), k_dark_undecided) << "that one is in another plane";
}

TEST_P(SurfaceJudgeRoom, ATriangleThatLiesAlongTheLightDoesNotHide) {
  Room r = room();
  add(r.triangles, Room::below_lamp() + glm::vec3(0, 1, -2), Room::below_lamp() + glm::vec3(0, 1, 2),
      Room::below_lamp() + glm::vec3(0, 6, 0));
  EXPECT_EQ(r.judge({0, 0, 0}), k_lit);
  EXPECT_EQ(r.judge({0, 0, 1}), k_lit);
}

TEST_P(SurfaceJudgeRoom, ASurfaceBetweenEyeAndLightIsDark) {
  const glm::vec3 at(9, 0, 9);
  EXPECT_EQ(Room(GetParam(), {5, 0.001, 5}).judge(at), k_lit);
  EXPECT_EQ(Room(GetParam(), {5, 0, 5}).judge(at), k_lit) << "the eye is in the floor's plane";
  EXPECT_EQ(Room(GetParam(), {5, -0.001, 5}).judge(at), k_dark);
  Room r(GetParam(), {5, -0.001, 5});
  const std::uint32_t under = add(r.triangles, {-30, -2, -30}, {60, -2, -30}, {-30, -2, 60});
  EXPECT_EQ(r.judge(at - glm::vec3(0, 2, 0), under), k_dark) << "the floor hides it";
  // Along the light.
  const std::uint32_t wall =
      add(r.triangles, Room::below_lamp() + glm::vec3(0, 1, 0), Room::below_lamp() + glm::vec3(0, 4, 0),
          Room::below_lamp() + glm::vec3(0, 1, 9));
  EXPECT_EQ(r.judge({0, 2, 1}, wall), k_lit);
}

TEST(SurfaceJudge, IsUndecidedAsFarFromAShadowsEdgeAsRoundingReaches) {
  Room r(false);
  r.hide(5, {-2, -2}, {2, -2}, {-2, 2});
  const SurfaceJudge judge(r.triangles, scene::point_light("", {1, 10, -3}, {}), {2, 10, 2});
  const double rounding = judge.rounding_of(0);
  EXPECT_DOUBLE_EQ(rounding, 63 * 0x1p-21 * std::sqrt(3.0)) << "of the floor's farthest corner";
  // Across the edge, which the light meets 10 below at a slope of 1/5.
  const auto at = [&](double roundings) {
    return r.judge({0, 0, static_cast<float>(-2 - roundings * rounding)});
  };
  EXPECT_EQ(at(0.6), k_lit_undecided);
  EXPECT_EQ(at(-0.6), k_dark_undecided);
  EXPECT_EQ(at(1.1), k_lit);
  EXPECT_EQ(at(-1.1), k_dark);
}

TEST(SurfaceJudge, VerticesAreRoundedAsTheFrameRoundsThem) {
  // Where the edge x of a triangle half-way down casts its shadow.
  const auto verdict = [](double lamp, float edge, float other, float point) {
    Triangles triangles;
    add(triangles, {edge, 5, -4}, {edge, 5, 4}, {other, 5, 0});
    const std::uint32_t floor = add(triangles, {-30, 0, -30}, {60, 0, -30}, {-30, 0, 60});
    const SurfaceJudge judge(triangles, scene::point_light("", {lamp, 10, 0}, {}), {2, 9, 2});
    return judge.judge({{point, -10, 0}, floor}).verdict;
  };
  // Single precision has the first two parts of this, each in a number of its own.
  const double in_three_parts = 1 + 0x1p-27 + 0x1p-52;
  EXPECT_EQ(verdict(in_three_parts, 1, 3, -0x1p-26f), Verdict::dark);
  EXPECT_EQ(verdict(in_three_parts, 1, 3, -0x1.000002p-26f), Verdict::lit);
  // The edge comes to 3 twice by a hair, and would not in one step.
  const double just_above_1 = 1 + 0x1p-23 + 0x1p-25;
  EXPECT_EQ(verdict(just_above_1, 4, 2, 6), Verdict::dark);
  EXPECT_EQ(verdict(just_above_1, 4, 2, 6 + 0x1p-21f), Verdict::lit);
}

TEST(SurfaceJudge, DecidesWhereDoublesCannot) {
  airlight::tests::Random random(5);
  int wrong_in_doubles = 0;
  for (int i = 0; i < 100; ++i) {
    // The light at the origin meets the edge (a, b) in a plane from which points with whole coordinates of
    // six digits are 10⁻¹² off.
    const auto [a, b, c] = tests::unit_volume(random);
    Triangles triangles;
    add(triangles, glm::vec3(a), glm::vec3(b), glm::vec3(2.0 * c));
    const std::uint32_t own = add(triangles, {0, -1, 0}, {1, -1, 0}, {0, -1, 1});
    const SurfaceJudge judge(triangles, scene::point_light("", {}, {}), {0.1, 0.1, 0.1});
    const auto verdict = [&](const glm::dvec3& point) {
      return judge.judge({glm::vec3(point), own}).verdict;
    };
    EXPECT_EQ(verdict(a + b + c), Verdict::dark);
    EXPECT_EQ(verdict(a + b), Verdict::dark);
    EXPECT_EQ(verdict(a + b - c), Verdict::lit);
    if (glm::dot(glm::cross(a, b), a + b - c) >= 0.0) ++wrong_in_doubles;
  }
  EXPECT_GT(wrong_in_doubles, 10) << "doubles would do";
}

TEST(SurfaceJudge, DecidesUnderASunWhereDoublesCannot) {
  airlight::tests::Random random(15);
  const auto whole = [&](double reach) { return glm::round(random.in_box(reach)); };
  int wrong_in_doubles = 0;
  for (int i = 0; i < 100; ++i) {
    // The sun's direction is whole in units of 2⁻²⁴, as all its parts are above one half.
    const double x = random.uniform(0.5, 0.6), y = random.uniform(0.5, 0.6);
    const scene::Light light = scene::sun("", {x, std::sqrt(1 - x * x - y * y), -y}, {});
    const glm::dvec3 along = -0x1p24 * glm::dvec3(glm::vec3(light.towards));
    // Light comes from the middle of an edge to the point, exactly.
    const glm::dvec3 middle = whole(0x1p20), half_edge = whole(0x1p20), across = whole(0x1p20);
    const glm::dvec3 point = middle + along;
    for (const double side : {1.0, -1.0}) {
      Triangles triangles;
      add(triangles, glm::vec3(middle - half_edge), glm::vec3(middle + half_edge),
          glm::vec3(middle + side * across));
      const std::uint32_t own = add(triangles, {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
      EXPECT_EQ(SurfaceJudge(triangles, light, {}).judge({glm::vec3(point), own}).verdict, Verdict::dark);
      const glm::dvec3 plane = side * glm::cross(along, 2.0 * half_edge);
      if (glm::dot(plane, point - middle + half_edge) * glm::dot(plane, across) < 0.0) ++wrong_in_doubles;
    }
  }
  EXPECT_GT(wrong_in_doubles, 10) << "doubles would do";
}

TEST(SurfaceJudge, SurfacesInOnePlaneAreTakenAsInTheWorld) {
  // Rounded relative to the light, the triangles are no longer in one plane, and some hide others' points.
  airlight::tests::Random random(6);
  Triangles triangles;
  for (int i = 0; i < 40; ++i) {
    const auto corner = [&] {
      const double x = std::floor(random.uniform(-500, 500)), z = std::floor(random.uniform(-500, 500));
      return glm::vec3(x, (3 * x - 5 * z) / 8, z);
    };
    add(triangles, corner(), corner(), corner());
  }
  const glm::dvec3 lamp(0.1, 400.7, 30.3), eye(10, 900, 10);
  for (const scene::Light& light : {scene::point_light("", lamp, {}), scene::sun("", {0.1, 0.7, 0.2}, {})}) {
    const SurfaceJudge judge(triangles, light, eye);
    const glm::dvec3 origin = scene::is_sun(light) ? eye : lamp;
    for (std::uint32_t i = 0; i < triangles.count(); ++i) {
      const Corners c = triangles.around(origin, i);
      EXPECT_EQ(judge.judge({glm::vec3(0.3 * c[0] + 0.3 * c[1] + 0.4 * c[2]), i}), k_lit);
    }
  }
}

/// Triangles whose corners' coordinates are multiples of four below 64, so that many points are exactly on
/// the edges of shadows, and points of theirs.
struct Lattice {
  Triangles triangles;
  std::vector<glm::i64vec3> corners;
  struct Point {
    glm::i64vec3 at;
    std::uint32_t triangle;
  };
  std::vector<Point> points;

  Lattice(std::uint32_t seed, int triangle_count, int point_count) {
    airlight::tests::Random random(seed);
    const auto whole = [&](double least, double beyond) {
      return static_cast<std::int64_t>(std::floor(random.uniform(least, beyond)));
    };
    while (static_cast<int>(triangles.count()) < triangle_count) {
      const glm::i64vec3 centre(whole(-12, 13), whole(-12, 13), whole(-12, 13));
      glm::i64vec3 c[3];
      for (glm::i64vec3& corner : c)
        corner = std::int64_t{4} * (centre + glm::i64vec3(whole(-3, 4), whole(-3, 4), whole(-3, 4)));
      if (normal({glm::dvec3(c[0]), glm::dvec3(c[1]), glm::dvec3(c[2])}) == glm::dvec3(0.0)) continue;
      corners.insert(corners.end(), c, c + 3);
      add(triangles, glm::vec3(c[0]), glm::vec3(c[1]), glm::vec3(c[2]));
    }
    for (int i = 0; i < point_count; ++i) {
      const auto triangle = static_cast<std::uint32_t>(whole(0, triangle_count));
      const std::int64_t u = whole(0, 5), v = whole(0, 5 - static_cast<double>(u));
      const glm::i64vec3* c = &corners[3 * triangle];
      points.push_back(
          {c[0] + u * (c[1] - c[0]) / std::int64_t{4} + v * (c[2] - c[0]) / std::int64_t{4}, triangle});
    }
  }
};

int sign_of_determinant(const glm::i64vec3& x, const glm::i64vec3& y, const glm::i64vec3& z) {
  const std::int64_t determinant =
      x.x * (y.y * z.z - y.z * z.y) + x.y * (y.z * z.x - y.x * z.z) + x.z * (y.x * z.y - y.y * z.x);
  return determinant > 0 ? 1 : determinant < 0 ? -1 : 0;
}

/// The verdict on a point in whole numbers, by every triangle.
/// @param lamp, eye in whole numbers
/// @param along     of a sun: where its light goes, times a power of two that makes it whole
Verdict verdict_of_all(const Lattice& lattice, const Lattice::Point& point, const glm::i64vec3& lamp,
                       const std::optional<glm::i64vec3>& along, const glm::i64vec3& eye) {
  const glm::i64vec3* own = &lattice.corners[3 * point.triangle];
  const auto side = [](const glm::i64vec3* c, const glm::i64vec3& p) {
    return sign_of_determinant(c[1] - c[0], c[2] - c[0], p - c[0]);
  };
  const int light_side =
      along ? sign_of_determinant(own[1] - own[0], own[2] - own[0], -*along) : side(own, lamp);
  if (light_side * side(own, eye) < 0) return Verdict::dark;

  for (std::uint32_t i = 0; i < lattice.triangles.count(); ++i) {
    const glm::i64vec3* c = &lattice.corners[3 * i];
    if (i == point.triangle || (side(own, c[0]) == 0 && side(own, c[1]) == 0 && side(own, c[2]) == 0))
      continue;
    // Light that goes where it comes from is turned by the triangle's corners one way.
    const auto turn = [&](const glm::i64vec3& from, const glm::i64vec3& to) {
      return along ? sign_of_determinant(*along, to - from, point.at - from)
                   : sign_of_determinant(from - lamp, to - lamp, point.at - lamp);
    };
    const int facing = along ? sign_of_determinant(*along, c[1] - c[0], c[2] - c[0]) : -side(c, lamp);
    if (facing != 0 && facing * turn(c[0], c[1]) >= 0 && facing * turn(c[1], c[2]) >= 0 &&
        facing * turn(c[2], c[0]) >= 0 && facing * side(c, point.at) > 0)
      return Verdict::dark;
  }
  return Verdict::lit;
}

/// Judges all points of a lattice at once, and expects of each what whole numbers say.
void expect_verdicts_of_all(const Lattice& lattice, const scene::Light& light, const glm::dvec3& eye) {
  std::optional<glm::i64vec3> along;
  if (scene::is_sun(light)) {
    const glm::dvec3 scaled = 0x1p26 * glm::dvec3(glm::vec3(light.towards));
    ASSERT_EQ(scaled, glm::round(scaled));
    along = -glm::i64vec3(scaled);
  }
  const glm::dvec3 origin = along ? eye : light.position;
  std::vector<SurfacePoint> points;
  for (const Lattice::Point& point : lattice.points)
    points.push_back({glm::vec3(glm::dvec3(point.at) - origin), point.triangle});
  const SurfaceJudge judge(lattice.triangles, light, eye);
  const std::vector<SurfaceVerdict> verdicts = judge.judge(points);
  ASSERT_EQ(verdicts.size(), points.size());

  int lit = 0, undecided = 0, separated = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(verdicts[i].verdict, verdict_of_all(lattice, lattice.points[i], glm::i64vec3(light.position),
                                                  along, glm::i64vec3(eye)))
        << "point " << i;
    EXPECT_EQ(judge.judge(points[i]), verdicts[i]) << "point " << i << " by itself";
    lit += verdicts[i].verdict == Verdict::lit ? 1 : 0;
    undecided += verdicts[i].is_decided ? 0 : 1;
    separated += judge.faces(points[i].triangle) ? 0 : 1;
  }
  const auto count = static_cast<int>(points.size());
  EXPECT_GT(lit, count / 20);
  EXPECT_GT(separated, count / 20);
  EXPECT_GT(count - lit - separated, count / 20) << "hidden";
  EXPECT_GT(undecided, count / 100) << "the points are to test edges";
}

TEST(SurfaceJudge, AgreesWithWholeNumbersAboutEveryTriangleUnderALamp) {
  expect_verdicts_of_all(Lattice(7, 150, 3000), scene::point_light("", {1, 2, -3}, {}), {40, 8, -16});
  expect_verdicts_of_all(Lattice(8, 150, 3000), scene::point_light("", {0, 0, 0}, {}), {4, 60, 4});
  expect_verdicts_of_all(Lattice(9, 150, 3000), scene::point_light("", {-8, 100, 4}, {}), {-4, 40, 20});
}

TEST(SurfaceJudge, AgreesWithWholeNumbersAboutEveryTriangleUnderASun) {
  expect_verdicts_of_all(Lattice(10, 150, 3000), scene::sun("", {1, 2, -2}, {}), {40, 8, -16});
  expect_verdicts_of_all(Lattice(11, 150, 3000), scene::sun("", {0, 1, 0}, {}), {3, 5, 7});
  expect_verdicts_of_all(Lattice(12, 150, 3000), scene::sun("", {-3, 4, 0}, {}), {-40, 11, 60});
}

/// Many triangles of all sizes about the origin, and points on them.
struct Soup {
  Triangles triangles;
  glm::dvec3 lamp{0.123456789, 0.3, -0.7}, towards{0.3, 0.8, -0.4}, eye{1.7, 1.3, 0.2};

  explicit Soup(std::uint32_t seed) {
    airlight::tests::Random random(seed);
    for (int i = 0; i < 10; ++i) {
      for (const Corners& c : tests::random_triangles(random, 3.0))
        add(triangles, glm::vec3(c[0]), glm::vec3(c[1]), glm::vec3(c[2]));
    }
  }

  scene::Light light(bool is_sunny, double scale = 1.0) const {
    return is_sunny ? scene::sun("", towards, {}) : scene::point_light("", scale * lamp, {});
  }

  std::vector<SurfacePoint> points(bool is_sunny, int count) const {
    airlight::tests::Random random(77);
    std::vector<SurfacePoint> made;
    for (int i = 0; i < count; ++i) {
      const auto triangle =
          static_cast<std::uint32_t>(random.uniform() * static_cast<double>(triangles.count()));
      const Corners c = triangles.around(is_sunny ? eye : lamp, triangle);
      const double u = random.uniform(), v = random.uniform(0, 1 - u);
      made.push_back({glm::vec3(c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0])), triangle});
    }
    return made;
  }
};

TEST(SurfaceJudge, IsUndecidedOnlyNextToShadowsEdgesAndSurfaces) {
  const Soup soup(13);
  for (bool is_sunny : {false, true}) {
    const scene::Light light = soup.light(is_sunny);
    const glm::dvec3 origin = is_sunny ? soup.eye : soup.lamp;
    const SurfaceJudge judge(soup.triangles, light, soup.eye);
    const std::vector<SurfacePoint> points = soup.points(is_sunny, 2000);
    const std::vector<SurfaceVerdict> verdicts = judge.judge(points);
    int near = 0, undecided = 0, hidden = 0, lit = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!judge.faces(points[i].triangle)) continue;
      const glm::dvec3 p(points[i].position);
      // How far from the point any plane is that bounds a shadow.
      double margin = std::numeric_limits<double>::infinity();
      bool is_hidden = false;
      for (std::uint32_t t = 0; t < soup.triangles.count(); ++t) {
        if (t == points[i].triangle) continue;
        const Corners c = soup.triangles.around(origin, t);
        const auto height = [&](const glm::dvec3& u, const glm::dvec3& v, const glm::dvec3& at) {
          return glm::dot(glm::normalize(glm::cross(u, v)), p - at);
        };
        const double heights[4] = {
            is_sunny ? height(-soup.towards, c[1] - c[0], c[0]) : height(c[0], c[1], {}),
            is_sunny ? height(-soup.towards, c[2] - c[1], c[1]) : height(c[1], c[2], {}),
            is_sunny ? height(-soup.towards, c[0] - c[2], c[2]) : height(c[2], c[0], {}),
            height(c[1] - c[0], c[2] - c[0], c[0])};
        const double facing = glm::dot(normal(c), is_sunny ? -soup.towards : c[0]);
        is_hidden |= std::all_of(heights, heights + 4, [&](double h) { return facing * h > 0.0; });
        for (const double h : heights) margin = std::min(margin, std::abs(h));
      }
      // The triangles of the frame are rounded too.
      if (margin < 1.5 * judge.rounding_of(points[i].triangle) + 1e-5) {
        ++near;
        undecided += verdicts[i].is_decided ? 0 : 1;
        continue;
      }
      (is_hidden ? hidden : lit) += 1;
      EXPECT_EQ(verdicts[i], is_hidden ? k_dark : k_lit) << "point " << i;
    }
    EXPECT_GT(hidden, 100);
    EXPECT_GT(lit, 100);
    EXPECT_LT(near, hidden + lit);
    EXPECT_LT(undecided, near + 1);
  }
}

TEST(SurfaceJudge, SaysTheSameAtAnyScale) {
  const Soup soup(14);
  for (bool is_sunny : {false, true}) {
    const std::vector<SurfacePoint> points = soup.points(is_sunny, 2000);
    const std::vector<SurfaceVerdict> verdicts =
        SurfaceJudge(soup.triangles, soup.light(is_sunny), soup.eye).judge(points);
    for (float scale : {0x1p10f, 0x1p-10f}) {
      Triangles scaled = soup.triangles;
      for (glm::vec3& position : scaled.positions) position *= scale;
      std::vector<SurfacePoint> scaled_points = points;
      for (SurfacePoint& point : scaled_points) point.position *= scale;
      const auto factor = static_cast<double>(scale);
      EXPECT_EQ(SurfaceJudge(scaled, soup.light(is_sunny, factor), factor * soup.eye).judge(scaled_points),
                verdicts);
    }
  }
}

TEST(SurfaceJudge, NothingHidesInAnEmptyScene) {
  Triangles triangles;
  const SurfaceJudge nothing(triangles, scene::point_light("", {}, {}), {1, 1, 1});
  EXPECT_TRUE(nothing.judge(std::span<const SurfacePoint>()).empty());
  const std::uint32_t only = add(triangles, {0, -1, 0}, {1, -1, 0}, {0, -1, 1});
  const SurfaceJudge judge(triangles, scene::point_light("", {}, {}), {1, 1, 1});
  EXPECT_EQ(judge.judge({{0.25f, -1, 0.25f}, only}), k_lit);
}

}  // namespace
}  // namespace airlight::reference
