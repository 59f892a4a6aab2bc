#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "epipolar/space.h"
#include "scene/import.h"
#include "support/random.h"
#include "support/rough_shaders.h"
#include "support/scenes.h"
#include "support/shared.h"

namespace airlight::shaders {
#include "voxelize_triangle.h"
}  // namespace airlight::shaders
namespace airlight::rough {
#include "voxelize_triangle.h"
}  // namespace airlight::rough

/// shaders/epipolar/conservative.glsl, triangle by triangle, so that none hides behind another: whatever
/// point of a triangle one picks, in double precision, its light ray is noted at its cell of α or before.
namespace airlight::epipolar {
namespace {

using shaders::EpipolarBlock;
using shaders::PhiCells;
using std::numbers::pi;

/// Single precision rounded to nearest, as CPUs do, or as badly as a GPU may.
enum class Arithmetic { single, rough };

/// What voxelizing single triangles notes, by light ray.
class Voxels {
 public:
  /// All half-planes share the range [phi_min, phi_max].
  Voxels(const scene::View& view, const Resolution& n, Ranges ranges, double phi_max,
         Arithmetic arithmetic = Arithmetic::single, double phi_min = 0.0)
      : Voxels(view, n, ranges, arithmetic) {
    const shaders::Angle largest(static_cast<float>(phi_max));
    const auto count = shaders::Cell(static_cast<float>(n.phi));
    cells_.assign(
        static_cast<std::size_t>(n.theta),
        shaders::own_cells(largest, k_growth, count, shaders::Angle(static_cast<float>(phi_min)), largest));
  }

  /// Each half-plane has the range of a box.
  Voxels(const scene::View& view, const Resolution& n, Ranges ranges, const scene::Box& box,
         Arithmetic arithmetic)
      : Voxels(view, n, ranges, arithmetic) {
    const std::vector<glm::vec2> of_planes = box_ranges(box, eye_, space_, n.theta);
    float phi_max = 0.0f;
    for (const glm::vec2 range : of_planes) phi_max = std::max(phi_max, range.y);
    const auto count = static_cast<float>(n.phi);
    for (const glm::vec2 range : of_planes) {
      if (arithmetic == Arithmetic::single) {
        cells_.push_back(shaders::own_cells(shaders::Angle(phi_max), k_growth, shaders::Cell(count),
                                            shaders::Angle(range.x), shaders::Angle(range.y)));
      } else {
        cells_.push_back(
            std::bit_cast<PhiCells>(rough::own_cells(rough::Angle(phi_max), k_growth, rough::Cell(count),
                                                     rough::Angle(range.x), rough::Angle(range.y))));
      }
    }
  }

  void voxelize(const std::array<glm::dvec3, 3>& corners) {
    ++current_;
    const auto alpha_count = static_cast<std::uint32_t>(n_.alpha),
               theta_count = static_cast<std::uint32_t>(n_.theta);
    const auto relative = [&](std::size_t i) { return glm::vec3(corners[i] - eye_); };
    const auto note_ = [this](std::uint32_t plane, std::uint32_t k, std::uint32_t first) {
      note(plane, k, first);
    };
    if (arithmetic_ == Arithmetic::single) {
      shaders::voxelize_triangle(
          space_, [&](std::uint32_t plane) { return cells_[plane]; }, relative(0), relative(1), relative(2),
          alpha_count, theta_count, note_);
    } else {
      rough::Rough::lean = static_cast<int>(current_ % 3) - 1;
      const auto rough = [&](std::size_t i) { return std::bit_cast<rough::vec3>(relative(i)); };
      rough::voxelize_triangle(
          std::bit_cast<rough::EpipolarBlock>(space_),
          [&](std::uint32_t plane) { return std::bit_cast<rough::PhiCells>(cells_[plane]); }, rough(0),
          rough(1), rough(2), alpha_count, theta_count, note_);
    }
  }

  /// A cell of the grid, as real numbers.
  struct Place {
    double alpha, theta, phi;  ///< [cells]
  };

