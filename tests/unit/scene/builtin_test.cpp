#include "scene/builtin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace airlight::scene {
namespace {

using testing::ElementsAre;

/// Whether any triangle cuts the open segment. Every triangle is tried: slow, and without a way to be wrong
/// cleverly.
bool is_blocked(const Geometry& geometry, glm::dvec3 from, glm::dvec3 to) {
  const glm::dvec3 d = to - from;
  for (glm::uvec3 triangle : geometry.triangles) {
    // Möller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997.
    const glm::dvec3 a = geometry.positions[triangle.x];
    const glm::dvec3 e1 = glm::dvec3(geometry.positions[triangle.y]) - a;
    const glm::dvec3 e2 = glm::dvec3(geometry.positions[triangle.z]) - a;
    const glm::dvec3 p = glm::cross(d, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0.0) continue;
    const glm::dvec3 s = (from - a) / determinant, q = glm::cross(s, e1);
    const double u = glm::dot(s, p), v = glm::dot(d, q), t = glm::dot(e2, q);
    if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < 1.0) return true;
  }
  return false;
}

/// The number of edges that are not shared by exactly two triangles which run along them in opposite
/// directions.
std::size_t open_edges(const Geometry& geometry) {
  std::map<std::pair<glm::uint, glm::uint>, int> count;
  for (glm::uvec3 t : geometry.triangles)
    for (int i = 0; i < 3; ++i) ++count[{t[i], t[(i + 1) % 3]}];
  std::size_t open = 0;
  for (const auto& [edge, number] : count) {
    const auto back = count.find({edge.second, edge.first});
    open += number != 1 || back == count.end() || back->second != 1;
  }
  return open;
}

/// Six times the volume that the triangles enclose; positive when they face outwards.
double signed_volume(const Geometry& geometry) {
  double volume = 0.0;
  for (glm::uvec3 t : geometry.triangles)
    volume += glm::dot(glm::dvec3(geometry.positions[t.x]),
                       glm::cross(glm::dvec3(geometry.positions[t.y]), glm::dvec3(geometry.positions[t.z])));
  return volume;
}

/// For each vertex one that stands for its piece: those connected by triangles.
std::vector<glm::uint> pieces_of(const Geometry& geometry) {
  std::vector<glm::uint> root(geometry.positions.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](glm::uint i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (glm::uvec3 t : geometry.triangles) {
    root[find(t.x)] = find(t.y);
    root[find(t.y)] = find(t.z);
  }
  for (glm::uint i = 0; i < root.size(); ++i) root[i] = find(i);
  return root;
}

/// The number of pieces, connected by indices, whose triangles face inwards.
std::size_t parts_inside_out(const Geometry& geometry) {
  const std::vector<glm::uint> piece = pieces_of(geometry);
  std::map<glm::uint, Geometry> parts;
  for (glm::uvec3 t : geometry.triangles) {
    // About a point of its own: a small part far from the origin has a volume of few digits.
    const glm::uint part = piece[t.x];
    Geometry& own = parts[part];
    const auto first = static_cast<glm::uint>(own.positions.size());
    for (int i = 0; i < 3; ++i) own.positions.push_back(geometry.positions[t[i]] - geometry.positions[part]);
    own.triangles.emplace_back(first, first + 1, first + 2);
  }
  return static_cast<std::size_t>(
      std::ranges::count_if(parts, [](const auto& part) { return !(signed_volume(part.second) > 0.0); }));
}

TEST(Builtin, NamesAreKnownAndTheWindowIsTheDefault) {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtin_scenes()) names.emplace_back(scene.name);
  EXPECT_THAT(names, ElementsAre("window", "nave", "fence", "forest", "jali", "chapel", "lighthouse",
                                 "harbour", "spheres", "toroid", "cornell", "empty", "half-space", "sphere"));
  for (const std::string& name : names) {
    ASSERT_NE(find_builtin(name), nullptr);
    EXPECT_EQ(find_builtin(name)->name, name);
  }
  EXPECT_EQ(find_builtin("Window"), nullptr);
  EXPECT_EQ(find_builtin(""), nullptr);
}

class EachBuiltin : public testing::TestWithParam<std::string> {};