  /// The point at (α, θ, φ), in cells; the inverse of place_of.
  glm::dvec3 point_at(const Place& place) const {
    const double phi = phi_at(place), alpha = alpha_at(place);
    const double y =
        place.theta * static_cast<double>(space_.theta_step) - static_cast<double>(space_.theta_half);
    double theta = y;
    for (int i = 0; i < 20; ++i) {
      const double g = static_cast<double>(space_.theta_growth);
      theta -= (theta + g * std::sin(theta) - y) / (1 + g * std::cos(theta));
    }
    theta += static_cast<double>(space_.theta_middle);
    const double t = is_sun_ ? phi / std::sin(alpha) : distance_ * std::sin(phi) / std::sin(alpha + phi);
    return eye_ + t * (std::sin(alpha) * (std::cos(theta) * axes_.u + std::sin(theta) * axes_.f) +
                       std::cos(alpha) * axes_.axis);
  }

  /// The angle between light ray and view ray [rad]: of a point in reach more than 0 and less than π.
  double opening(const Place& place) const { return alpha_at(place) + (is_sun_ ? 0.0 : phi_at(place)); }

  glm::dvec3 eye() const { return eye_; }

  /// Whether the grid covers a point in α and θ, and where.
  bool place_in_planes(glm::dvec3 point, Place& place) const {
    const glm::dvec3 p = point - eye_;
    const double x = glm::dot(p, axes_.u), y = glm::dot(p, axes_.f), z = glm::dot(p, axes_.axis);
    const double rho = std::hypot(x, y);
    place.alpha = spaced(std::atan2(rho, z)) / static_cast<double>(space_.alpha_step);
    const double from_middle =
        std::remainder(std::atan2(y, x) - static_cast<double>(space_.theta_middle), 2 * pi);
    place.theta = (from_middle + static_cast<double>(space_.theta_growth) * std::sin(from_middle) +
                   static_cast<double>(space_.theta_half)) /
                  static_cast<double>(space_.theta_step);
    if (!(rho > 0 && place.alpha < n_.alpha && place.theta >= 0 && place.theta < n_.theta)) return false;
    const PhiCells& cells = cells_[static_cast<std::size_t>(place.theta)];
    const double phi = is_sun_ ? rho : std::atan2(rho, distance_ - z);
    const double q = (1 + k_growth) * phi / static_cast<double>(cells.phi_max);
    const double of_range = 2 * q / (1 + std::sqrt(1 + 4 * k_growth * q));
    place.phi = (of_range - static_cast<double>(cells.first)) / static_cast<double>(cells.per_cell);
    return true;
  }

  bool covers_in_phi(const Place& place) const { return place.phi >= 0 && place.phi < n_.phi; }

  /// Whether the grid covers a point, and where.
  bool place_of(glm::dvec3 point, Place& place) const {
    return place_in_planes(point, place) && covers_in_phi(place);
  }

  bool holds(const Place& place) const {
    return at(static_cast<std::uint32_t>(place.theta), static_cast<std::uint32_t>(place.phi)) <=
           static_cast<std::uint32_t>(std::max(place.alpha, 0.0));
  }

  /// The cell noted by the current triangle.
  std::uint32_t at(std::uint32_t plane, std::uint32_t k) const {
    const std::size_t ray = std::size_t{plane} * static_cast<std::size_t>(n_.phi) + k;
    return stamp_[ray] == current_ ? first_[ray] : std::numeric_limits<std::uint32_t>::max();
  }

  std::size_t noted() const { return noted_; }  ///< light rays, over all triangles

 private:
  static constexpr float k_growth = 1.5f;