TEST_P(EachBuiltin, IsCompleteAndKeepsTheContractOfGeometry) {
  const BuiltinScene* builtin = find_builtin(GetParam());
  ASSERT_NE(builtin, nullptr);
  EXPECT_FALSE(builtin->description.empty());
  EXPECT_EQ(builtin->description.find('\n'), std::string_view::npos);

  const Scene scene = builtin->make();
  EXPECT_EQ(scene.name, GetParam());
  EXPECT_GT(scene.exposure.value_or(0.0f), 0.0f);
  ASSERT_EQ(scene.cameras.size(), 1u);
  ASSERT_FALSE(scene.lights.empty());
  EXPECT_FALSE(scene.cameras[0].name.empty());
  std::set<std::string> names;
  for (const Light& light : scene.lights) names.insert(light.name);
  EXPECT_EQ(names.size(), scene.lights.size()) << "each light has a name of its own";
  EXPECT_FALSE(names.contains(""));
  EXPECT_NO_THROW(validate({scene.cameras[0], scene.lights, scene.medium, {64, 36}}));

  const Geometry& geometry = scene.geometry;
  ASSERT_EQ(geometry.material_of_triangle.size(), geometry.triangles.size());
  for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
    const glm::uvec3 t = geometry.triangles[i];
    ASSERT_LT(std::max({t.x, t.y, t.z}), geometry.positions.size());
    ASSERT_LT(geometry.material_of_triangle[i], geometry.materials.size());
    const glm::dvec3 a = geometry.positions[t.x], b = geometry.positions[t.y], c = geometry.positions[t.z];
    ASSERT_GT(glm::length(glm::cross(b - a, c - a)), 0.0) << "triangle " << i << " has no area";
  }
  for (glm::vec3 p : geometry.positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
  for (const Material& m : geometry.materials)
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(m.albedo[i] >= 0.0f && m.albedo[i] <= 1.0f);
}

INSTANTIATE_TEST_SUITE_P(Builtin, EachBuiltin,
                         testing::Values("window", "nave", "fence", "forest", "jali", "chapel", "lighthouse",
                                         "harbour", "spheres", "toroid", "cornell", "empty", "half-space",
                                         "sphere"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(Builtin, SolidsAreClosedAndFaceOutwards) {
  for (const char* name :
       {"window", "nave", "fence", "lighthouse", "harbour", "spheres", "toroid", "cornell", "sphere"}) {
    const Geometry geometry = find_builtin(name)->make().geometry;
    EXPECT_EQ(open_edges(geometry), 0u) << name;
    EXPECT_EQ(parts_inside_out(geometry), 0u) << name;
  }
}

TEST(Builtin, TheScreensOfTheJaliAreCutOutOfTwoTrianglesEach) {
  const Scene scene = find_builtin("jali")->make();
  Geometry solids = scene.geometry;
  solids.triangles.clear();
  for (std::uint32_t i = 0; i < scene.geometry.triangles.size(); ++i)
    if (!is_cut_out(scene.geometry, i)) solids.triangles.push_back(scene.geometry.triangles[i]);
  EXPECT_EQ(scene.geometry.triangles.size() - solids.triangles.size(), 12u);
  EXPECT_EQ(open_edges(solids), 0u);
  EXPECT_EQ(parts_inside_out(solids), 0u);

  // Lines 0.105 m wide, 0.42 m apart, in three directions, cover 0.562 of a plane (400,000 points of it were
  // asked).
  const TextureImage& mask = scene.geometry.textures.at(0);
  const auto marble = std::ranges::count_if(mask.texels, [](const auto& texel) { return texel.a >= 128; });
  EXPECT_NEAR(static_cast<double>(marble) / static_cast<double>(mask.texels.size()), 0.562,
              0.01);  // texels are 3 mm wide

  const Scene flat = find_builtin("jali")->make({}, Looks::flat);
  EXPECT_FALSE(has_cut_outs(flat.geometry));
  EXPECT_TRUE(flat.geometry.textures.empty());
  EXPECT_EQ(flat.geometry.triangles, scene.geometry.triangles);
  EXPECT_THAT(flat.report.warnings, ElementsAre("alpha masks of materials ignored (1): surfaces are opaque"));
}

TEST(Builtin, KeepsItsCutOutsInAnotherColour) {
  Geometry geometry = find_builtin("jali")->make().geometry;
  override_albedo(geometry, glm::vec3(0));
  EXPECT_TRUE(has_cut_outs(geometry));
  for (const Material& material : geometry.materials) {
    EXPECT_EQ(material.albedo, glm::vec3(0));
    EXPECT_FALSE(material.texture);
  }
}

TEST(Builtin, IsTheSameEachTime) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Geometry first = builtin.make().geometry, second = builtin.make().geometry;
    EXPECT_EQ(first.positions, second.positions) << builtin.name;
    EXPECT_EQ(first.triangles, second.triangles) << builtin.name;
  }
}