  Voxels(const scene::View& view, const Resolution& n, Ranges ranges, Arithmetic arithmetic)
      : n_(n),
        arithmetic_(arithmetic),
        eye_(view.camera.eye),
        is_sun_(scene::is_sun(view.lights[0])),
        distance_(is_sun_ ? 0.0 : glm::distance(view.lights[0].position, eye_)),
        axes_(make_axes(scene::direction_to(view.lights[0], eye_))),
        space_(epipolar_block(view, view.lights[0], n, ranges, ThetaCells::fitted)),
        first_(static_cast<std::size_t>(n.theta) * static_cast<std::size_t>(n.phi)),
        stamp_(first_.size()) {}

  /// α in what rows are equal in, from the first one.
  double spaced(double alpha) const {
    const auto start = static_cast<double>(space_.alpha_min);
    if (space_.alpha_spacing == shaders::k_root_of_alpha) return std::sqrt(alpha) - std::sqrt(start);
    if (space_.alpha_spacing == shaders::k_root_of_complement)
      return std::sqrt(pi - start) - std::sqrt(pi - alpha);
    return alpha - start;
  }

  double alpha_at(const Place& place) const {
    const auto start = static_cast<double>(space_.alpha_min);
    const double from_start = place.alpha * static_cast<double>(space_.alpha_step);
    if (space_.alpha_spacing == shaders::k_root_of_alpha) {
      const double root = std::sqrt(start) + from_start;
      return root > 0 ? root * root : -1;
    }
    if (space_.alpha_spacing == shaders::k_root_of_complement) {
      const double root = std::sqrt(pi - start) - from_start;
      return root > 0 ? pi - root * root : pi + 1;
    }
    return start + from_start;
  }

  /// Of half-planes that share their cells.
  double phi_at(const Place& place) const {
    const double x =
        static_cast<double>(cells_[0].first) + place.phi * static_cast<double>(cells_[0].per_cell);
    return static_cast<double>(cells_[0].phi_max) * x * (1 + k_growth * x) / (1 + k_growth);
  }

  void note(std::uint32_t plane, std::uint32_t k, std::uint32_t first) {
    const std::size_t ray = std::size_t{plane} * static_cast<std::size_t>(n_.phi) + k;
    noted_ += stamp_[ray] == current_ ? 0 : 1;
    first_[ray] = stamp_[ray] == current_ ? std::min(first_[ray], first) : first;
    stamp_[ray] = current_;
  }

  Resolution n_;
  Arithmetic arithmetic_;
  glm::dvec3 eye_;
  bool is_sun_;
  double distance_;
  Axes axes_;
  EpipolarBlock space_;
  std::vector<PhiCells> cells_;  // by half-plane
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> stamp_;
  std::uint32_t current_ = 0;
  std::size_t noted_ = 0;
};

std::array<glm::dvec3, 3> corners_of(const scene::Geometry& geometry, glm::uvec3 triangle) {
  return {glm::dvec3(geometry.positions[triangle.x]), glm::dvec3(geometry.positions[triangle.y]),
          glm::dvec3(geometry.positions[triangle.z])};
}

/// A point of a triangle: a corner, on an edge, or inside, in turn.
glm::dvec3 pick(const std::array<glm::dvec3, 3>& corners, int sample, tests::Random& random) {
  if (sample < 3) return corners[static_cast<std::size_t>(sample)];
  double a = random.uniform(), b = random.uniform();
  if (a + b > 1) {
    a = 1 - a;
    b = 1 - b;
  }
  if (sample % 2 == 1) (sample % 4 == 1 ? a : b) = sample % 8 < 4 ? 0.0 : 1 - (sample % 4 == 1 ? b : a);
  return corners[0] + a * (corners[1] - corners[0]) + b * (corners[2] - corners[0]);
}

struct Count {
  std::size_t points = 0, missed = 0;
};

/// Voxelizes every triangle by itself and looks for `samples` of its points.
Count look_for_points(const scene::Geometry& geometry, Voxels& voxels, int samples) {
  Count count;
  tests::Random random(3);
  for (const glm::uvec3 triangle : geometry.triangles) {
    const auto corners = corners_of(geometry, triangle);
    voxels.voxelize(corners);
    for (int sample = 0; sample < samples; ++sample) {
      Voxels::Place place{};
      if (!voxels.place_of(pick(corners, sample, random), place)) continue;
      ++count.points;
      count.missed += voxels.holds(place) ? 0 : 1;
    }
  }
  return count;
}

scene::View view_between(glm::dvec3 eye, glm::dvec3 target, glm::dvec3 light, double fov = 60) {
  scene::View view;
  view.camera.eye = eye;
  view.camera.target = target;
  view.camera.vertical_fov_degrees = fov;
  view.lights[0].position = light;
  view.size = {64, 64};
  return view;
}

scene::View view_under_sun(glm::dvec3 eye, glm::dvec3 target, glm::dvec3 towards) {
  scene::View view = view_between(eye, target, {});
  view.lights[0] = scene::sun("sun", towards, glm::vec3(1.0f));
  return view;
}

constexpr Resolution k_coarse{64, 256, 128};

/// Beyond what the tests' scenes have of φ: of a sun [m].
double largest_phi(const scene::View& view) {
  return scene::is_sun(view.lights[0]) ? 40.0 : pi;
}

void expect_every_point_found(const scene::Geometry& geometry, const scene::View& view, Ranges ranges,
                              int samples, const Resolution& n = k_coarse, std::optional<double> phi_max = {},
                              Arithmetic arithmetic = Arithmetic::single) {
  Voxels voxels(view, n, ranges, phi_max.value_or(largest_phi(view)), arithmetic);
  const Count count = look_for_points(geometry, voxels, samples);
  testing::Test::RecordProperty("points", static_cast<int>(count.points));
  EXPECT_GT(count.points, 0u);
  EXPECT_EQ(count.missed, 0u) << "of " << count.points;
}

struct Model {
  const char* name;
  glm::dvec3 eye, target, light;
};

void PrintTo(const Model& model, std::ostream* stream) {
  *stream << model.name;
}

class ConservativeModel : public testing::TestWithParam<Model> {};

TEST_P(ConservativeModel, EveryPointOfEveryTriangleIsInAVoxelOfItsOwn) {
  const Model& model = GetParam();
  const auto file = tests::shared_file(std::string("scenes/") + model.name + ".glb");
  AIRLIGHT_NEEDS(file);
  const scene::Scene scene = scene::import_scene(file);
  expect_every_point_found(scene.geometry, view_between(model.eye, model.target, model.light), Ranges::frame,
                           11);
  // The light behind the camera, and so a short range of φ.
  expect_every_point_found(scene.geometry,
                           view_between(model.light, 2.0 * model.light - model.eye, model.eye),
                           Ranges::alpha_phi, 7, k_coarse, 1.0);
}

TEST_P(ConservativeModel, UnderASunEveryPointOfEveryTriangleIsInAVoxelOfItsOwn) {
  const Model& model = GetParam();
  const auto file = tests::shared_file(std::string("scenes/") + model.name + ".glb");
  AIRLIGHT_NEEDS(file);
  const scene::Scene scene = scene::import_scene(file);
  expect_every_point_found(scene.geometry, view_under_sun(model.eye, model.target, model.light - model.eye),
                           Ranges::frame, 7);
  // One of its axes, along which walls are edge-on; and behind the camera.
  expect_every_point_found(scene.geometry, view_under_sun(model.eye, model.target, {0, 1, 0}), Ranges::frame,
                           7);
  expect_every_point_found(scene.geometry, view_under_sun(model.eye, model.target, model.eye - model.target),
                           Ranges::alpha_phi, 7, k_coarse, 3.0);
}

INSTANTIATE_TEST_SUITE_P(
    Shared, ConservativeModel,
    testing::Values(Model{"victorian_fence_19k", {0.3, 0.5, 3}, {0, 0.4, 0}, {-0.2, 0.7, -1}},
                    Model{"maple_198k", {-2, 2, 11}, {0.5, 3.8, 0}, {1.5, 5, -5}},
                    Model{"railing_degenerate_11k", {0.3, 0.5, 3}, {0, 0.4, 0}, {-0.2, 0.7, -1}},
                    Model{"sponza_262k", {-12, 3, -0.5}, {0, 5, 0}, {3, 7, 0}}));

/// Triangles of many sizes and shapes about eye and light.
scene::Geometry random_soup(int triangles, double largest, std::uint32_t seed) {
  tests::Random random(seed);
  scene::Geometry soup;
  for (int i = 0; i < triangles; ++i) {
    const glm::dvec3 middle = random.in_box(6.0);
    const double size = random.logarithmic(1e-5, largest),
                 thin = i % 3 == 0 ? random.logarithmic(1e-6, 1.0) : 1;
    const glm::dvec3 along = size * random.direction();
    tests::add_triangle(soup, glm::vec3(middle), glm::vec3(middle + along),
                        glm::vec3(middle + 0.5 * along + thin * size * random.direction()));
  }
  return soup;
}

class ConservativeSoup : public testing::TestWithParam<Resolution> {};

TEST_P(ConservativeSoup, EveryPointIsFound) {
  for (const Ranges ranges : {Ranges::full, Ranges::frame}) {
    const glm::dvec3 eye(0.4, -0.3, 3.0), light(-0.5, 0.6, -1.0);
    expect_every_point_found(random_soup(1500, 20.0, 1), view_between(eye, light, light), ranges, 40,
                             GetParam());
    expect_every_point_found(random_soup(500, 20.0, 2), view_between(eye, {3, 0, 3.5}, light), ranges, 40,
                             GetParam());
    expect_every_point_found(random_soup(500, 20.0, 3), view_between(eye, eye + eye - light, light), ranges,
                             40, GetParam());
  }
}

/// Towards a sun in the image, beside it, behind the camera, and straight up.
const std::array k_suns = {glm::dvec3(-0.9, 0.9, -4.0), glm::dvec3(3.0, 0.2, -1.0), glm::dvec3(0.6, 0.4, 3.0),
                           glm::dvec3(0.0, 1.0, 0.0)};

TEST_P(ConservativeSoup, UnderASunEveryPointIsFound) {
  const glm::dvec3 eye(0.4, -0.3, 3.0), target(-0.5, 0.6, -1.0);
  std::uint32_t seed = 20;
  for (const Ranges ranges : {Ranges::full, Ranges::frame}) {
    for (const glm::dvec3 towards : k_suns) {
      expect_every_point_found(random_soup(500, 20.0, seed++), view_under_sun(eye, target, towards), ranges,
                               40, GetParam());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Resolutions, ConservativeSoup,
                         testing::Values(Resolution{1, 1, 128}, Resolution{64, 3, 128},
                                         Resolution{64, 256, 128}, Resolution{256, 777, 256}));

class ConservativeIn : public testing::TestWithParam<Arithmetic> {};

TEST_P(ConservativeIn, AnyArithmeticEveryPointOfASoupIsFound) {
  const glm::dvec3 eye(0.4, -0.3, 3.0), light(-0.5, 0.6, -1.0);
  const Resolution n{256, 777, 256};
  for (const Ranges ranges : {Ranges::full, Ranges::frame}) {
    expect_every_point_found(random_soup(500, 20.0, 6), view_between(eye, light, light), ranges, 40, n, pi,
                             GetParam());
    expect_every_point_found(random_soup(200, 20.0, 7), view_between(eye, {3, 0, 3.5}, light), ranges, 40, n,
                             pi, GetParam());
    for (const glm::dvec3 towards : k_suns) {
      expect_every_point_found(random_soup(200, 20.0, 30), view_under_sun(eye, light, towards), ranges, 40, n,
                               40.0, GetParam());
    }
  }
}

/// Half-planes with ranges of their own: none is too short for what its slab holds of the scene.
TEST_P(ConservativeIn, AnyArithmeticEveryPointIsFoundInTheRangeOfItsOwnHalfPlane) {
  const glm::dvec3 target(-0.5, 0.6, -1.0);
  std::uint32_t seed = 40;
  // Inside the box, beside it, and far away.
  for (const glm::dvec3 eye :
       {glm::dvec3(0.4, -0.3, 3.0), glm::dvec3(3.0, 14.0, 9.0), glm::dvec3(-90.0, 20.0, 300.0)}) {
    std::vector<scene::View> views;
    for (const glm::dvec3 towards : k_suns) views.push_back(view_under_sun(eye, target, towards));
    for (const glm::dvec3 light : {target, glm::dvec3(20.0, 40.0, 3.0)})
      views.push_back(view_between(eye, target, light));
    for (const scene::View& view : views) {
      for (const Resolution n : {Resolution{16, 1, 128}, Resolution{64, 37, 128}, Resolution{64, 777, 256}}) {
        const scene::Geometry soup = random_soup(100, 4.0, seed++);
        scene::Box box;
        for (const glm::vec3 position : soup.positions) box.include(position);
        Voxels voxels(view, n, Ranges::frame, box, GetParam());
        tests::Random random(9);
        std::size_t points = 0, missed = 0, beyond = 0;
        for (const glm::uvec3 triangle : soup.triangles) {
          const auto corners = corners_of(soup, triangle);
          voxels.voxelize(corners);
          for (int sample = 0; sample < 40; ++sample) {
            Voxels::Place place{};
            if (!voxels.place_in_planes(pick(corners, sample, random), place)) continue;
            ++points;
            beyond += voxels.covers_in_phi(place) ? 0 : 1;
            missed += voxels.covers_in_phi(place) && !voxels.holds(place) ? 1 : 0;
          }
        }
        EXPECT_GT(points, 0u);
        EXPECT_EQ(beyond, 0u) << "of " << points;
        EXPECT_EQ(missed, 0u) << "of " << points;
      }
    }
  }
}

/// Where a triangle just reaches into a cell, no more than the rounding of its corner, the slack alone
/// decides.
TEST_P(ConservativeIn, AnyArithmeticATipIsFoundInTheCellThatItJustReaches) {
  tests::Random random(8);
  std::size_t tips = 0, missed = 0;
  std::vector<std::pair<scene::View, glm::dvec2>> views;  // and the range of φ
  const glm::dvec3 eye(0.4, -0.3, 3.0);
  for (const glm::dvec2 range :
       {glm::dvec2(0.0, pi), glm::dvec2(0.0, 1.0), glm::dvec2(0.0, 0.05), glm::dvec2(0.99, 1.0)}) {
    // The light ahead, off the image's middle so that planes are spaced unequally, and behind.
    for (const glm::dvec3 target :
         {glm::dvec3(0.0, 0.0, -1.0), glm::dvec3(1.2, 0.5, -1.0), glm::dvec3(0.5, 0.5, 9.0)}) {
      views.emplace_back(view_between(eye, target, {-0.5, 0.6, -1.0}), range);
      views.emplace_back(view_under_sun(eye, target, {-0.9, 0.9, -4.0}), 10.0 * range);
    }
  }
  for (const auto& [view, range] : views) {
    const Resolution n{128, 2503, 256};
    Voxels voxels(view, n, Ranges::frame, range.y, GetParam(), range.x);
    for (int sample = 0; sample < 500; ++sample) {
      // A corner on a boundary of one of the three angles, and two that lie before it or, in α, behind.
      Voxels::Place tip{random.uniform(0, n.alpha), random.uniform(0, n.theta), random.uniform(0, n.phi)};
      const int angle = sample % 3;
      double& on_boundary = angle == 0 ? tip.alpha : angle == 1 ? tip.theta : tip.phi;
      on_boundary = std::floor(on_boundary);
      const double side = angle == 0 || (angle == 1 && sample % 2 == 0) ? 1.0 : -1.0;
      std::array<Voxels::Place, 3> places{tip, tip, tip};
      bool is_in_reach = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const double size = i == 0 ? 0.0 : random.logarithmic(0.01, 6.0);
        places[i].alpha += size * (angle == 0 ? side * random.uniform() : random.uniform(-1, 1));
        places[i].theta += size * (angle == 1 ? side * random.uniform() : random.uniform(-1, 1));
        places[i].phi += size * (angle == 2 ? side * random.uniform() : random.uniform(-1, 1));
        is_in_reach = is_in_reach && voxels.opening(places[i]) < 3.0 && places[i].phi > 0 &&
                      voxels.opening(places[i]) > 0;
      }
      if (!is_in_reach) continue;
      std::array<glm::dvec3, 3> corners{};
      // Exact in single precision relative to the eye: a rounding puts the tip to either side.
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = voxels.eye() + glm::dvec3(glm::vec3(voxels.point_at(places[i]) - voxels.eye()));
      }
      Voxels::Place place{};
      if (!voxels.place_of(corners[0], place)) continue;
      voxels.voxelize(corners);
      ++tips;
      missed += voxels.holds(place) ? 0 : 1;
    }
  }
  EXPECT_GT(tips, 5000u);
  EXPECT_EQ(missed, 0u) << "of " << tips;
}

INSTANTIATE_TEST_SUITE_P(Arithmetic, ConservativeIn, testing::Values(Arithmetic::single, Arithmetic::rough));

TEST(ConservativeTriangle, AboutTheEpipoleIsInEveryPlane) {
  // Figs. 9 and 10: triangles that hold the axis, or the eye's or the light's neighbourhood, or touch θ = ±π.
  const glm::dvec3 eye(0.0), light(0.0, 0.0, 4.0);
  const scene::View view = view_between(eye, light, light);
  const auto across = [](double z, double size, glm::dvec2 offset) {
    scene::Geometry geometry;
    tests::add_triangle(geometry, {offset.x - size, offset.y - size, z},
                        {offset.x + size, offset.y - size, z}, {offset.x, offset.y + 2 * size, z});
    return geometry;
  };
  for (const double z : {-3.0, -1e-3, 1e-3, 2.0, 3.999, 4.001, 6.0}) {
    for (const double size : {1e-4, 1e-2, 1.0, 50.0}) {
      for (const glm::dvec2 offset : {glm::dvec2(0.0), glm::dvec2(0.0, 0.3), glm::dvec2(1.0, 0.0) * size}) {
        expect_every_point_found(across(z, size, offset), view, Ranges::full, 2000);
        expect_every_point_found(across(z, size, offset), view, Ranges::full, 500, k_coarse, pi,
                                 Arithmetic::rough);
      }
    }
  }
  Voxels voxels(view, k_coarse, Ranges::full, pi);
  const scene::Geometry epipole = across(2.0, 1e-3, {0.0, 0.0});
  voxels.voxelize(corners_of(epipole, epipole.triangles[0]));
  for (std::uint32_t plane = 0; plane < 256; ++plane) EXPECT_EQ(voxels.at(plane, 0), 0u) << plane;
}

TEST(ConservativeTriangle, UnderASunEveryPointIsFound) {
  // On the axis, touching it with a corner or an edge, beside it; before the eye, behind it and far away;
  // tiny and huge; at right angles to the light, edge-on to it, and next to that.
  const scene::View view = view_under_sun({0.0, 0.0, 0.0}, {0.0, 0.0, 4.0}, {0.0, 0.0, 1.0});
  for (const double z : {-300.0, -3.0, -1e-3, 1e-3, 2.0, 300.0}) {
    for (const double size : {1e-4, 1e-2, 1.0, 500.0}) {
      for (const double offset : {0.0, 0.3, 1e-6, size, 2 * size}) {
        for (const double tilt : {0.0, 1.0, 1e4, 1e9}) {
          scene::Geometry geometry;
          const glm::dvec3 middle(0.0, offset, z);
          const glm::dvec3 up = size * glm::normalize(glm::dvec3(0.0, 1.0, tilt));
          const glm::dvec3 aside(size, 0.0, 0.0);
          tests::add_triangle(geometry, middle - up - aside, middle - up + aside, middle + 2.0 * up);
          tests::add_triangle(geometry, middle, middle + up, middle + aside);
          // Edge-on in the half-plane, and across it.
          tests::add_triangle(geometry, middle, middle + glm::dvec3(0.0, size, 0.0), middle + up);
          for (const Arithmetic arithmetic : {Arithmetic::single, Arithmetic::rough}) {
            Voxels voxels(view, k_coarse, Ranges::full, 1e3, arithmetic);
            const Count count = look_for_points(geometry, voxels, 100);
            EXPECT_EQ(count.missed, 0u) << z << " " << size << " " << offset << " " << tilt;
          }
        }
      }
    }
  }
}

TEST(ConservativeTriangle, ThinnerThanAVoxelLeavesNoGap) {
  // A needle of a millionth of its length, through many cells.
  const scene::View view = view_between({0.0, 0.0, 0.0}, {0.0, 0.0, 4.0}, {0.0, 0.0, 4.0});
  scene::Geometry needle;
  tests::add_triangle(needle, {-3.0f, 0.5f, 1.0f}, {3.0f, 0.7f, 3.0f}, {3.0f, 0.700003f, 3.0f});
  expect_every_point_found(needle, view, Ranges::full, 20000, {256, 777, 256});
}

class ConservativeUnder : public testing::TestWithParam<bool> {};

TEST_P(ConservativeUnder, ASunOrALampATriangleIsNotMuchTooFat) {
  // Light rays noted but by no point of a dense sample touched. Slabs are exact but for their slack; what is
  // left are cells that a triangle touches by less than the sample is dense.
  const bool is_sun = GetParam();
  const glm::dvec3 eye(0.4, -0.3, 3.0), target(-0.5, 0.6, -1.0);
  const scene::View view =
      is_sun ? view_under_sun(eye, target, {-0.9, 0.9, -4.0}) : view_between(eye, target, target);
  const Resolution n{256, 777, 256};
  Voxels voxels(view, n, Ranges::full, largest_phi(view));
  const scene::Geometry soup = random_soup(300, 1.0, 4);
  tests::Random random(5);
  std::size_t touched = 0, first_cells = 0, too_near = 0;
  for (const glm::uvec3 triangle : soup.triangles) {
    const auto corners = corners_of(soup, triangle);
    const std::size_t before = voxels.noted();
    voxels.voxelize(corners);
    const std::size_t samples = std::min<std::size_t>(2000000, 300 * (voxels.noted() - before) + 1000);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> nearest;
    for (std::size_t i = 0; i < samples; ++i) {
      Voxels::Place place{};
      if (!voxels.place_of(pick(corners, static_cast<int>(i % 64), random), place)) continue;
      const auto cell = static_cast<std::uint32_t>(std::max(place.alpha, 0.0));
      const auto [entry, is_new] = nearest.try_emplace(
          {static_cast<std::uint32_t>(place.theta), static_cast<std::uint32_t>(place.phi)}, cell);
      if (!is_new) entry->second = std::min(entry->second, cell);
    }
    touched += nearest.size();
    for (const auto& [ray, cell] : nearest) {
      first_cells += cell;
      too_near += cell - std::min(cell, voxels.at(ray.first, ray.second));
    }
  }
  const double excess = static_cast<double>(voxels.noted()) / static_cast<double>(touched) - 1;
  RecordProperty("excess_rays_percent", std::to_string(100 * excess));
  RecordProperty("cells_too_near_a_ray",
                 std::to_string(static_cast<double>(too_near) / static_cast<double>(touched)));
  EXPECT_LT(excess, 0.05);
  EXPECT_LT(too_near, touched / 20);
}

INSTANTIATE_TEST_SUITE_P(Lights, ConservativeUnder, testing::Bool());

}  // namespace
}  // namespace airlight::epipolar