/// A closed surface that bounds its parts from outside keeps both at any count of triangles.
void expect_closed(const Geometry& geometry) {
  EXPECT_EQ(open_edges(geometry), 0u);
  EXPECT_GT(signed_volume(geometry), 0.0);
  for (glm::uvec3 t : geometry.triangles) {
    const glm::dvec3 a = geometry.positions[t.x], b = geometry.positions[t.y], c = geometry.positions[t.z];
    ASSERT_GT(glm::length(glm::cross(b - a, c - a)), 0.0);
  }
}

TEST(Builtin, CountsOfTrianglesAreRoundedAsTheySay) {
  const BuiltinScene &spheres = *find_builtin("spheres"), &toroid = *find_builtin("toroid");
  EXPECT_EQ(spheres.make().geometry.triangles.size(), 137'860u);
  EXPECT_EQ(toroid.make().geometry.triangles.size(), 50'232u);
  EXPECT_EQ(spheres.make(2'000).geometry.triangles.size(), 2'000u) << "icosahedra";
  EXPECT_EQ(spheres.make(2'059).geometry.triangles.size(), 2'000u);
  EXPECT_EQ(spheres.make(2'060).geometry.triangles.size(), 2'060u) << "one of them with faces cut into four";
  EXPECT_EQ(spheres.make(8'000).geometry.triangles.size(), 8'000u);
  for (std::size_t count : {2'000, 3'333, 7'999, 20'000, 300'000}) {
    const Geometry some = spheres.make(count).geometry;
    EXPECT_LE(some.triangles.size(), count);
    EXPECT_GT(some.triangles.size() + 20 * (2 * 39 + 1), count) << "39² · 2000 is more than any of these";
    expect_closed(some);
  }
  for (std::size_t count : {1'000, 1'700, 2'500, 10'000, 100'000}) {
    const Geometry some = toroid.make(count).geometry;
    EXPECT_EQ(some.triangles.size() % 84, 0u);
    EXPECT_NEAR(static_cast<double>(some.triangles.size()) / static_cast<double>(count), 1.0,
                count < 9'000 ? 0.15 : 0.06)
        << "half a row of cells";
    expect_closed(some);
  }
}

TEST(Builtin, EmptyHasNoGeometry) {
  EXPECT_TRUE(find_builtin("empty")->make().geometry.triangles.empty());
}

TEST(Builtin, SphereIsRoundAndHasTheTrianglesItSays) {
  const Geometry geometry = find_builtin("sphere")->make().geometry;
  EXPECT_EQ(geometry.triangles.size(), 20480u);
  EXPECT_EQ(geometry.positions.size(), 10242u);
  for (glm::vec3 p : geometry.positions) EXPECT_NEAR(glm::length(p), 1.0f, 1e-6f);
}

TEST(Builtin, HalfSpaceShadowsOneQuarterOfSpaceAndNothingElse) {
  const Scene scene = find_builtin("half-space")->make();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-50.0, 50.0);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 point(coordinate(random), coordinate(random), coordinate(random));
    EXPECT_EQ(is_blocked(scene.geometry, scene.lights[0].position, point), point.x < 0.0 && point.y < 0.0)
        << point.x << " " << point.y << " " << point.z;
  }
}

TEST(Builtin, SphereShadowsACone) {
  const Scene scene = find_builtin("sphere")->make();
  const glm::dvec3 light = scene.lights[0].position;
  const double distance = glm::length(light);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> coordinate(-4.0, 4.0);
  int shadowed = 0;
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 point(coordinate(random), coordinate(random), coordinate(random));
    const double cosine = glm::dot(glm::normalize(point - light), -light / distance);
    const double nearest = distance * std::sqrt(1.0 - cosine * cosine);
    // The facets stay within 1e-3 of the unit sphere; points in it, and rays that graze it, prove nothing.
    if (std::abs(nearest - 1.0) < 2e-3 || glm::length(point) < 1.01) continue;
    const bool behind = nearest < 1.0 && glm::distance(point, light) > distance * cosine;
    EXPECT_EQ(is_blocked(scene.geometry, light, point), behind && cosine > 0.0);
    shadowed += behind;
  }
  EXPECT_GT(shadowed, 5);
}

TEST(Spheres, AreAHundredThatStandApart) {
  // Each sphere has vertices of its own, 10 n² + 2 of them, and a material of its own.
  const Geometry geometry = find_builtin("spheres")->make(8'000).geometry;
  constexpr std::size_t k_vertices = 42;
  ASSERT_EQ(geometry.positions.size(), 100 * k_vertices);
  std::vector<std::pair<glm::dvec3, double>> spheres;
  for (std::size_t i = 0; i < 100; ++i) {
    glm::dvec3 centre(0.0);
    for (std::size_t k = 0; k < k_vertices; ++k) centre += glm::dvec3(geometry.positions[i * k_vertices + k]);
    centre /= static_cast<double>(k_vertices);
    const double radius = glm::distance(centre, glm::dvec3(geometry.positions[i * k_vertices]));
    for (std::size_t k = 0; k < k_vertices; ++k)
      EXPECT_NEAR(glm::distance(centre, glm::dvec3(geometry.positions[i * k_vertices + k])), radius, 1e-5);
    for (const auto& [other, reach] : spheres) EXPECT_GT(glm::distance(centre, other), radius + reach);
    EXPECT_GT(glm::length(centre), radius) << "the lamp is in none";
    spheres.emplace_back(centre, radius);
  }
}

TEST(Fence, HasThousandsOfThinParts) {
  const std::size_t triangles = find_builtin("fence")->make().geometry.triangles.size();
  EXPECT_GE(triangles, 5'000u);
  EXPECT_LE(triangles, 60'000u);
}

TEST(Fence, StandsBetweenTheLampAndTheCamera) {
  const Scene scene = find_builtin("fence")->make();
  const glm::dvec3 light = scene.lights[0].position, eye = scene.cameras[0].eye;
  EXPECT_LT(light.z, -0.1);
  EXPECT_GT(eye.z, 1.0);
  EXPECT_FALSE(is_blocked(scene.geometry, eye, light)) << "the lamp is seen between two bars";
  // Along a level line through the gate, bars and gaps alternate.
  int changes = 0;
  bool was_blocked = false;
  for (int i = 0; i <= 400; ++i) {
    const bool blocked = is_blocked(scene.geometry, light, {light.x + 0.01 * (i - 200), light.y - 0.3, 0.6});
    changes += blocked != was_blocked;
    was_blocked = blocked;
  }
  EXPECT_GT(changes, 8);
}

/// What part of points within a box sees the light.
double lit_part(const Scene& scene, const Light& light, glm::dvec3 lower, glm::dvec3 upper, int points) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  int lit = 0;
  for (int i = 0; i < points; ++i) {
    const double x = part(random), y = part(random), z = part(random);
    const glm::dvec3 point = glm::mix(lower, upper, glm::dvec3(x, y, z));
    lit += !is_blocked(scene.geometry, point, is_sun(light) ? point + 200.0 * light.towards : light.position);
  }
  return static_cast<double>(lit) / points;
}

TEST(Forest, HasHundredsOfThousandsOfLeaves) {
  const std::size_t triangles = find_builtin("forest")->make().geometry.triangles.size();
  EXPECT_GE(triangles, 300'000u);
  EXPECT_LE(triangles, 500'000u);
}

TEST(Forest, ALowSunShinesTowardsTheCameraThroughGapsInTheLeaves) {
  const Scene scene = find_builtin("forest")->make();
  const Light& light = scene.lights[0];
  ASSERT_TRUE(is_sun(light));
  const Camera& camera = scene.cameras[0];
  const glm::dvec3 ahead = glm::normalize(camera.target - camera.eye);
  EXPECT_GT(glm::dot(ahead, light.towards), std::cos(glm::radians(0.5 * camera.vertical_fov_degrees)));
  EXPECT_TRUE(light.towards.y > 0.2 && light.towards.y < 0.4);
  const double lit = lit_part(scene, light, {-6, 0.8, -20}, {6, 5, 6}, 100);
  EXPECT_GT(lit, 0.1);
  EXPECT_LT(lit, 0.6);
}

TEST(Lighthouse, TwoBeamsShineOppositeWaysThroughBarsAndRigging) {
  const Scene scene = find_builtin("lighthouse")->make();
  ASSERT_GE(scene.lights.size(), 2u);
  const Light &beam = scene.lights[0], &back = scene.lights[1];
  ASSERT_TRUE(beam.cone && back.cone);
  EXPECT_EQ(beam.position, back.position);
  const auto level = [](glm::dvec3 v) { return glm::normalize(glm::dvec3(v.x, 0.0, v.z)); };
  EXPECT_LT(glm::dot(level(beam.cone->axis), level(back.cone->axis)), -0.999);
  EXPECT_LT(beam.cone->outer, glm::radians(15.0));
  // Along an upright arc through each beam, lit and dark alternate.
  for (const Light* light : {&beam, &back}) {
    const glm::dvec3 axis = light->cone->axis, across = glm::normalize(glm::cross(axis, {0, 1, 0}));
    int lit = 0, dark = 0;
    for (int i = -10; i <= 10; ++i) {
      for (int j = -10; j <= 10; ++j) {
        const glm::dvec3 way = axis + 0.012 * i * across + glm::dvec3(0.0, 0.012 * j, 0.0);
        (is_blocked(scene.geometry, light->position, light->position + 40.0 * way) ? dark : lit)++;
      }
    }
    EXPECT_GT(lit, 200) << light->name;
    EXPECT_GT(dark, 20) << light->name;
  }
}

TEST(Harbour, LampsGlowInALayerThatMastsAndTheCameraLookOutOf) {
  const Scene scene = find_builtin("harbour")->make();
  ASSERT_TRUE(scene.medium.top);
  const double top = *scene.medium.top;
  int lamps = 0;
  for (const Light& light : scene.lights) {
    if (is_sun(light)) continue;
    ++lamps;
    EXPECT_LT(light.position.y, top) << light.name;
    // Most of the fog about a lamp is lit by it, and not all.
    const double lit = lit_part(scene, light, light.position - glm::dvec3(4, 3, 4),
                                {light.position.x + 4, top, light.position.z + 4}, 200);
    EXPECT_GT(lit, 0.5) << light.name;
    EXPECT_LT(lit, 1.0) << light.name;
  }
  EXPECT_EQ(lamps, 6);
  EXPECT_GT(scene.cameras[0].eye.y, top + 2.0);
  EXPECT_LT(scene.cameras[0].target.y, top);
  EXPECT_GT(static_cast<double>(bounds(scene.geometry).upper.y), top + 8.0);
}

TEST(Toroid, HasSevenfoldSymmetry) {
  const Geometry geometry = find_builtin("toroid")->make().geometry;
  std::multiset<std::array<long, 3>> cells;
  constexpr double k_cell = 1e-3;  // [m], far less than an edge
  const auto cell = [&](glm::dvec3 p) {
    return std::array<long, 3>{std::lround(p.x / k_cell), std::lround(p.y / k_cell),
                               std::lround(p.z / k_cell)};
  };
  for (glm::vec3 p : geometry.positions) cells.insert(cell(p));
  const double angle = 2.0 * std::numbers::pi / 7.0, c = std::cos(angle), s = std::sin(angle);
  for (glm::dvec3 p : geometry.positions) {
    const auto at = cell({c * p.x - s * p.z, p.y, s * p.x + c * p.z});
    int found = 0;
    for (long x : {-1, 0, 1})
      for (long y : {-1, 0, 1})
        for (long z : {-1, 0, 1}) found += cells.contains({at[0] + x, at[1] + y, at[2] + z});
    ASSERT_GT(found, 0) << p.x << " " << p.y << " " << p.z;
  }
}

TEST(Toroid, IsOnePieceOfGenusFifteen) {
  const Geometry geometry = find_builtin("toroid")->make(5'000).geometry;
  // Euler's V − E + F = 2 − 2 · genus; a closed surface has three edges to two faces.
  const auto vertices = static_cast<long>(geometry.positions.size());
  const auto faces = static_cast<long>(geometry.triangles.size());
  EXPECT_EQ(vertices - faces / 2, 2 - 2 * 15);
  const std::vector<glm::uint> piece = pieces_of(geometry);
  const std::set<glm::uint> pieces(piece.begin(), piece.end());
  EXPECT_EQ(pieces.size(), 1u) << "and no vertex is unused";
}

TEST(Toroid, WrapsAboutTheLampAndHidesIt) {
  const Scene scene = find_builtin("toroid")->make(10'000);
  const glm::dvec3 light = scene.lights[0].position, eye = scene.cameras[0].eye;
  EXPECT_TRUE(is_blocked(scene.geometry, eye, light)) << "triangles cover the epipole";
  // Light leaves through holes all around, and stone stands in its way all around.
  for (int sector = 0; sector < 8; ++sector) {
    int blocked = 0, lit = 0;
    for (int i = 0; i < 200; ++i) {
      const double angle = 0.25 * std::numbers::pi * (sector + i % 20 / 20.0), up = 0.2 * (i / 20 - 3);
      const glm::dvec3 far = light + 20.0 * glm::dvec3(std::cos(angle), up, std::sin(angle));
      (is_blocked(scene.geometry, light, far) ? blocked : lit)++;
    }
    EXPECT_GT(blocked, 50) << sector;
    EXPECT_GT(lit, 10) << sector;
  }
}

TEST(Window, HasTheSizeOfAnExample) {
  const std::size_t triangles = find_builtin("window")->make().geometry.triangles.size();
  EXPECT_GE(triangles, 5'000u);
  EXPECT_LE(triangles, 60'000u);
}

/// The outline of a window under an equilateral arch [m].
struct Outline {
  double x, half_width, sill, spring;
  bool holds(double across, double y) const {
    return y > sill &&
           std::hypot(std::abs(across - x) + half_width, std::max(y - spring, 0.0)) < 2.0 * half_width;
  }
};

/// Whether a light ray meets the middle of the front wall inside a window's outline, stone bars disregarded.
bool passes_a_window(glm::dvec3 light, glm::dvec3 point) {
  const double t = (-8.5 - light.z) / (point.z - light.z);
  const glm::dvec3 at = light + t * (point - light);
  constexpr Outline k_windows[] = {{-4.0, 0.55, 2.2, 5.2}, {0.0, 2.3, 1.4, 5.0}, {4.0, 0.55, 2.2, 5.2}};
  return std::ranges::any_of(k_windows, [&](const Outline& window) { return window.holds(at.x, at.y); });
}

TEST(Window, LightEntersTheHallThroughTheWindowsAlone) {
  const Scene scene = find_builtin("window")->make();
  const glm::dvec3 light = scene.lights[0].position;
  std::vector<glm::dvec3> points;
  std::mt19937 random(3);
  const auto between = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  for (int i = 0; i < 600; ++i) points.push_back({between(-6, 6), between(0, 11), between(-8, 11)});
  // A millimetre off the seams of floor, ceiling and walls.
  const double near = 1e-3;
  for (int i = 0; i < 60; ++i) {
    const double x = between(-6, 6), y = between(0, 11), z = between(-8, 11);
    for (double side : {-6 + near, 6 - near}) {
      points.insert(points.end(),
                    {{side, near, z}, {side, 11 - near, z}, {side, y, -8 + near}, {side, y, 11 - near}});
    }
    points.insert(points.end(), {{x, near, -8 + near}, {x, 11 - near, -8 + near}, {x, near, 11 - near}});
  }
  int lit = 0;
  for (glm::dvec3 point : points) {
    const bool blocked = is_blocked(scene.geometry, light, point);
    lit += !blocked;
    if (passes_a_window(light, point)) continue;
    EXPECT_TRUE(blocked) << "light leaks to " << point.x << " " << point.y << " " << point.z;
  }
  EXPECT_GT(lit, 30) << "the windows let light in";
}

/// Whether a ray from the point to the sun of the nave meets the outer half of the south or the east wall
/// inside a window's outline.
bool passes_a_window_of_the_nave(glm::dvec3 towards, glm::dvec3 point) {
  for (double depth : {0.5, 0.9}) {
    const glm::dvec3 south = point + (8.6 + depth - point.x) / towards.x * towards;
    for (int bay = 0; bay < 7; ++bay)
      if (Outline{-29.0 + 6.0 * bay, 1.05, 2.8, 8.4}.holds(south.z, south.y)) return true;
    const glm::dvec3 east = point + (-32.0 - depth - point.z) / towards.z * towards;
    for (const Outline& window : {Outline{-6.75, 0.8, 3.2, 7.6}, {0.0, 2.6, 4.4, 9.2}, {6.75, 0.8, 3.2, 7.6}})
      if (window.holds(east.x, east.y)) return true;
  }
  return false;
}

TEST(Nave, TheSunEntersThroughTheWindowsAlone) {
  const Scene scene = find_builtin("nave")->make();
  const glm::dvec3 towards = scene.lights[0].towards;
  std::mt19937 random(4);
  const auto between = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 500; ++i) points.push_back({between(-8.6, 8.6), between(0, 11.2), between(-32, 10)});
  for (int i = 0; i < 100; ++i) points.push_back({between(-3, 3), between(11, 14.5), between(-32, 10)});
  const double near = 1e-3;
  for (int i = 0; i < 60; ++i) {
    const double x = between(-8.6, 8.6), y = between(0, 11), z = between(-32, 10);
    for (double side : {-8.6 + near, 8.6 - near})
      points.insert(points.end(),
                    {{side, near, z}, {side, 11.3 - near, z}, {side, y, -32 + near}, {side, y, 10 - near}});
    points.insert(points.end(), {{x, near, -32 + near}, {x, 11.3 - near, -32 + near}, {x, near, 10 - near}});
  }
  int lit = 0;
  for (glm::dvec3 point : points) {
    const bool blocked = is_blocked(scene.geometry, point, point + 100.0 * towards);
    lit += !blocked;
    if (passes_a_window_of_the_nave(towards, point)) continue;
    EXPECT_TRUE(blocked) << "light leaks to " << point.x << " " << point.y << " " << point.z;
  }
  EXPECT_GT(lit, 15) << "the windows let light in";
}

TEST(Nave, HasALowSunAheadOfACameraThatDoesNotSeeIt) {
  const Scene scene = find_builtin("nave")->make();
  const Light& light = scene.lights[0];
  ASSERT_TRUE(is_sun(light));
  EXPECT_GT(light.towards.x, 0.5);
  EXPECT_LT(light.towards.z, -0.1);
  EXPECT_TRUE(light.towards.y > 0.3 && light.towards.y < 0.5);
  const glm::dvec3 eye = scene.cameras[0].eye;
  EXPECT_TRUE(std::abs(eye.x) < 4.5 && eye.y > 0.0 && eye.y < 11.0 && eye.z > -32.0 && eye.z < 10.0);
  EXPECT_FALSE(scene.medium.top);
}

TEST(Window, LightIsOutsideAndTheCameraInside) {
  const Scene scene = find_builtin("window")->make();
  const glm::dvec3 light = scene.lights[0].position, eye = scene.cameras[0].eye;
  EXPECT_LT(light.z, -18.0) << "some ten metres beyond the wall";
  EXPECT_GT(light.y, 11.0) << "above the windows";
  EXPECT_TRUE(std::abs(eye.x) < 6.0 && eye.y > 0.0 && eye.y < 11.0 && std::abs(eye.z) < 8.0);
  EXPECT_TRUE(is_blocked(scene.geometry, eye, light)) << "the light itself stays out of sight";
}

}  // namespace
}  // namespace airlight::scene
